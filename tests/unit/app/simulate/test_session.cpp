// SPDX-License-Identifier: AGPL-3.0-or-later
// A script played through the C interface, on a plate whose forces are known in closed form.
#include "app/simulate/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

constexpr double kNormal = 170, kLateral = 120;  // N/m

class Session : public testing::Test {
 protected:
  Session() {
    fitting::CertifySettings settings;
    settings.friction = 0.3;
    fitting::certify(library_, settings);
    write_library(file_, library_);
    script_.press_depth = 0.004;
    script_.slide_length = 0.02;
    script_.device = kPublishedDevice;
  }
  std::vector<RecordedStep> played() {
    std::vector<RecordedStep> steps;
    ScriptedSession(file_, library_, script_).play([&](const RecordedStep& step) {
      steps.push_back(step);
    });
    return steps;
  }

  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "library.h5";
  Library library_ =
      test::plate(10, 0.1, [](const Vec3&) { return test::wall_response(kNormal, kLateral); });
  SimulateSection script_;
};

/// Press, slide and release as the script says, and every step's force is that of the plate at the
/// depth that it reports.
TEST_F(Session, FeelsThePlateWhereTheHandGoes) {
  const auto steps = played();
  ASSERT_GT(steps.size(), 2000u);
  int touching = 0;
  double deepest = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].time_ns, std::llround(1e9 * static_cast<double>(i) / script_.rate));
    const double z = -steps[i].position[2];
    deepest = std::max(deepest, z);
    if (!(steps[i].status & PALPATE_CONTACT)) continue;
    ++touching;
    EXPECT_NEAR(steps[i].depth + steps[i].offset, z, 1e-12);
    ASSERT_NEAR(steps[i].force[2], 100 * kNormal * std::pow(steps[i].depth, 2), 1e-6);
    // Friction: a lateral force of at most mu times the normal one.
    const double lateral = std::hypot(steps[i].force[0], steps[i].force[1]);
    EXPECT_LE(lateral, 0.3 * steps[i].force[2] * (1 + 1e-6) + 1e-9);
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(deepest, 0.7 * script_.press_depth);  // the spring of the hand gives way
  EXPECT_LT(deepest, script_.press_depth);
  const RecordedStep &first = steps.front(), &last = steps.back();
  EXPECT_GT(first.position[2], 0);
  EXPECT_GT(last.position[2], 0);
  EXPECT_GT(std::hypot(last.position[0] - first.position[0], last.position[1] - first.position[1]),
            0.9 * script_.slide_length);
  EXPECT_GE(last.absorbed, 0);  // passive
}

TEST_F(Session, SlidesBetweenTheGivenPoints) {
  script_.path = SlidePath::Between;
  script_.from = {0.02, 0.03, 0};
  script_.to = {0.08, 0.05, 0};
  const auto steps = played();
  const double tile = 0.01;  // m
  EXPECT_NEAR(norm(steps.front().position - script_.from), 0, tile);
  EXPECT_NEAR(norm(steps.back().position - script_.to), 0, tile);
}

TEST_F(Session, IsTheSameEveryTime) {
  const auto once = played(), twice = played();
  ASSERT_EQ(once.size(), twice.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    ASSERT_EQ(once[i].force, twice[i].force) << i;
    ASSERT_EQ(once[i].position, twice[i].position) << i;
  }
}

TEST_F(Session, IsHeadedByWhatItsForcesDependOn) {
  script_.tank_cap = 2e-3;
  const RecordingHeading heading = ScriptedSession(file_, library_, script_, 5000).heading();
  EXPECT_EQ(heading.library_sha256, sha256_of_file(file_));
  EXPECT_EQ(heading.rate, script_.rate);
  EXPECT_EQ(heading.friction, 0.3);
  EXPECT_EQ(heading.settings.lipschitz_bound, 5000);
  EXPECT_EQ(heading.settings.tank_cap, 2e-3);
}

TEST_F(Session, RefusesALibraryThatIsNotThere) {
  EXPECT_THROW(ScriptedSession(folder_ / "none.h5", library_, script_), Error);
}

}  // namespace
}  // namespace palpate::app
