// SPDX-License-Identifier: AGPL-3.0-or-later
// What a script derives from its library, on plates whose forces are known in closed form.
#include "app/simulate/script.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/simulate/session.hpp"
#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

/// A plate with every length `scale` times as long, and its forces to match.
Library plate_of(double scale) {
  Library library = test::plate(10, 0.1, [](const Vec3&) { return test::wall_response(170, 120); });
  for (Vec3& x : library.positions) x = scale * x;
  library.tool_radius *= scale;
  for (NodeResponse& node : library.responses)
    for (ResponseCurve* curve : {&node.normal, &node.lateral}) {
      for (float& knot : curve->knot) knot *= static_cast<float>(scale);
      for (float& slope : curve->slope) slope *= static_cast<float>(scale);
    }
  fitting::certify(library, {0.3, {}});
  return library;
}

TEST(Script, PressesToHalfOfWhatEveryResponseKnows) {
  Library library = plate_of(1);
  const double depth = depth_of_responses(library);
  EXPECT_DOUBLE_EQ(settled({}, library).press_depth, 0.5 * depth);
  library.responses[3].normal.knot.back() *= 0.75F;  // a site that ended early
  EXPECT_NEAR(settled({}, library).press_depth, 0.375 * depth, 1e-9);
}

TEST(Script, KeepsWhatIsGiven) {
  SimulateSection given;
  given.press_depth = 0.001;
  given.device.mass = 0.5;
  const SimulateSection script = settled(given, plate_of(1));
  EXPECT_EQ(script.press_depth, 0.001);
  EXPECT_EQ(script.device.mass, 0.5);
  EXPECT_DOUBLE_EQ(script.press_speed, 0.003);  // 1.5 times the mean of 2 mm in 1 s
}

TEST(Script, HoldsWhereTheTissueRelaxes) {
  EXPECT_EQ(settled({}, plate_of(1)).hold, 0);
  EXPECT_DOUBLE_EQ(settled({}, test::relaxing(plate_of(1), {0.1, 0.4}, true)).hold, 0.8);
  EXPECT_DOUBLE_EQ(settled({}, test::relaxing(plate_of(1), {0.1, 40}, true)).hold, 5);
}

TEST(Script, HasATankThatGrowsWithTheEnergyOfAPress) {
  // Twice as large in every length, a wall of the same tissue stores eight times the energy.
  const double ten = settled({}, plate_of(10)).tank_cap;
  EXPECT_GT(ten, 5e-3);
  EXPECT_NEAR(settled({}, plate_of(20)).tank_cap, 8 * ten, 1e-5 * ten);
  EXPECT_EQ(settled({}, plate_of(0.1)).tank_cap, 5e-3);
  SimulateSection given;
  given.tank_cap = 0;
  EXPECT_EQ(settled(given, plate_of(10)).tank_cap, 0);
}

TEST(Script, RefusesALibraryWithoutResponses) {
  Library library = plate_of(1);
  for (NodeResponse& node : library.responses) node.status = ResponseStatus::Hole;
  EXPECT_THROW(settled({}, library), Error);
}

struct Played {
  std::vector<RecordedStep> steps;
  double depth = 0;  ///< of the responses
};

Played play(double scale) {
  const samples::TemporaryFolder folder;
  const Library library = plate_of(scale);
  write_library(folder / "library.h5", library);
  Played played{{}, depth_of_responses(library)};
  ScriptedSession(folder / "library.h5", library, {}).play([&](const RecordedStep& step) {
    played.steps.push_back(step);
  });
  return played;
}

/// A session by default has the same shape on a plate of 0.8 mm, of 10 cm and of 12.8 m, touches,
/// slides, and stays within what is known.
TEST(Script, HasTheSameShapeAtEverySize) {
  const Played reference = play(1);
  for (const double scale : {1.0, 1.0 / 128, 128.0}) {
    const Played played = play(scale);
    ASSERT_EQ(played.steps.size(), reference.steps.size());
    double deepest = 0, largest = 0;
    bool slides = false;
    for (std::size_t i = 0; i < played.steps.size(); ++i) {
      const RecordedStep &step = played.steps[i], &same = reference.steps[i];
      deepest = std::max(deepest, step.depth);
      largest = std::max(largest, norm(step.force));
      slides = slides || (step.status & PALPATE_SLIDING) != 0;
      EXPECT_FALSE(step.status & PALPATE_BEYOND_DEPTH);
      ASSERT_NEAR(step.depth / scale, same.depth, 1e-3 * reference.depth) << scale << ' ' << i;
    }
    EXPECT_TRUE(slides);
    EXPECT_GT(deepest, 0.3 * played.depth);
    EXPECT_LT(deepest, 0.5 * played.depth);
    EXPECT_GT(largest, 0);
  }
}

}  // namespace
}  // namespace palpate::app
