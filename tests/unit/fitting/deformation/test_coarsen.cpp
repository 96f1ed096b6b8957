// SPDX-License-Identifier: AGPL-3.0-or-later
// The skin of the response surface alone, against the fine one that it comes from.
#include "fitting/deformation/coarsen.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "format/to_index.hpp"
#include "runtime/skin_deformation.hpp"
#include "tests/unit/fitting/deformation/pressed_plate.hpp"

namespace palpate::fitting {
namespace {

/// A dimple on waves that grow across the plate: many modes.
Vec3 wavy(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const double wave = 0.2 * z * std::cos(40 * x[0] * (1 + 5 * c[1])) * std::sin(30 * x[1] + c[0]);
  return dimple(x, c, z, q) + wave * kDown;
}

runtime::Touch touch_on(const PressedPlate& plate) {
  const std::int32_t element = 70;
  runtime::Touch touch;
  touch.point = {element, {0.3, 0.3, 0.4}};
  const Triangle& corners = plate.library.triangles[to_index(element)];
  for (std::size_t l = 0; l < 3; ++l)
    touch.contact_point = touch.contact_point +
                          touch.point.natural[l] * plate.library.positions[to_index(corners[l])];
  touch.normal = kDown;
  touch.depth = 0.004;
  touch.lateral = {0.001, -0.0005, 0};
  touch.tip = touch.contact_point + touch.depth * kDown + touch.lateral;
  return touch;
}

std::vector<Vec3> shown(const PressedPlate& plate, const Deformation& d) {
  const runtime::SkinDeformation skin(d, plate.library.triangles);
  std::vector<Vec3> x(skin.positions().size());
  skin.displace(touch_on(plate), x.front().data());
  return x;
}

/// Root mean square of the distances at the response vertices.
double distance(const std::vector<Vec3>& coarse, const std::vector<Vec3>& fine,
                const std::vector<std::int32_t>& vertex_of) {
  double squares = 0;
  for (std::size_t v = 0; v < coarse.size(); ++v) {
    const Vec3 off = coarse[v] - fine[to_index(vertex_of[v])];
    squares += dot(off, off);
  }
  return std::sqrt(squares / static_cast<double>(coarse.size()));
}

TEST(Coarsened, MovesTheResponseVerticesAsTheFineSkinDoes) {
  const PressedPlate plate;
  const Deformation fine = compressed(plate, wavy);
  const Deformation coarse = coarsened(fine, plate.library.triangles, 512);
  EXPECT_EQ(coarse.positions, plate.library.positions);
  EXPECT_EQ(coarse.triangles, plate.library.triangles);
  EXPECT_EQ(coarse.mode_count(), fine.mode_count());
  EXPECT_LT(distance(shown(plate, coarse), shown(plate, fine), fine.vertex_of), 1e-12);
}

TEST(Coarsened, KeepsTheLeadingModesAndSaysWhatItLeavesOut) {
  const PressedPlate plate;
  const Deformation fine = compressed(plate, wavy);
  ASSERT_GT(fine.mode_count(), 12U);
  double last = 1;
  for (const std::size_t modes : {2U, 6U, 12U}) {
    const Deformation coarse = coarsened(fine, plate.library.triangles, modes);
    EXPECT_EQ(coarse.mode_count(), modes);
    EXPECT_EQ(coarse.press_modes.size(), modes * fine.sites.size() * fine.depths.size());
    EXPECT_LT(coarse.rms_left_out, last);
    EXPECT_GT(coarse.rms_left_out, fine.rms_left_out);
    // As if as many modes had been asked for to begin with.
    CompressSettings settings;
    settings.modes = static_cast<int>(modes);
    const Deformation asked = compress(
        plate.body, plate.library, {"sphere", kRadius, "frictionless"}, plate.all_vertices(),
        [&](std::int32_t vertex) { return fields_at(plate, vertex, wavy); }, settings);
    EXPECT_NEAR(coarse.rms_left_out / asked.rms_left_out, 1, 0.02);
    last = coarse.rms_left_out;
  }
}

/// The same fields at a second, lesser depth, times a factor.
Deformation with_a_lesser_depth(const Deformation& one, float factor) {
  Deformation two = one;
  two.lateral_depths = {0.5 * one.lateral_depths.front(), one.lateral_depths.front()};
  const auto doubled = [&](const auto& all, auto& out, auto times) {
    const std::size_t row = all.size() / one.sites.size();
    out.clear();
    for (std::size_t site = 0; site < one.sites.size(); ++site)
      for (const bool lesser : {true, false})
        for (std::size_t i = site * row; i < (site + 1) * row; ++i)
          out.push_back(lesser ? times(all[i]) : all[i]);
  };
  const auto scaled = [&](float value) { return factor * value; };
  doubled(one.lateral_local, two.lateral_local, scaled);
  doubled(one.lateral_modes, two.lateral_modes, scaled);
  doubled(one.anisotropic_scale, two.anisotropic_scale, scaled);
  doubled(one.anisotropic, two.anisotropic, [](std::int16_t value) { return value; });
  return two;
}

TEST(Coarsened, KeepsTheDeeperOfTwoLateralDepths) {
  const PressedPlate plate;
  const Deformation one = compressed(plate, wavy);
  ASSERT_EQ(one.lateral_depths.size(), 1U);
  const Deformation two = with_a_lesser_depth(one, 0.3F);
  const auto kept = coarsened(two, plate.library.triangles, 512);
  EXPECT_EQ(kept.lateral_depths, one.lateral_depths);
  EXPECT_LT(distance(shown(plate, kept), shown(plate, one), one.vertex_of), 1e-12);
}

}  // namespace
}  // namespace palpate::fitting
