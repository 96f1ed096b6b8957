// SPDX-License-Identifier: AGPL-3.0-or-later
// The force loop on a library of tissue that relaxes, made by one elastic campaign, against the
// solid that relaxes: internal variables at the Gauss points under the same motion of the tool.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "fem/campaign/indentation.hpp"
#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/relaxation/relaxing_press.hpp"
#include "fitting/response/fit.hpp"
#include "format/to_index.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "tests/support/block_body.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

constexpr double kDepth = 1.5e-3;                               // m, 0.3 radii of the tool
constexpr double kDragged = 0.5e-3, kDragDepth = 0.5 * kDepth;  // m
constexpr double kSticks = 50;  // a friction coefficient with which nothing slips

/// A block whose upper part, as thick as the press is deep twice, is another region.
Body layered_block() {
  Body body = test::make_block(test::even(-0.01, 0.01, 8), test::even(-0.01, 0.01, 8),
                               test::even(-0.009, 0, 6));
  body.region_names = {"skin", "deep"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double z = 0;
    for (const auto node : body.tetrahedra[t]) z += body.nodes[to_index(node)][2] / 4;
    body.tetrahedron_region[t] = z > -0.003 ? 0 : 1;
  }
  return body;
}

CampaignSettings settings_of(const RelaxationSeries& skin, const RelaxationSeries& deep,
                             ResponseKind kind, ToolFriction friction) {
  CampaignSettings settings;
  settings.materials = {{"skin", {15e3, 0.48}, 0, skin}, {"deep", {8e3, 0.48}, 0, deep}};
  settings.indentation.tool.radius = 0.005;
  settings.indentation.depth = kDepth;
  settings.indentation.increments = 6;
  settings.indentation.lateral_depths = {kDragDepth};
  if (kind == ResponseKind::Coupled)
    settings.indentation.lateral_depths = {0.25 * kDepth, kDragDepth, kDepth};
  settings.indentation.lateral_travel = kDragged;
  settings.indentation.lateral_increments = 2;
  settings.indentation.force_tolerance = 1e-6;
  settings.indentation.friction = friction;
  return settings;
}

/// Solid and library of the same body.
class Both {
 public:
  Both(const RelaxationSeries& skin, const RelaxationSeries& deep,
       ResponseKind kind = ResponseKind::Decoupled,
       ToolFriction friction = ToolFriction::Frictionless)
      : kind_(kind),
        body_(layered_block()),
        settings_(settings_of(skin, deep, kind, friction)),
        site_(test::site_nearest(body_)),
        library_(made()),
        loaded_(library_) {}

  /// The force of the solid and of the loop, N, at the ends of the time steps of the solid.
  struct Sample {
    double time = 0, travel = 0, solid = 0, loop = 0;
    double drag = 0, solid_drag = 0, loop_drag = 0;
  };
  std::vector<Sample> follow(const std::vector<ToolMotion>& motion) const {
    const RelaxingPress press = press_relaxing(body_, settings_, site_, motion, {1e-3, 2000});
    EXPECT_TRUE(press.complete) << press.reason;
    runtime::ContactState contact(loaded_.surface, loaded_.tree, {kSticks, 0});
    const Vec3 inward = library_.inward[to_index(site_)];
    const Vec3 aside = to_vec3(tangent_frame(to_eigen(inward))[0]);
    const auto at = [&](double travel, double drag, double dt) {
      contact.step(library_.positions[to_index(site_)] + travel * inward + drag * aside, dt);
    };
    at(-1e-9, 0, 1e-12);
    at(1e-12, 0, 1e-12);
    std::vector<Sample> samples;
    double time = 0, travel = 0, drag = 0;
    for (const RelaxingSample& sample : press.samples) {
      constexpr int kSteps = 50;
      for (int i = 1; i <= kSteps; ++i)
        at(travel + (sample.travel - travel) * i / kSteps, drag + (sample.drag - drag) * i / kSteps,
           std::max(sample.time_s - time, 1e-9) / kSteps);
      time = sample.time_s;
      travel = sample.travel;
      drag = sample.drag;
      const Vec3 force = contact.observation().force;
      samples.push_back({time, travel, dot(sample.force, inward), dot(force, inward), drag,
                         dot(sample.force, aside), dot(force, aside)});
    }
    return samples;
  }

 private:
  Library made() const {
    const CampaignContext context(body_, settings_, Engine::Direct);
    Curves curves;
    curves.tool.shape = "sphere";
    curves.tool.radius = settings_.indentation.tool.radius;
    curves.depth = kDepth;
    curves.relaxation = context.relaxation;
    curves.sites = {solve_site(context, site_, nullptr)};
    fitting::FitSettings fit;
    fit.kind = kind_;
    fit.relative_tolerance = 1e-3;
    fit.absolute_tolerance = 1e-5;
    fit.fill_holes = true;
    fit.interpolate = false;
    return fitting::fit(body_, curves, fit);
  }

  ResponseKind kind_;
  Body body_;
  CampaignSettings settings_;
  std::int32_t site_;
  Library library_;
  palpate_library loaded_;
};

constexpr auto kProblem =
    "A library of tissue that relaxes against the solid: a press of 0.3 R on two layers";
const RelaxationSeries kSkin{{0.35, 0.05}, {0.15, 1}}, kDeep{{0.1, 0.05}, {0.4, 1}};

void check(const std::string& what, double loop, double solid, double peak, double bound) {
  test::verify({kProblem, what + ", over the force of an instant press", "1", loop / peak,
                solid / peak, test::Reference::SameSolver, "internal variables at the Gauss points",
                bound, test::Error::Absolute});
}

class RelaxingLibrary : public ::testing::Test {
 protected:
  static const Both& layers() {
    static const Both both(kSkin, kDeep);
    return both;
  }
  /// The force of the solid when the press takes no time.
  static double peak() {
    static const double force = layers().follow({{0, 0}, {0, kDepth}}).back().solid;
    return force;
  }
};

TEST_F(RelaxingLibrary, RampsAtFourRatesOverThreeDecades) {
  for (const double time : {0.01, 0.1, 1.0, 10.0}) {
    const auto samples = layers().follow({{0, 0}, {time, kDepth}});
    char what[64];
    std::snprintf(what, sizeof what, "pressed in %g s", time);
    check(what, samples.back().loop, samples.back().solid, peak(), 0.02);
    for (const auto& s : samples) EXPECT_NEAR(s.loop, s.solid, 0.02 * peak()) << what << s.time;
  }
}

TEST_F(RelaxingLibrary, AStepAndAHoldRelaxAsTheSolidDoes) {
  const auto samples =
      layers().follow({{0, 0}, {0, kDepth}, {0.05, kDepth}, {1, kDepth}, {5, kDepth}});
  for (const auto& s : samples) {
    EXPECT_NEAR(s.loop, s.solid, 0.02 * peak()) << s.time;
    const bool end = s.time == 0.05 || s.time == 1 || s.time == 5;
    if (!end) continue;
    char what[64];
    std::snprintf(what, sizeof what, "held for %g s", s.time);
    check(what, s.loop, s.solid, peak(), 0.02);
  }
}

TEST_F(RelaxingLibrary, CyclesHaveTheHysteresisOfTheSolid) {
  std::vector<ToolMotion> motion{{0, 0}, {0.1, kDepth}};
  for (int i = 0; i < 3; ++i) {
    motion.push_back({0.2 + 0.2 * i, 0.57 * kDepth});
    motion.push_back({0.3 + 0.2 * i, kDepth});
  }
  const auto samples = layers().follow(motion);
  double loop = 0, solid = 0, worst = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto &a = samples[i - 1], &b = samples[i];
    worst = std::max(worst, std::abs(b.loop - b.solid));
    if (a.time < 0.5 - 1e-9) continue;  // the last cycle
    loop += (a.loop + b.loop) / 2 * (b.travel - a.travel);
    solid += (a.solid + b.solid) / 2 * (b.travel - a.travel);
  }
  EXPECT_LE(worst, 0.02 * peak());
  check("largest difference over three cycles by 43 %", worst, 0, peak(), 0.02);
  const double cycle = peak() * 0.43 * kDepth;
  test::verify({kProblem, "energy lost in the third cycle by 43 %, over peak force times travel",
                "1", loop / cycle, solid / cycle, test::Reference::SameSolver,
                "internal variables at the Gauss points", 0.005, test::Error::Absolute});
}

}  // namespace
/// The largest difference of the lateral forces while dragged in a time and held, over the force of
/// an instant drag; a row for the end of the drag and for two times of the hold.
double drag_and_hold(const Both& both, const char* problem, double time, double bound) {
  const double at_once =
      both.follow({{0, 0}, {0, kDragDepth}, {0, kDragDepth, kDragged}}).back().solid_drag;
  const auto samples = both.follow({{0, 0},
                                    {0, kDragDepth},
                                    {time, kDragDepth, kDragged},
                                    {time + 0.1, kDragDepth, kDragged},
                                    {time + 2, kDragDepth, kDragged}});
  double worst = 0;
  for (const auto& s : samples) {
    worst = std::max(worst, std::abs(s.loop_drag - s.solid_drag) / at_once);
    const double held = s.time - time;
    if (s.drag < kDragged || !(std::abs(held * (held - 0.1) * (held - 2)) < 1e-9)) continue;
    char what[96];
    std::snprintf(what, sizeof what,
                  "dragged in %g s, held for %.1f s, over the force of an instant drag", time,
                  held);
    test::verify({problem, what, "1", s.loop_drag / at_once, s.solid_drag / at_once,
                  test::Reference::SameSolver, "internal variables at the Gauss points", bound,
                  test::Error::Absolute});
  }
  return worst;
}

TEST(RelaxingLibraryAside, DragsAtThreeRatesThatHoldRelaxAsTheSolidDoes) {
  const Both alike(kSkin, kSkin);
  for (const double time : {0.01, 0.1, 1.0})
    EXPECT_LE(drag_and_hold(alike,
                            "A library of tissue that relaxes against the solid: a drag of 0.1 R "
                            "in a press of 0.15 R, one series",
                            time, 0.04),
              0.04);
}

TEST(RelaxingLibraryAside, ADragOverLayersThatRelaxDifferentlyIsNear) {
  const Both layers(kSkin, kDeep);
  EXPECT_LE(drag_and_hold(layers,
                          "A library of tissue that relaxes against the solid: a drag of 0.1 R in "
                          "a press of 0.15 R on two layers",
                          0.1, 0.05),
            0.05);
}

TEST(RelaxingLibraryAside, ADragOfCoupledResponsesRelaxesAsTheSolidDoes) {
  const Both alike(kSkin, kSkin, ResponseKind::Coupled);
  EXPECT_LE(drag_and_hold(alike,
                          "A library of tissue that relaxes against the solid: a drag of 0.1 R in "
                          "a press of 0.15 R, one series, coupled",
                          0.1, 0.04),
            0.04);
}

TEST(RelaxingLibraryAside, ADragThatIsHeldWhileThePressGoesOnRelaxesAsTheSolidDoes) {
  // What the contact takes in as it grows is not sheared: in the solid, nodes stick as they touch.
  constexpr auto kHeld =
      "A library of tissue that relaxes against the solid: a drag of 0.1 R held from 0.15 R to 0.3 "
      "R, one series, coupled";
  constexpr double kMore = 0.3 * kDragged, kBound = 0.04;
  const Both alike(kSkin, kSkin, ResponseKind::Coupled, ToolFriction::NoSlip);
  // The forces of the same drags in no time.
  const double at_once =
      alike.follow({{0, 0}, {0, kDragDepth}, {0, kDragDepth, kDragged}}).back().solid_drag;
  const double more_at_once = alike
                                  .follow({{0, 0},
                                           {0, kDragDepth},
                                           {0, kDragDepth, kDragged},
                                           {0, kDepth, kDragged},
                                           {0, kDepth, kDragged + kMore}})
                                  .back()
                                  .solid_drag;
  const auto samples = alike.follow({{0, 0},
                                     {0, kDragDepth},
                                     {0.05, kDragDepth, kDragged},
                                     {0.15, kDepth, kDragged},
                                     {1.15, kDepth, kDragged},
                                     {1.25, kDepth, kDragged + kMore}});
  for (const auto& s : samples) {
    const double whole = s.drag > kDragged ? more_at_once : at_once;
    EXPECT_NEAR(s.loop_drag, s.solid_drag, kBound * whole) << s.time;
  }
  const auto at = [&](double time) {
    return *std::find_if(samples.begin(), samples.end(),
                         [&](const auto& s) { return s.time > time - 1e-9; });
  };
  const auto row = [&](const char* what, double loop, double solid, double bound) {
    test::verify({kHeld, what, "1", loop, solid, test::Reference::SameSolver,
                  "internal variables at the Gauss points", bound, test::Error::Absolute});
  };
  const auto grown = at(0.15), relaxed = at(1.15), dragged = at(1.25);
  row("after the press, over the force of an instant drag", grown.loop_drag / at_once,
      grown.solid_drag / at_once, kBound);
  row("held for 1 s, over the force after the press", relaxed.loop_drag / grown.loop_drag,
      relaxed.solid_drag / grown.solid_drag, 0.01);
  row("rise of a drag on by 0.03 R, over the force of an instant drag",
      (dragged.loop_drag - relaxed.loop_drag) / at_once,
      (dragged.solid_drag - relaxed.solid_drag) / at_once, 0.02);
}

}  // namespace palpate::fem
