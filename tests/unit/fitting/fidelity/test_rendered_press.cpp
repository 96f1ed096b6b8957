// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/rendered_press.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::fidelity {
namespace {

constexpr double kNormal = 120, kLateral = 80;  // N/m
const Vec3 kDown{0, 0, -1};

/// A flat plate of equal springs in a file.
class RenderedPress : public testing::Test {
 protected:
  RenderedPress() : file_(folder_ / "library.h5") {
    Library library = fitting::flat_triangle();
    fitting::set_equal_responses(library, fitting::node_response(fitting::linear_curve(kNormal),
                                                                 fitting::linear_curve(kLateral)));
    fitting::certify(library, {});
    write_library(file_, library);
  }

  samples::TemporaryFolder folder_;
  std::filesystem::path file_;
};

TEST_F(RenderedPress, ForcesOfSpringsAreTheirClosedForm) {
  const Vec3 t{0.6, 0.8, 0};
  const auto forces =
      RenderedBody(file_).press({0.003, 0.003, 0}, kDown, {{0.002, 0, t}, {0.004, 0.001, t}});
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_LT(norm(forces[0] - kNormal * 0.002 * kDown), 1e-6);
  EXPECT_LT(norm(forces[1] - (kNormal * 0.004 * kDown + kLateral * 0.001 * t)), 1e-6);
}

TEST_F(RenderedPress, LargeLateralDeflectionsDoNotSlip) {
  const Vec3 t{1, 0, 0};
  const auto forces = RenderedBody(file_).press({0.003, 0.003, 0}, kDown, {{0.001, 0.005, t}});
  EXPECT_NEAR(dot(forces.at(0), t), kLateral * 0.005, 1e-6);  // far beyond any friction cone
}

/// The direct presses are elastic: they are compared with tissue that has had no time to relax.
TEST_F(RenderedPress, TakesNoTimeInWhichTissueCouldRelax) {
  Library library = read_library(file_);
  library.tool_radius = 0.005;
  library.relaxation_times = {1e-3};
  for (NodeResponse& node : library.responses) node.relaxation = {0.9F};
  fitting::certify(library, {});
  write_library(folder_ / "relaxing.h5", library);
  const auto forces =
      RenderedBody(folder_ / "relaxing.h5")
          .press({0.003, 0.003, 0}, kDown, {{0.002, 0, {1, 0, 0}}, {0.004, 0, {1, 0, 0}}});
  EXPECT_NEAR(norm(forces.at(1) - kNormal * 0.004 * kDown), 0, 1e-6);
}

/// A linear spring that relaxes: the closed form of a ramp and a hold, f = k v integral of g.
TEST_F(RenderedPress, FollowsATravelOverTimeAsTheTissueRelaxes) {
  Library library = read_library(file_);
  library.tool_radius = 0.005;
  library.relaxation_times = {0.2};
  for (NodeResponse& node : library.responses) node.relaxation = {0.5F};
  fitting::certify(library, {});
  write_library(folder_ / "relaxing.h5", library);
  constexpr double kDeep = 0.003, kRamp = 0.3, kStart = 0.1;
  std::vector<double> time, travel;
  for (int i = 0; i <= 300; ++i) {
    time.push_back(0.005 * i);
    travel.push_back(std::clamp(kDeep * (time.back() - kStart) / kRamp, -1e-4, kDeep));
  }
  const auto force =
      RenderedBody(folder_ / "relaxing.h5").follow({0.003, 0.003, 0}, kDown, time, travel);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double t = time[i] - kStart, within = std::clamp(t, 0.0, kRamp);
    const double memory =
        0.5 * 0.2 / kRamp * (1 - std::exp(-within / 0.2)) * std::exp(-(t - within) / 0.2);
    EXPECT_NEAR(force[i], kNormal * kDeep * (0.5 * within / kRamp + (t > 0 ? memory : 0)),
                5e-3 * kNormal * kDeep)
        << t;
  }
}

TEST_F(RenderedPress, RefusesAPointBesideTheSurfaceAndAMissingFile) {
  EXPECT_THROW(RenderedBody(file_).press({0.1, 0.1, 0}, kDown, {{0.001, 0, {1, 0, 0}}}), Error);
  EXPECT_THROW(RenderedBody(folder_ / "none.h5"), Error);
}

}  // namespace
}  // namespace palpate::fidelity
