// SPDX-License-Identifier: AGPL-3.0-or-later
// tests/golden/library-1.h5 was written once, by the first release of schema 1, and never again:
// whatever reads libraries later must read it as it was meant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "format/library.hpp"
#include "runtime/palpate.h"
#include "tests/support/source_folder.hpp"

namespace palpate {
namespace {

const std::filesystem::path kGolden = test::source_folder() / "tests/golden/library-1.h5";

TEST(GoldenLibrary, KeepsItsSurface) {
  const Library library = read_library(kGolden);
  EXPECT_EQ(library.name, "golden plate");
  EXPECT_EQ(library.tool_shape, "sphere");
  EXPECT_EQ(library.tool_radius, 0.005);
  EXPECT_EQ(
      library.positions,
      (std::vector<Vec3>{{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {-0.02, 0, 0}, {0, -0.02, 0}}));
  EXPECT_EQ(library.inward,
            (std::vector<Vec3>{{0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {0, 0.6, -0.8}, {0, 0, -1}}));
  EXPECT_EQ(library.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}}));
}

TEST(GoldenLibrary, KeepsItsResponses) {
  const Library library = read_library(kGolden);
  ASSERT_EQ(library.responses.size(), 5u);
  const NodeResponse& first = library.responses[0];
  EXPECT_EQ(first.status, ResponseStatus::Fitted);
  EXPECT_EQ(first.normal.knot, (std::vector<float>{0, 0.002F, 0.006F}));
  EXPECT_EQ(first.normal.slope, (std::vector<float>{0, 100, 120}));
  EXPECT_EQ(first.lateral.knot, (std::vector<float>{0, 0.003F}));
  EXPECT_EQ(first.lateral.slope, (std::vector<float>{80, 60}));
  EXPECT_EQ(first.normal_error, 0.001);
  EXPECT_EQ(first.lateral_error, 0.002);
  EXPECT_EQ(library.responses[2].status, ResponseStatus::Interpolated);
  EXPECT_EQ(library.responses[2].normal.slope, (std::vector<float>{0, 200, 240, 240}));
  EXPECT_EQ(library.responses[3].status, ResponseStatus::Fitted);
  EXPECT_EQ(library.responses[4].status, ResponseStatus::Hole);
  EXPECT_TRUE(library.responses[4].normal.knot.empty());
}

TEST(GoldenLibrary, KeepsItsCertificateAndProvenance) {
  const Library library = read_library(kGolden);
  const Certificate& c = library.certificate;
  EXPECT_EQ(c.friction, 0.25);
  EXPECT_EQ(c.depth, 0.006);
  EXPECT_EQ(c.stick, 240);
  EXPECT_TRUE(std::isinf(c.slip));
  // From before L_min was known: the runtime keeps 4 L_stick, and nothing is certified for it.
  EXPECT_TRUE(std::isnan(c.min_lipschitz_bound));
  EXPECT_EQ(enforced_lipschitz_bound(c), 960);
  EXPECT_TRUE(std::isinf(certified_lipschitz_bound(c)));
  EXPECT_EQ(c.worst_triangle, 1);
  EXPECT_EQ(c.limited_by, "written by hand: no bound of the slide");
  EXPECT_EQ(c.basis, "simulated shape, measured scale");
  EXPECT_EQ(c.holes, 1);
  EXPECT_EQ(c.interpolated, 1);
  ASSERT_EQ(c.triangles.size(), 3u);
  EXPECT_EQ(c.triangles[0].stick, 240);
  EXPECT_EQ(c.triangles[0].slip, 300);
  EXPECT_EQ(c.triangles[0].cos_theta, 1);
  EXPECT_TRUE(c.triangles[0].sliding_passive);
  EXPECT_TRUE(std::isinf(c.triangles[1].slip));
  EXPECT_EQ(c.triangles[1].kappa, 25);
  EXPECT_EQ(c.triangles[1].cos_theta, 0.8);
  EXPECT_FALSE(c.triangles[1].sliding_passive);
  ASSERT_EQ(c.devices.size(), 2u);
  EXPECT_EQ(c.devices[0].device, "known");
  EXPECT_EQ(c.devices[0].damping, 0.1);
  EXPECT_EQ(c.devices[0].lowest_rate, 6000);
  EXPECT_EQ(c.devices[1].device, "unbekanntes Gerät");
  EXPECT_TRUE(std::isnan(c.devices[1].lowest_rate));
  ASSERT_EQ(library.provenance.steps.size(), 2u);
  EXPECT_EQ(library.provenance.steps[0].stage, "fit");
  EXPECT_EQ(library.provenance.steps[0].version, "0.1.0");
  EXPECT_EQ(library.provenance.steps[1].stage, "certify");
  EXPECT_EQ(library.provenance.steps[1].inputs.front().name, "known.toml");
}

/// Force on the tool with the tip pressed to x from above (0.004, 0.004) and moved there.
std::array<double, 3> rendered(const Vec3& x) {
  palpate_library* library = nullptr;
  EXPECT_EQ(palpate_library_load(kGolden.c_str(), &library), PALPATE_OK) << palpate_last_error();
  palpate_settings settings;
  palpate_settings_default(&settings);
  settings.friction = 10;
  palpate_state* state = nullptr;
  EXPECT_EQ(palpate_state_create(library, &settings, &state), PALPATE_OK);
  std::array<double, 3> force{};
  const double still[3] = {0, 0, 0};
  for (const Vec3& at :
       {Vec3{0.005, 0.005, 1e-6}, Vec3{0.005, 0.005, 0}, Vec3{0.005, 0.005, -1e-12}, x})
    palpate_step(state, at.data(), still, 1e-3, force.data());
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return force;
}

TEST(GoldenLibrary, FeelsAsItWasMeant) {
  // At natural coordinates 1/2, 1/4, 1/4 of a flat triangle. By hand: with slopes 0, 100, 120 at 0,
  // 2, 6 mm the force at 4 mm is 0.1 + 0.002 (100 + 110)/2 = 0.31 N; the second vertex has the
  // same, the third twice as much.
  const auto pressed = rendered({0.005, 0.005, -0.004});
  EXPECT_NEAR(pressed[0], 0, 1e-9);
  EXPECT_NEAR(pressed[1], 0, 1e-9);
  EXPECT_NEAR(pressed[2], 1.25 * 0.31, 1e-7);
  // Beside it 1.5 mm along x: 80 x - (20/3e-3) x^2/2 of all three.
  const auto dragged = rendered({0.0065, 0.005, -0.004});
  EXPECT_NEAR(dragged[0], -(80 * 0.0015 - 20 / 0.003 * 0.0015 * 0.0015 / 2), 1e-7);
  EXPECT_NEAR(dragged[2], 1.25 * 0.31, 1e-7);
}

}  // namespace
}  // namespace palpate
