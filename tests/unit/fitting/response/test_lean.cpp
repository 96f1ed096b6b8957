// SPDX-License-Identifier: AGPL-3.0-or-later
// Presses of a half-space whose axes are tilted: what a straight press then feels is known in
// closed form.
#include "fitting/response/lean.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fitting/response/fit.hpp"
#include "fitting/response/site_samples.hpp"
#include "runtime/local_model.hpp"
#include "runtime/surface.hpp"
#include "tests/unit/fitting/response/one_triangle.hpp"

namespace palpate::fitting {
namespace {

const Vec3 kLean{0.06, -0.03, 0};
const Vec3 kInto{0, 0, -1};
constexpr double kStiffness = 900, kShear = 600;                     // N/m
constexpr double kPressed = 0.006, kDeep = 0.004, kDragged = 0.003;  // m

/// Springs whose axes are tilted: normal ones of K z^1.5, and lateral ones of k q, q = d - sigma z.
/// Coupled: of w(z) k, and tilted by w sigma, w = sqrt(z/z_1) for the lateral depth z_1, where
/// springs that come into contact are slack: w q = w d - sigma times the integral of w^2. The force
/// is that of a straight press to z and a drag d from there.
struct TiltedSprings {
  ResponseKind kind;

  Vec3 force(double z, const Vec3& d) const {
    const bool coupled = kind == ResponseKind::Coupled;
    const double w = coupled ? std::sqrt(z / kDeep) : 1,
                 sheared = coupled ? z * z / (2 * kDeep) : z;
    const Vec3 lateral = kShear * (w * d - sheared * kLean);
    return (kStiffness * std::pow(z, 1.5) - w * dot(lateral, kLean)) * kInto + lateral;
  }
  CurveSample sample(double displacement, double z, const Vec3& d) const {
    CurveSample sample;
    sample.displacement = displacement;
    sample.force = force(z, d);
    return sample;
  }
};

/// The force of the local model after the same path: a press in small steps, then the drag.
Vec3 rendered(const runtime::Surface& surface, double z, const Vec3& d) {
  runtime::LocalModel model(surface, {0, {0.2, 0.5, 0.3}}, 0);
  runtime::ToolPieces pieces;
  constexpr int kSmall = 500;
  for (int k = 1; k <= kSmall; ++k) {
    runtime::Deflection at = model.deflection(model.contact_point() + (z * k / kSmall) * kInto);
    runtime::LocalResponse response = model.respond(at, pieces);
    model.renew_grip(at, response, pieces);
  }
  return model.respond(model.deflection(model.contact_point() + z * kInto + d)).force;
}

SiteCurves tilted_site(std::int32_t vertex, ResponseKind kind) {
  const TiltedSprings springs{kind};
  SiteCurves site;
  site.vertex = vertex;
  site.status = SiteStatus::Complete;
  CurvePath press{PathKind::Normal, 0, kInto, {}};
  for (int i = 0; i <= 8; ++i)
    press.samples.push_back(springs.sample(kPressed * i / 8, kPressed * i / 8, {}));
  site.paths.push_back(press);
  for (const double depth : {0.5 * kDeep, kDeep}) {
    for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
      CurvePath drag{PathKind::Lateral, depth, along, {}};
      for (int i = 0; i <= 4; ++i) {
        const double d = kDragged * i / 4;
        drag.samples.push_back(springs.sample(d, depth, d * along));
      }
      site.paths.push_back(drag);
    }
  }
  return site;
}

NodeResponse springs() {
  NodeResponse node;
  node.lateral = {{0, 0.01F}, {static_cast<float>(kShear), static_cast<float>(kShear)}};
  return node;
}

/// The same with w close to sqrt(z/z_1), within a thousandth from a twentieth of z_1 on.
NodeResponse coupled_springs() {
  NodeResponse node = springs();
  CouplingCurve& w = node.coupling;
  const auto add = [&](double part, double slope) {
    w.curve.knot.push_back(static_cast<float>(part * kDeep));
    w.curve.slope.push_back(static_cast<float>(slope / kDeep));
  };
  add(0, 0.5 / std::sqrt(0.02));
  for (double part = 0.02; part < 1.55; part *= 1.1) add(part, 0.5 / std::sqrt(part));
  add(2, 0);
  double rise = 0;  // up to z_1, by the trapezoidal rule, which is exact for w
  for (std::size_t k = 1; w.curve.knot[k] < static_cast<float>(kDeep); ++k)
    rise += 0.5 * static_cast<double>((w.curve.knot[k] - w.curve.knot[k - 1]) *
                                      (w.curve.slope[k] + w.curve.slope[k - 1]));
  w.base = static_cast<float>(1 - rise);
  w.base += static_cast<float>(
      1 - runtime::CompiledCurve(w.curve, static_cast<double>(w.base)).force(kDeep));
  return node;
}

/// A tool without friction shears nothing as it is pressed.
void press_without_friction(SiteCurves& site) {
  for (CurveSample& sample : site.paths.front().samples)
    sample.force = kStiffness * std::pow(sample.displacement, 1.5) * kInto;
}

Library tilted_library(const FitSettings& settings, const char* friction = "no-slip") {
  const Body body = one_triangle();
  Curves curves;
  curves.depth = kPressed;
  curves.tool.friction = friction;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(body.response.node.size()); ++v) {
    curves.sites.push_back(tilted_site(v, settings.kind));
    if (curves.tool.friction == "frictionless") press_without_friction(curves.sites.back());
  }
  return fit(body, curves, settings);
}

TEST(Lean, OfTiltedSpringsIsTheirTilt) {
  const auto lean = fit_lean(tilted_site(0, ResponseKind::Decoupled), kInto, springs(),
                             ResponseKind::Decoupled, PressingTool::Sticks);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(lean[i]), kLean[i], 1e-6);
}

TEST(Lean, OfDragsIsHowTheForceOfThePressFollowsThem) {
  SiteCurves site = tilted_site(0, ResponseKind::Coupled);
  site.paths.front().samples.clear();  // no press is asked
  const auto exact = [](const std::optional<Vec3>& lean) {
    ASSERT_TRUE(lean);
    EXPECT_LT(norm(*lean - kLean), 1e-3 * norm(kLean));  // as close as w is
  };
  exact(lean_of_drags(site, kInto, coupled_springs(), ResponseKind::Coupled));
  // What drags in either direction do alike is no lean.
  for (CurvePath& path : site.paths)
    for (CurveSample& sample : path.samples) {
      const Vec3 change = sample.force - path.samples.front().force;
      const Vec3 across = change - dot(change, kInto) * kInto;
      sample.force = sample.force + 0.2 * dot(across, across) * kInto;
    }
  exact(lean_of_drags(site, kInto, coupled_springs(), ResponseKind::Coupled));
}

TEST(Lean, OfDragsInOneDirectionIsNotKnownAndThatOfThePressesStands) {
  SiteCurves site = tilted_site(0, ResponseKind::Coupled);
  const auto across = [](const CurvePath& path) { return path.direction[1] != 0; };
  site.paths.erase(std::remove_if(site.paths.begin(), site.paths.end(), across), site.paths.end());
  const NodeResponse node = coupled_springs();
  const auto kind = ResponseKind::Coupled;
  EXPECT_FALSE(lean_of_drags(site, kInto, node, kind));
  const auto lean = fit_lean(site, kInto, node, kind, PressingTool::Sticks);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(lean[i]), kLean[i], 0.02 * norm(kLean));
  // A tool without friction does not show by its transverse force what shear would do.
  EXPECT_EQ(fit_lean(site, kInto, node, kind, PressingTool::Slips), (std::array<float, 3>{}));
  // Two drags of one sample each do not tell a lean from what is proportional to the square.
  site = tilted_site(0, ResponseKind::Coupled);
  site.paths = {site.paths[0], site.paths[1], site.paths[3]};
  for (const std::size_t drag : {1u, 2u}) site.paths[drag].samples.resize(2);
  EXPECT_FALSE(lean_of_drags(site, kInto, node, kind));
}

/// A campaign in increments does not see all of the shear of the first: what is missing there is
/// missing in every sample.
TEST(Lean, OfPressesIsHowTheirShearGrows) {
  SiteCurves site = tilted_site(0, ResponseKind::Coupled);
  site.paths.resize(1);  // the press alone
  for (CurveSample& sample : site.paths[0].samples)
    if (sample.displacement > 0) sample.force = sample.force + Vec3{0.01, 0.02, 0};
  const auto lean =
      fit_lean(site, kInto, coupled_springs(), ResponseKind::Coupled, PressingTool::Sticks);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(lean[i]), kLean[i], 0.02 * norm(kLean));
}

/// Where presses and drags of different springs are told, the lean lies between.
TEST(Lean, SuitsPressesAndDrags) {
  SiteCurves site = tilted_site(0, ResponseKind::Coupled);
  for (CurveSample& sample : site.paths[0].samples) {
    const Vec3 across = sample.force - dot(sample.force, kInto) * kInto;
    sample.force = sample.force + 0.5 * across;  // of springs with 1.5 times the tilt
  }
  const auto lean =
      fit_lean(site, kInto, coupled_springs(), ResponseKind::Coupled, PressingTool::Sticks);
  for (std::size_t i = 0; i < 2; ++i) {
    const double part = static_cast<double>(lean[i]) / kLean[i];
    EXPECT_GT(part, 1.05);
    EXPECT_LT(part, 1.45);
  }
}

TEST(Lean, IsNoneWhereAPressIsStraightAndIsCutWhereItIsLong) {
  SiteCurves site = tilted_site(0, ResponseKind::Decoupled);
  for (CurveSample& sample : site.paths[0].samples) sample.force = dot(sample.force, kInto) * kInto;
  site.paths.resize(1);
  const auto fitted = [&] {
    return fit_lean(site, kInto, springs(), ResponseKind::Decoupled, PressingTool::Sticks);
  };
  EXPECT_EQ(fitted(), (std::array<float, 3>{}));
  for (CurveSample& sample : site.paths[0].samples)
    sample.force[1] = 2 * kMostFittedLean * kShear * sample.displacement;
  const auto cut = fitted();
  EXPECT_NEAR(static_cast<double>(cut[1]), -kMostFittedLean, 1e-6);
}

TEST(Lean, TheRuntimeRendersTheForcesOfTiltedSprings) {
  // A press without friction and drags know what a press that sticks will feel.
  for (const char* friction : {"no-slip", "frictionless"}) {
    for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
      FitSettings settings;
      settings.kind = kind;
      settings.relative_tolerance = 1e-3;
      const Library library = tilted_library(settings, friction);
      ASSERT_TRUE(library.leans());
      const runtime::Surface surface(library);
      double largest = 0, worst = 0;
      for (const double z : {0.3 * kPressed, 0.7 * kPressed, kPressed}) {
        for (const Vec3& d : {Vec3{}, Vec3{0.001, 0, 0}, Vec3{-0.0004, -0.0008, 0}}) {
          const Vec3 exact = TiltedSprings{kind}.force(z, d);
          largest = std::max(largest, norm(exact));
          worst = std::max(worst, norm(rendered(surface, z, d) - exact));
        }
      }
      EXPECT_LT(worst, (kind == ResponseKind::Decoupled ? 0.002 : 0.01) * largest) << friction;
      settings.lean = false;
      EXPECT_FALSE(tilted_library(settings, friction).leans());
    }
  }
}

TEST(Lean, TheErrorsOfAFitAreThoseOfWhatIsRendered) {
  FitSettings settings;
  settings.relative_tolerance = 1e-3;
  const double peak = norm(TiltedSprings{settings.kind}.force(kPressed, {}));
  for (const char* friction : {"no-slip", "frictionless"}) {
    for (const NodeResponse& node : tilted_library(settings, friction).responses) {
      EXPECT_LT(node.normal_error, 1e-3 * peak);
      EXPECT_LT(node.lateral_error, 2e-3 * peak);
    }
  }
}

}  // namespace
}  // namespace palpate::fitting
