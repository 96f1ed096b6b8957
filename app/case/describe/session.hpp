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
  v.quantity(s.slide_speed, Dimension::Speed,
             {"slide_speed", "mean speed of the slide", kOptional, kPositive});
  describe_choice(v, s.path,
                  {"path",
                   "`longest`: slides straight on from the middle of the part with responses; "
                   "`between`: from one point to another"},
                  kSlidePaths);
  const std::string path(name_in(kSlidePaths, s.path));
  if (v.when("path", path, "longest")) {
    v.quantity(s.slide_length, Dimension::Length,
               {"slide_length", "length of the slide; shorter where the surface ends", kOptional,
                kPositive});
  }
  if (v.when("path", path, "between")) {
    v.point(s.from, Dimension::Length,
            {"from", "the slide starts in the triangle nearest to this point", kRequired});
    v.point(s.to, Dimension::Length,
            {"to", "the slide ends in the triangle nearest to this point", kRequired});
  }
}

template <class V>
void describe(V& v, SimulateSection& s) {
  v.quantity(s.rate, Dimension::Frequency,
             {"rate", "sampling rate of the force loop", kOptional, {.low = 100, .high = 100000}});
  v.quantity(s.device.mass, Dimension::Mass,
             {"mass", "mass of the simulated device", kOptional, kPositive});
  v.quantity(s.device.damping, Dimension::Damping,
             {"damping", "viscous damping of the simulated device", kOptional, kNotNegative});
  v.quantity(s.device.coulomb_friction, Dimension::Force,
             {"coulomb_friction", "dry friction of the simulated device", kOptional, kNotNegative});
  v.quantity(
      s.device.hand_stiffness, Dimension::Stiffness,
      {"hand_stiffness", "stiffness of the spring between the path of the hand and the device",
       kOptional, kPositive});
  v.quantity(s.device.hand_damping, Dimension::Damping,
             {"hand_damping", "damping in parallel with that spring", kOptional, kNotNegative});
  v.quantity(
      s.press_depth, Dimension::Length,
      {"press_depth", "depth of the path of the hand below the surface", kOptional, kPositive});
  v.quantity(s.press_speed, Dimension::Speed,
             {"press_speed", "mean speed of approach, press and release", kOptional, kPositive});
  describe_slide(v, s);
}

}  // namespace palpate::app
