// SPDX-License-Identifier: AGPL-3.0-or-later
// The deformed skin through the C interface: load, deform beside a force loop, and every refusal.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "runtime/palpate.h"
#include "tests/unit/runtime/api_fixture.hpp"

namespace palpate::test {
namespace {

constexpr double kReach = 0.02, kDeepest = 0.006;

/// The skin is the response surface. It moves by the depth and the lateral deflection where it is
/// touched, and by (1 - s/R_c) of it at the distance s, at every depth: under a disc.
Deformation cone(const Library& library) {
  Deformation d;
  d.surface = surface_digest(library.positions, library.triangles);
  d.tool_shape = "disc";
  d.tool_radius = 1e-4;
  d.reach = kReach;
  d.positions = library.positions;
  d.triangles = library.triangles;
  d.depths = {kDeepest};
  d.lateral_depths = {kDeepest};
  d.knots = {0, kReach};
  d.donor_offset = {0};
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    const auto row = static_cast<std::int32_t>(v);
    d.vertex_of.push_back(row);
    d.sites.push_back({library.positions[v], library.inward[v], {1, 0, 0}});
    d.donor.push_back(row);
    d.donor_weight.push_back(1);
    d.donor_offset.push_back(static_cast<std::int64_t>(v) + 1);
    d.press_local.insert(d.press_local.end(), {static_cast<float>(kDeepest), 0, 0, 0});
    d.lateral_local.insert(d.lateral_local.end(), {1, 0, 1, 0, 0, 0});
  }
  return d;
}

constexpr double kRadius = 0.05;  ///< of the sphere in dimple()

/// The displacement of the skin of a half-space under a frictionless sphere, at the distance s,
/// along its normal: within the contact radius a = sqrt(R z) the paraboloid of the sphere, outside
///   z/pi ((2 - s^2/a^2) asin(a/s) + sqrt(s^2/a^2 - 1))      [Johnson 1985, eq. 3.42].
double of_half_space(double s, double z) {
  const double ratio = s / std::sqrt(kRadius * z);
  if (ratio <= 1) return z * (1 - 0.5 * ratio * ratio);
  return z / std::numbers::pi *
         ((2 - ratio * ratio) * std::asin(1 / ratio) + std::sqrt(ratio * ratio - 1));
}

/// cone() with the dimple of a half-space under a sphere, known at `depths`.
Deformation dimple(const Library& library, const std::vector<double>& depths) {
  Deformation d = cone(library);
  d.tool_shape = "sphere";
  d.tool_radius = kRadius;
  d.reach = 0.6;
  d.knots.clear();
  for (int j = 0; j < 60; ++j) d.knots.push_back(d.reach * std::pow(j / 59.0, 2));
  d.depths = depths;
  d.lateral_depths.clear();
  d.lateral_local.clear();
  d.press_local.clear();
  for (std::size_t site = 0; site < d.sites.size(); ++site)
    for (const double depth : depths) {
      for (const double s : d.knots)
        d.press_local.push_back(
            static_cast<float>(of_half_space(s, depth) - of_half_space(d.reach, depth)));
      d.press_local.insert(d.press_local.end(), d.knots.size(), 0.0F);
    }
  return d;
}

class PalpateDeformation : public PalpateApi {
 protected:
  void SetUp() override {
    PalpateApi::SetUp();
    file_ = (folder_ / "deformation.pdef").string();
    at_rest_ = read_library(path_).positions;
    write_deformation(file_, cone(read_library(path_)));
    ASSERT_EQ(palpate_deformation_load(library_, file_.c_str(), &deformation_), PALPATE_OK)
        << palpate_last_error();
  }
  void TearDown() override {
    palpate_deformation_destroy(deformation_);
    PalpateApi::TearDown();
  }

  void use(const Deformation& d) {
    palpate_deformation_destroy(deformation_);
    write_deformation(file_, d);
    ASSERT_EQ(palpate_deformation_load(library_, file_.c_str(), &deformation_), PALPATE_OK)
        << palpate_last_error();
  }
  void press(double depth) {
    palpate_state_reset(state_);
    for (const double z : {0.001, -0.5 * depth, -depth}) step({0.03, 0.03, z});
  }

  std::vector<Vec3> deformed() const {
    std::vector<Vec3> x(at_rest_.size());
    EXPECT_EQ(palpate_deform(state_, deformation_, x.front().data(), x.size()), PALPATE_OK);
    return x;
  }

  std::string file_;
  std::vector<Vec3> at_rest_;
  palpate_deformation* deformation_ = nullptr;
};

TEST_F(PalpateDeformation, DescribesTheSkin) {
  palpate_deformation_info info{};
  info.size = sizeof info;
  ASSERT_EQ(palpate_deformation_describe(deformation_, &info), PALPATE_OK);
  EXPECT_EQ(info.vertices, 81);
  EXPECT_EQ(info.triangles, 128);
  EXPECT_EQ(info.sites, 81);
  EXPECT_EQ(info.modes, 0);
  EXPECT_EQ(info.depth, kDeepest);
  EXPECT_EQ(info.reach, kReach);
  std::vector<Vec3> positions(81);
  std::vector<Triangle> triangles(128);
  ASSERT_EQ(palpate_deformation_vertices(deformation_, positions[0].data(), 81), PALPATE_OK);
  ASSERT_EQ(palpate_deformation_triangles(deformation_, triangles[0].data(), 128), PALPATE_OK);
  EXPECT_EQ(positions, at_rest_);
  EXPECT_EQ(triangles, read_library(path_).triangles);
}

TEST_F(PalpateDeformation, FollowsTheTipAndComesBack) {
  EXPECT_EQ(deformed(), at_rest_);
  step({0.03, 0.03, 0.001});
  step({0.03, 0.03, -0.001});
  step({0.03, 0.03, -0.004});
  const double s = 0.01, z = 0.004;  // of the next vertex; the tip is on one
  for (std::size_t v = 0; v < at_rest_.size(); ++v) {
    const double distance = norm(at_rest_[v] - Vec3{0.03, 0.03, 0});
    const double expected = distance < 1e-9 ? z : distance < s + 1e-9 ? z * (1 - s / kReach) : 0;
    if (distance < s + 1e-9 || distance > kReach) {
      EXPECT_NEAR(deformed()[v][2], -expected, 1e-8) << v;
    }
  }
  // Sideways: the contact point goes with the tip until friction slips.
  step({0.0301, 0.03, -0.004});
  const palpate_observation seen = observe();
  const auto x = deformed();
  double nearest = 1;
  for (const Vec3& at : x) nearest = std::min(nearest, norm(at - Vec3{0.0301, 0.03, -0.004}));
  EXPECT_LT(nearest, seen.lateral > 0.999e-4 ? 1e-8 : 1e-4);
  step({0.03, 0.03, 0.001});
  EXPECT_EQ(deformed(), at_rest_);
}

/// The dimple of a sphere at depths that the file does not have: it is as wide as the contact.
TEST_F(PalpateDeformation, GrowsWithTheContactOfASphere) {
  for (const std::vector<double>& depths : {std::vector{0.004}, std::vector{0.002, 0.006}}) {
    use(dimple(read_library(path_), depths));
    for (const double z : {0.0008, 0.001, 0.003, 0.004, 0.005}) {
      press(z);
      const std::vector<Vec3> x = deformed();
      for (std::size_t v = 0; v < x.size(); ++v) {
        const double s = norm(at_rest_[v] - Vec3{0.03, 0.03, 0});
        EXPECT_NEAR(-x[v][2], of_half_space(s, z), 0.02 * z) << s << " m away, " << z << " m deep";
      }
    }
  }
}

/// What the tissue slips across n under the tool in a press of the campaign, it does in the
/// picture; a lateral deflection is added to it.
TEST_F(PalpateDeformation, SlipsUnderTheToolAsInTheCampaign) {
  Deformation d = cone(read_library(path_));
  const Vec3 slip{0.0006, -0.0003, 0};
  d.mode_scale = {1e-7F};
  for (std::size_t v = 0; v < d.positions.size(); ++v)
    for (const double u : slip) d.modes.push_back(static_cast<std::int16_t>(std::lround(u * 1e7)));
  d.press_modes.assign(d.sites.size(), 1);
  d.lateral_modes.assign(2 * d.sites.size(), 0);
  use(d);
  press(kDeepest);
  const std::size_t touched = 3 * 9 + 3;
  ASSERT_LT(norm(at_rest_[touched] - Vec3{0.03, 0.03, 0}), 1e-12);
  EXPECT_LT(norm(deformed()[touched] - (at_rest_[touched] + slip + Vec3{0, 0, -kDeepest})), 1e-8);
  step({0.03005, 0.03, -kDeepest});
  ASSERT_NEAR(observe().lateral, 5e-5, 1e-12);
  EXPECT_LT(norm(deformed()[touched] - (at_rest_[touched] + slip + Vec3{5e-5, 0, -kDeepest})),
            1e-8);
}

TEST_F(PalpateDeformation, BadInputAndResetBringItBackToRest) {
  const auto press = [&] {
    step({0.03, 0.03, 0.001});
    step({0.03, 0.03, -0.001});
    step({0.03, 0.03, -0.004});
    ASSERT_NE(deformed(), at_rest_);
  };
  press();
  step({0.03, 0.03, -10});
  EXPECT_EQ(deformed(), at_rest_);
  palpate_state_reset(state_);
  press();
  palpate_state_reset(state_);
  EXPECT_EQ(deformed(), at_rest_);
  press();
  const double x[3] = {0.03, 0.03, -0.004};
  double force[3];
  palpate_step(state_, x, nullptr, kDt, force);
  EXPECT_EQ(deformed(), at_rest_);
}

TEST_F(PalpateDeformation, IsInTheWorldAtOnceWhenTheBodyMoves) {
  const double shift[3] = {1, 2, 3};
  const double turned[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  ASSERT_EQ(palpate_state_set_pose(state_, shift, turned), PALPATE_OK);
  const auto x = deformed();
  for (std::size_t v = 0; v < x.size(); ++v) {
    EXPECT_NEAR(x[v][0], 1 - at_rest_[v][1], 1e-15);
    EXPECT_NEAR(x[v][1], 2 + at_rest_[v][0], 1e-15);
    EXPECT_NEAR(x[v][2], 3 + at_rest_[v][2], 1e-15);
  }
}

// Every picture is of one step: the vertex under the tip is as deep as its neighbour says.
TEST_F(PalpateDeformation, APictureFromAnotherThreadIsOfOneStep) {
  std::atomic<bool> over{false};
  std::thread loop([&] {
    for (int i = 0; i < 20000; ++i) {
      const double phase = i % 400 < 200 ? i % 200 : 200 - i % 200;
      step({0.03, 0.03, 0.0001 - 2e-5 * phase});
    }
    over = true;
  });
  std::size_t pictures = 0, pressed = 0;
  const std::size_t middle = 3 * 9 + 3;
  while (!over) {
    const auto x = deformed();
    ++pictures;
    if (x[middle][2] < 0) ++pressed;
    ASSERT_NEAR(x[middle + 1][2], 0.5 * x[middle][2], 1e-8);
    ASSERT_NEAR(x[middle + 9][2], 0.5 * x[middle][2], 1e-8);
  }
  loop.join();
  EXPECT_GT(pictures, 0U);
}

TEST_F(PalpateDeformation, RefusesAFileWithTheReasonOfTheSkin) {
  palpate_deformation* none = deformation_;
  EXPECT_EQ(palpate_deformation_load(library_, (folder_ / "absent.pdef").c_str(), &none),
            PALPATE_ERROR_FILE);
  EXPECT_EQ(none, nullptr);
  EXPECT_NE(std::strstr(palpate_last_error(), "absent.pdef"), nullptr);
  EXPECT_NE(std::strstr(palpate_last_error(), "[deformation]"), nullptr);
  EXPECT_EQ(palpate_deformation_load(library_, path_.c_str(), &none), PALPATE_ERROR_FORMAT);
  const std::string flat = (folder_ / "library.plib").string();
  write_flat_library(flat, read_library(path_));
  EXPECT_EQ(palpate_deformation_load(library_, flat.c_str(), &none), PALPATE_ERROR_FORMAT);
  EXPECT_EQ(palpate_deformation_load(library_, folder_.c_str(), &none), PALPATE_ERROR_FILE);
  EXPECT_EQ(palpate_deformation_load(nullptr, file_.c_str(), &none), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_deformation_load(library_, file_.c_str(), nullptr), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_deformation_load(library_, "", &none), PALPATE_ERROR_ARGUMENT);

  Library other = read_library(path_);
  other.positions.front()[0] -= 1e-6;
  write_deformation(file_, cone(other));
  EXPECT_EQ(palpate_deformation_load(library_, file_.c_str(), &none), PALPATE_ERROR_MISMATCH);
  EXPECT_STRNE(palpate_status_text(PALPATE_ERROR_MISMATCH), "unknown status");
}

TEST_F(PalpateDeformation, LoadsFromMemory) {
  const std::string bytes = content_of(file_);
  palpate_deformation* loaded = nullptr;
  ASSERT_EQ(palpate_deformation_load_memory(library_, bytes.data(), bytes.size(), &loaded),
            PALPATE_OK);
  palpate_deformation_destroy(loaded);
  EXPECT_EQ(palpate_deformation_load_memory(library_, bytes.data(), bytes.size() - 1, &loaded),
            PALPATE_ERROR_FORMAT);
  EXPECT_EQ(loaded, nullptr);
  EXPECT_EQ(palpate_deformation_load_memory(library_, nullptr, 1, &loaded), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateDeformation, RefusesOtherArgumentsAndNeverOverrunsThePositions) {
  std::vector<Vec3> x(81, Vec3{7, 7, 7});
  EXPECT_EQ(palpate_deform(state_, deformation_, x[0].data(), 80), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(x.front()[0], 7);
  EXPECT_EQ(palpate_deform(nullptr, deformation_, x[0].data(), 81), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_deform(state_, nullptr, x[0].data(), 81), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_deform(state_, deformation_, nullptr, 81), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_deformation_vertices(nullptr, x[0].data(), 81), PALPATE_ERROR_ARGUMENT);

  palpate_library* again = nullptr;
  palpate_state* stranger = nullptr;
  ASSERT_EQ(palpate_library_load(path_.c_str(), &again), PALPATE_OK);
  ASSERT_EQ(palpate_state_create(again, &settings_, &stranger), PALPATE_OK);
  EXPECT_EQ(palpate_deform(stranger, deformation_, x[0].data(), 81), PALPATE_ERROR_MISMATCH);
  palpate_state_destroy(stranger);
  palpate_library_destroy(again);
}

}  // namespace
}  // namespace palpate::test
