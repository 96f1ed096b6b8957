// SPDX-License-Identifier: AGPL-3.0-or-later
// What the adversaries of a body share: the bodies, random motions, and what must hold of every
// step.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/certified_library.hpp"
#include "tests/unit/runtime/watched_contact.hpp"

namespace palpate::test {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline Vec3 random_unit(Random& random) {
  std::normal_distribution<double> any;
  const Vec3 v{any(random), any(random), any(random)};
  return (1.0 / norm(v)) * v;
}

/// Stiffness up and down by `spread` over a wave length of 40 mm, both ways at once.
inline Responses varying(double spread) {
  return [spread](const Vec3& x) {
    const double s = 1 + spread * std::sin(160 * x[2] + 120 * x[1]) * std::cos(110 * x[0]);
    const double h = 1 + spread * std::cos(140 * x[1] + 90 * x[2]);
    return wall_response(170 * s, 120 * h);
  };
}

/// Lateral responses that stiffen, soften or are straight, side by side.
inline Responses bent(double spread) {
  return [spread](const Vec3& x) {
    NodeResponse node = varying(spread)(x);
    const double bend = std::sin(230 * x[0] + 170 * x[1]);
    node.lateral = stiffening_curve(120 * (1 - 0.8 * bend), 120 * (1 + 0.8 * bend), 5, 0.002);
    return node;
  };
}

/// Contacts that grow with the depth early or late, side by side.
inline Library growing_unevenly(Library library) {
  library = coupled(std::move(library));
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3& x = library.positions[v];
    const double late = 0.9 * std::sin(210 * x[0] - 180 * x[1] + 90 * x[2]);
    CouplingCurve& w = library.responses[v].coupling;
    w.base *= static_cast<float>(1 - 0.7 * late);
    for (std::size_t k = 0; k < w.curve.slope.size(); ++k)
      w.curve.slope[k] *= static_cast<float>(w.curve.knot[k] < 0.002F ? 1 - late : 1 + late);
  }
  return library;
}

inline Library body_named(const std::string& name) {
  if (name == "cylinder") return cylinder(25, 20, 0.04, 0.2, varying(0.6));
  if (name == "coupled") return coupled(bumpy_sphere(3, 0.03, 0.25, varying(0.3)));
  if (name == "coupled_rims") return coupled(cylinder(25, 20, 0.04, 0.2, varying(0.3)));
  if (name == "coupled_cube") return coupled(cube(6, 0.06, varying(0.5)));
  if (name == "coupled_thin") return coupled(thin_body(8, 0.08, 0.0015, varying(0.5)));
  if (name == "relaxing")
    return relaxing(coupled(bumpy_sphere(3, 0.03, 0.25, varying(0.3))), {0.01, 0.1, 1}, false);
  if (name == "relaxing_alike")
    return relaxing(coupled(cylinder(25, 20, 0.04, 0.2, varying(0.3))), {0.05}, true);
  if (name == "relaxing_cube") return relaxing(cube(6, 0.06, varying(0.5)), {0.02, 0.5}, false);
  if (name == "relaxing_hills")
    return relaxing(bumpy_sphere(3, 0.03, 0.25, bent(0.4)), {0.01, 0.1, 1}, false);
  if (name == "relaxing_grip") {
    return relaxing(growing_unevenly(bumpy_sphere(3, 0.03, 0.25, bent(0.4))), {0.01, 0.1, 1},
                    false);
  }
  if (name == "leaning") return leaning(coupled(bumpy_sphere(2, 0.03, 0.25, varying(0.3))), 0.2);
  if (name == "leaning_rims") return leaning(cylinder(25, 20, 0.04, 0.2, varying(0.5)), 0.2);
  if (name == "leaning_thin")
    return leaning(coupled(thin_body(8, 0.08, 0.0015, varying(0.5))), 0.2);
  if (name == "leaning_relaxing")
    return leaning(relaxing(bumpy_sphere(2, 0.03, 0.25, bent(0.4)), {0.01, 0.1, 1}, false), 0.2);
  if (name == "soft")
    return soft_axes(leaning(coupled(bumpy_sphere(2, 0.03, 0.25, varying(0.3))), 0.15), 0.6);
  if (name == "soft_thin") return soft_axes(coupled(thin_body(8, 0.08, 0.0015, varying(0.5))), 0.6);
  if (name == "soft_relaxing") {
    return soft_axes(leaning(relaxing(growing_unevenly(bumpy_sphere(2, 0.03, 0.25, bent(0.4))),
                                      {0.01, 0.1, 1}, false),
                             0.15),
                     0.6);
  }
  if (name == "hills") return bumpy_sphere(3, 0.03, 0.25, varying(0.5));
  if (name == "cube") return cube(6, 0.06, varying(0.5));
  return thin_body(8, 0.08, 0.0015, varying(0.5));
}

/// A point near the surface: over vertices, edges and faces alike, `height` outside.
inline Vec3 near_surface(const Library& library, Random& random, double height) {
  const Triangle& t = library.triangles[random() % library.triangles.size()];
  std::array<double, 3> n{between(random, 0, 1), between(random, 0, 1), between(random, 0, 1)};
  const auto kind = random() % 4;
  if (kind == 0) n = {1, 0, 0};
  if (kind == 1) n = {0.5, 0.5, 0};
  const double sum = n[0] + n[1] + n[2];
  Vec3 point{};
  Vec3 in{};
  for (std::size_t l = 0; l < 3; ++l) {
    point = point + (n[l] / sum) * library.positions[static_cast<std::size_t>(t[l])];
    in = in + (n[l] / sum) * library.inward[static_cast<std::size_t>(t[l])];
  }
  return point - (height / norm(in)) * in;
}

inline void expect_sound(const WatchedContact& contact) {
  EXPECT_TRUE(contact.always_finite);
  EXPECT_GE(contact.lowest, -1e-12);
  EXPECT_LE(contact.largest_gain, 1e-12);
  EXPECT_LE(contact.largest_disagreement, 1e-12);
  EXPECT_LE(contact.largest_lateral_error, 1);
  EXPECT_EQ(contact.cuts, 0);
}

/// The limit on the change of force, and that of friction.
inline void expect_no_jump(const WatchedContact& contact) {
  EXPECT_LE(contact.steepest_step, 1);
  EXPECT_LE(contact.largest_overdraft, 1);
}

/// A body of body_named(), and how it is rendered.
struct AdversaryCase {
  const char* body;
  double friction;
  double tank_cap;
};

inline auto adversary_cases() {
  return ::testing::Values(
      AdversaryCase{"cylinder", 0, 0}, AdversaryCase{"cylinder", 0.1, 5e-3},
      AdversaryCase{"hills", 0, 5e-3}, AdversaryCase{"hills", 0.3, 0}, AdversaryCase{"cube", 0, 0},
      AdversaryCase{"cube", 0.2, 5e-3}, AdversaryCase{"thin", 0, 0},
      AdversaryCase{"thin", 0.5, 5e-3}, AdversaryCase{"coupled", 0.3, 0},
      AdversaryCase{"coupled", 0.1, 5e-3}, AdversaryCase{"coupled_rims", 0.3, 5e-3},
      AdversaryCase{"coupled_cube", 0.2, 5e-3}, AdversaryCase{"coupled_thin", 0.5, 0},
      AdversaryCase{"relaxing", 0.3, 5e-3}, AdversaryCase{"relaxing", 0, 0},
      AdversaryCase{"relaxing_alike", 0.2, 0}, AdversaryCase{"relaxing_cube", 0.5, 5e-3},
      AdversaryCase{"relaxing_hills", 0.3, 5e-3}, AdversaryCase{"relaxing_hills", 0.8, 0},
      AdversaryCase{"relaxing_grip", 0.3, 5e-3}, AdversaryCase{"relaxing_grip", 0.7, 0},
      AdversaryCase{"leaning", 0.3, 5e-3}, AdversaryCase{"leaning_rims", 0.3, 0},
      AdversaryCase{"leaning_rims", 0, 5e-3}, AdversaryCase{"leaning_thin", 0.5, 5e-3},
      AdversaryCase{"leaning_relaxing", 0.3, 5e-3}, AdversaryCase{"soft", 0.3, 5e-3},
      AdversaryCase{"soft_thin", 0.5, 0}, AdversaryCase{"soft_relaxing", 0.3, 5e-3});
}

inline std::string case_name(const ::testing::TestParamInfo<AdversaryCase>& about) {
  return std::string(about.param.body) + "_mu_" +
         std::to_string(static_cast<int>(100 * about.param.friction)) +
         (about.param.tank_cap > 0 ? "_tank" : "_strict");
}

/// A certified body of each case.
class CertifiedBody : public ::testing::TestWithParam<AdversaryCase> {
 protected:
  CertifiedBody()
      : library_(certified(body_named(GetParam().body), GetParam().friction)), body_(library_) {}
  runtime::ContactSettings settings(double lipschitz_bound) const {
    return {GetParam().friction, GetParam().tank_cap, runtime::EnergyBudget::Enforced,
            lipschitz_bound};
  }

  const Library library_;
  const palpate_library body_;
};

}  // namespace palpate::test
