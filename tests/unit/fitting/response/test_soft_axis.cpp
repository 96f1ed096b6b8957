// SPDX-License-Identifier: AGPL-3.0-or-later
// Springs that are softer in one lateral direction than in the other: their forces are known in
// closed form, for drags in any direction.
#include "fitting/response/soft_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fitting/response/fit.hpp"
#include "fitting/response/lean.hpp"
#include "runtime/local_model.hpp"
#include "runtime/surface.hpp"
#include "tests/unit/fitting/response/one_triangle.hpp"

namespace palpate::fitting {
namespace {

const Vec3 kInto{0, 0, -1};
constexpr double kNormal = 900, kStiff = 600;                        // N/m^1.5, N/m
constexpr double kPressed = 0.006, kDeep = 0.004, kDragged = 0.003;  // m

Vec3 along(double azimuth) {
  return {std::cos(azimuth), std::sin(azimuth), 0};
}

/// Springs of the stiffness k across an axis and ratio k along it, times sqrt(z/z_1), where z_1 is
/// the lateral depth. Those of a curved response store k (rho^2/2 + bend rho^3/3) for rho = |S q|.
struct SoftSprings {
  double azimuth = 0.7;  ///< of the soft axis
  double ratio = 0.75;
  double bend = 0;  ///< 1/m

  Vec3 force(double z, const Vec3& d) const {
    const double root = std::sqrt(ratio);
    const auto stretched = [&](const Vec3& v) {
      return v - (1 - root) * dot(v, along(azimuth)) * along(azimuth);
    };
    const Vec3 p = stretched(d);
    const double k = std::sqrt(z / kDeep) * kStiff * (1 + bend * norm(p));
    return kNormal * std::pow(z, 1.5) * kInto + k * stretched(p);
  }
  CurveSample sample(double displacement, double z, const Vec3& d) const {
    CurveSample sample;
    sample.displacement = displacement;
    sample.force = force(z, d);
    return sample;
  }
  SiteCurves site(std::int32_t vertex, const std::vector<double>& azimuths) const {
    SiteCurves site;
    site.vertex = vertex;
    site.status = SiteStatus::Complete;
    CurvePath press{PathKind::Normal, 0, kInto, {}};
    for (int i = 0; i <= 8; ++i)
      press.samples.push_back(sample(kPressed * i / 8, kPressed * i / 8, {}));
    site.paths.push_back(press);
    for (const double depth : {0.5 * kDeep, kDeep}) {
      for (const double a : azimuths) {
        CurvePath drag{PathKind::Lateral, depth, along(a), {}};
        for (int i = 0; i <= 4; ++i)
          drag.samples.push_back(sample(kDragged * i / 4, depth, (kDragged * i / 4) * along(a)));
        site.paths.push_back(drag);
      }
    }
    return site;
  }
};

Library library_of(const SoftSprings& springs, FitSettings settings = {}) {
  Curves curves;
  curves.depth = kPressed;
  curves.tool.friction = "no-slip";
  for (std::int32_t v = 0; v < 3; ++v) curves.sites.push_back(springs.site(v, {0, 0.5 * M_PI}));
  settings.kind = ResponseKind::Coupled;
  settings.relative_tolerance = 1e-3;
  return fit(one_triangle(), curves, settings);
}

/// The largest difference between rendered and true forces of drags in all directions, over the
/// largest lateral force.
double worst_drag(const Library& library, const SoftSprings& springs) {
  const runtime::Surface surface(library);
  double worst = 0, largest = 0;
  for (int k = 0; k < 12; ++k) {
    const Vec3 d = 0.002 * along(k * M_PI / 6);
    runtime::LocalModel model(surface, {0, {0.2, 0.5, 0.3}}, 0);
    model.set_grip({kDeep, {}});
    const Vec3 x = model.contact_point() + kDeep * kInto + d;
    const Vec3 exact = springs.force(kDeep, d);
    worst = std::max(worst, norm(model.respond(model.deflection(x)).force - exact));
    largest = std::max(largest, norm(exact - dot(exact, kInto) * kInto));
  }
  return worst / largest;
}

double square(const std::array<float, 3>& b) {
  return dot(vec3_of(b), vec3_of(b));
}

TEST(SoftAxis, OfSpringsIsTheirSoftDirection) {
  for (const double azimuth : {0.0, 0.7, 2.5}) {
    for (const double ratio : {0.95, 0.75, 0.66}) {
      const SoftSprings springs{azimuth, ratio};
      // Neither of two directions has to be along an axis; more directions change nothing.
      for (const auto& azimuths : {std::vector<double>{0, 0.5 * M_PI}, {0.2, 1.1, 4}}) {
        const auto b = fit_soft_axis(springs.site(0, azimuths), kInto);
        EXPECT_NEAR(std::pow(1 - square(b), 2), ratio, 1e-6);
        EXPECT_NEAR(std::abs(dot(vec3_of(b), along(azimuth))), std::sqrt(square(b)), 1e-6);
      }
    }
  }
}

TEST(SoftAxis, IsNoneWhereDragsDoNotShowIt) {
  const std::array<float, 3> none{};
  const SoftSprings soft;
  EXPECT_EQ(fit_soft_axis(soft.site(0, {0.3}), kInto), none);              // one direction
  EXPECT_EQ(fit_soft_axis(soft.site(0, {0.3, 0.3 + M_PI}), kInto), none);  // and its reverse
  EXPECT_EQ(fit_soft_axis(SoftSprings{0.7, 0.995}.site(0, {0, 1}), kInto), none);
  SiteCurves pressed = soft.site(0, {0, 1});
  pressed.paths.resize(1);
  EXPECT_EQ(fit_soft_axis(pressed, kInto), none);
}

TEST(SoftAxis, IsCutWhereTheResponseHardlyResists) {
  const auto b = fit_soft_axis(SoftSprings{0.7, 0.01}.site(0, {0, 1.5}), kInto);
  EXPECT_NEAR(std::sqrt(square(b)), kMostFittedSoftAxis, 1e-6);
  EXPECT_LT(kMostFittedSoftAxis, kMostSoftAxis);
}

TEST(SoftAxis, TheRuntimeRendersDragsInEveryDirection) {
  for (const double bend : {0.0, 60.0}) {
    const SoftSprings springs{0.7, 0.75, bend};
    const Library library = library_of(springs);
    ASSERT_TRUE(library.has_soft_axes());
    EXPECT_LT(worst_drag(library, springs), 0.01) << bend;
    FitSettings without;
    without.soft_axes = false;
    const Library mean = library_of(springs, without);
    EXPECT_FALSE(mean.has_soft_axes());
    EXPECT_GT(worst_drag(mean, springs), 0.08) << bend;
  }
}

/// w is fitted within a hundredth. The mean of drags in both directions is 2.4 % off each.
TEST(SoftAxis, TheErrorsOfAFitAreThoseOfWhatIsRendered) {
  const SoftSprings springs{0.7, 0.75, 60};
  const double largest = norm(springs.force(kDeep, kDragged * along(0.7 + 0.5 * M_PI)));
  for (const NodeResponse& node : library_of(springs).responses)
    EXPECT_LT(node.lateral_error, 0.01 * largest);
  FitSettings without;
  without.soft_axes = false;
  for (const NodeResponse& node : library_of(springs, without).responses)
    EXPECT_GT(node.lateral_error, 0.02 * largest);
}

/// A straight press of a tool that sticks is sheared by the lean, and feels -S S sigma z.
TEST(SoftAxis, TurnsTheForceOfALeanTowardsTheStiffDirection) {
  NodeResponse node;
  node.lateral = {{0, 0.01F}, {static_cast<float>(kStiff), static_cast<float>(kStiff)}};
  node.lean = {0.1F, 0, 0};
  node.soft_axis = {0.3F, 0.2F, 0};
  const LeaningResponse lean(node, ResponseKind::Decoupled);
  const Vec3 b = vec3_of(node.soft_axis), sigma = vec3_of(node.lean);
  const auto stretch = [&](const Vec3& v) { return v - dot(b, v) * b; };
  constexpr double z = 0.004;
  const Vec3 exact = -(kStiff * z * stretch(stretch(sigma)));
  EXPECT_LT(norm(lean.transverse_force(z) - exact), 1e-9);
  EXPECT_NEAR(lean.normal_force(z), -dot(sigma, exact), 1e-9);
  const Vec3 e = along(1.2);
  EXPECT_NEAR(lean.drag_force(z, 0.001, e), kStiff * 0.001 * dot(e, stretch(stretch(e))), 1e-9);
}

}  // namespace
}  // namespace palpate::fitting
