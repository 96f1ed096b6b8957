// SPDX-License-Identifier: AGPL-3.0-or-later
// Presses of a half-space whose axes are tilted: what a straight press then feels is known in
// closed form.
#include "fitting/response/lean.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/response/fit.hpp"
#include "fitting/response/site_samples.hpp"
#include "runtime/local_model.hpp"
#include "runtime/surface.hpp"

namespace palpate::fitting {
namespace {

const Vec3 kLean{0.06, -0.03, 0};
const Vec3 kInto{0, 0, -1};
constexpr double kStiffness = 900, kShear = 600;                     // N/m
constexpr double kPressed = 0.006, kDeep = 0.004, kDragged = 0.003;  // m

/// Springs whose axes are tilted: normal ones of K z^1.5, and lateral ones of k q, q = d - sigma z.
/// Coupled: of w(z) k, w = sqrt(z/z_1) for the lateral depth z_1, where springs that come into
/// contact are slack. The force is that of a straight press to z and a drag d from there.
struct TiltedSprings {
  ResponseKind kind;

  Vec3 force(double z, const Vec3& d) const {
    const bool coupled = kind == ResponseKind::Coupled;
    const double w = coupled ? std::sqrt(z / kDeep) : 1, sheared = coupled ? 2.0 / 3 * w * z : z;
    const Vec3 lateral = kShear * (w * d - sheared * kLean);
    return (kStiffness * std::pow(z, 1.5) - dot(lateral, kLean)) * kInto + lateral;
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

Body one_triangle() {
  Body body;
  body.name = "triangle";
  body.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  body.response.node = {0, 1, 2};
  body.response.inward = {kInto, kInto, kInto};
  body.response.is_site = {1, 1, 1};
  body.response.triangles = {{0, 1, 2}};
  return body;
}

Library tilted_library(const FitSettings& settings) {
  const Body body = one_triangle();
  Curves curves;
  curves.depth = kPressed;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(body.response.node.size()); ++v)
    curves.sites.push_back(tilted_site(v, settings.kind));
  return fit(body, curves, settings);
}

TEST(Lean, OfTiltedSpringsIsTheirTilt) {
  const auto lean =
      fit_lean(tilted_site(0, ResponseKind::Decoupled), kInto, springs(), ResponseKind::Decoupled);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(lean[i]), kLean[i], 1e-6);
}

TEST(Lean, IsNoneWhereAPressIsStraightAndIsCutWhereItIsLong) {
  SiteCurves site = tilted_site(0, ResponseKind::Decoupled);
  for (CurveSample& sample : site.paths[0].samples) sample.force = dot(sample.force, kInto) * kInto;
  EXPECT_EQ(fit_lean(site, kInto, springs(), ResponseKind::Decoupled), (std::array<float, 3>{}));
  for (CurveSample& sample : site.paths[0].samples)
    sample.force[1] = 2 * kMostFittedLean * kShear * sample.displacement;
  const auto cut = fit_lean(site, kInto, springs(), ResponseKind::Decoupled);
  EXPECT_NEAR(static_cast<double>(cut[1]), -kMostFittedLean, 1e-6);
}

TEST(Lean, DoesTheWorkOfItsNormalForce) {
  NodeResponse node = springs();
  node.lateral = {{0, 0.001F, 0.004F}, {400, 700, 300}};
  node.coupling = {0.4F, {{0, 0.002F, 0.006F, 0.0075F}, {0, 200, 90, 0}}};
  node.lean = {0.12F, 0.05F, 0};
  const LeaningResponse lean(node, ResponseKind::Coupled);
  constexpr int kParts = 400;
  for (const double z : {0.0004, 0.0017, 0.003, 0.0059, 0.007}) {
    const double force = lean.normal_force(z);
    EXPECT_NEAR(force, 0.13 * norm(lean.transverse_force(z)), 1e-6 * force);
    double work = 0;  // by the midpoint rule
    for (int k = 0; k < kParts; ++k) work += z / kParts * lean.normal_force(z * (k + 0.5) / kParts);
    EXPECT_NEAR(lean.energy(z), work, 2e-3 * work);
  }
}

TEST(Lean, TheRuntimeRendersTheForcesOfTiltedSprings) {
  for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
    FitSettings settings;
    settings.kind = kind;
    settings.relative_tolerance = 1e-3;
    const Library library = tilted_library(settings);
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
    EXPECT_LT(worst, (kind == ResponseKind::Decoupled ? 0.002 : 0.01) * largest);
    settings.lean = false;
    EXPECT_FALSE(tilted_library(settings).leans());
  }
}

TEST(Lean, TheErrorsOfAFitAreThoseOfWhatIsRendered) {
  FitSettings settings;
  settings.relative_tolerance = 1e-3;
  const double peak = norm(TiltedSprings{settings.kind}.force(kPressed, {}));
  for (const NodeResponse& node : tilted_library(settings).responses) {
    EXPECT_LT(node.normal_error, 1e-3 * peak);
    EXPECT_LT(node.lateral_error, 2e-3 * peak);
  }
}

}  // namespace
}  // namespace palpate::fitting
