// SPDX-License-Identifier: AGPL-3.0-or-later
// The section of the scripted session.
#pragma once

#include <array>
#include <string>

#include "app/case/case.hpp"
#include "app/case/describe/key.hpp"

namespace palpate::app {

inline constexpr std::array kSlidePaths{Named{SlidePath::Longest, "longest"},
                                        Named{SlidePath::Between, "between"}};

template <class V>
void describe_slide(V& v, SimulateSection& s) {
  v.quantity_or_auto(s.slide_speed, Dimension::Speed,
                     {"slide_speed", "largest speed of the slide; `auto`: it takes about 2 s",
                      kOptional, kPositive});
  describe_choice(v, s.path,
                  {"path",
                   "`longest`: slides straight on from the middle of the part with responses; "
                   "`between`: from one point to another"},
                  kSlidePaths);
  const std::string path(name_in(kSlidePaths, s.path));
  if (v.when("path", path, "longest")) {
    v.quantity_or_auto(s.slide_length, Dimension::Length,
                       {"slide_length",
                        "length of the slide; shorter where the surface ends or has turned by 60 "
                        "degrees; `auto`: half the diagonal of the "
                        "box around the part with responses",
                        kOptional, kPositive});
  }
  if (v.when("path", path, "between")) {
    v.point(s.from, Dimension::Length,
            {"from", "the slide starts in the triangle nearest to this point", kRequired});
    v.point(s.to, Dimension::Length,
            {"to", "the slide ends in the triangle nearest to this point", kRequired});
  }
}

template <class V>
void describe_device(V& v, runtime::SimulatedDeviceSettings& s) {
  v.quantity_or_auto(s.mass, Dimension::Mass,
                     {"mass",
                      "mass of the simulated device; `auto`: 5e-4 s^2 k, with k the median secant "
                      "stiffness of the responses at their deepest sample",
                      kOptional, kPositive});
  v.quantity_or_auto(s.damping, Dimension::Damping,
                     {"damping", "viscous damping of the simulated device; `auto`: 5e-4 s k",
                      kOptional, kNotNegative});
  v.quantity_or_auto(s.coulomb_friction, Dimension::Force,
                     {"coulomb_friction",
                      "dry friction of the simulated device; `auto`: a hundredth of the median "
                      "force of the responses at their deepest sample",
                      kOptional, kNotNegative});
  v.quantity_or_auto(
      s.hand_stiffness, Dimension::Stiffness,
      {"hand_stiffness",
       "stiffness of the spring between the path of the hand and the device; `auto`: 4 k",
       kOptional, kPositive});
  v.quantity_or_auto(s.hand_damping, Dimension::Damping,
                     {"hand_damping", "damping in parallel with that spring; `auto`: 0.1 s k",
                      kOptional, kNotNegative});
}

template <class V>
void describe(V& v, SimulateSection& s) {
  v.quantity(s.rate, Dimension::Frequency,
             {"rate", "sampling rate of the force loop", kOptional, {.low = 100, .high = 100000}});
  describe_device(v, s.device);
  v.quantity_or_auto(
      s.press_depth, Dimension::Length,
      {"press_depth",
       "depth of the path of the hand below the surface, and its height above it at both ends; "
       "`auto`: half of the depth to which every response is known",
       kOptional, kPositive});
  v.quantity_or_auto(
      s.press_speed, Dimension::Speed,
      {"press_speed", "largest speed of approach and press, and of release; `auto`: they take 1 s",
       kOptional, kPositive});
  v.quantity_or_auto(
      s.hold, Dimension::Time,
      {"hold",
       "rest between press and slide; `auto`: none, or where the tissue relaxes twice its longest "
       "time, at most 5 s",
       kOptional, kNotNegative});
  v.quantity_or_auto(
      s.tank_cap, Dimension::Energy,
      {"tank_cap",
       "cap of the energy tank, which lets a slide use what friction has taken; 0: none; `auto`: "
       "5 mJ, or the median energy of the responses at their deepest sample where that is more",
       kOptional, kNotNegative});
  describe_slide(v, s);
}

}  // namespace palpate::app
