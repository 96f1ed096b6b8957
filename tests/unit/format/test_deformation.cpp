// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/deformation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "format/error.hpp"
#include "format/flat_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

/// Three vertices, two sites, one depth, one lateral depth, two knots, one mode.
Deformation sample_deformation() {
  Deformation d;
  d.surface = std::string(64, 'c');
  d.tool_shape = "disc";
  d.tool_radius = 0.005;
  d.tool_edge_radius = 0.001;
  d.reach = 0.02;
  d.rms_left_out = 1e-5;
  d.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  d.triangles = {{0, 1, 2}};
  d.vertex_of = {0, 1, 2};
  d.depths = {0.006};
  d.lateral_depths = {0.003};
  d.knots = {0, 0.02};
  d.sites = {{{0, 0, 0}, {0, 0, -1}, {1, 0, 0}}, {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
  d.donor_offset = {0, 1, 2, 4};
  d.donor = {0, 1, 0, 1};
  d.donor_weight = {1, 1, 0.25F, 0.75F};
  d.press_slips = true;
  d.press_local = {6e-3F, 0, 1e-3F, 0, 6e-3F, 0, 2e-3F, 0};
  d.lateral_local.assign(12, 0.5F);
  for (std::int16_t i = 0; i < 104; ++i) d.anisotropic.push_back(static_cast<std::int16_t>(-i * i));
  d.anisotropic_scale = {1e-6F, 2e-6F};
  d.press_modes = {0.1F, 0.2F};
  d.lateral_modes = {1, 2, 3, 4};
  d.mode_scale = {1e-4F};
  d.modes = {1, -2, 3, -32767, 32767, 0, 7, 8, 9};
  return d;
}

TEST(DeformationFile, IsTheSameWhenReadAgain) {
  const samples::TemporaryFolder folder;
  const Deformation written = sample_deformation();
  write_deformation(folder / "deformation.pdef", written);
  const Deformation read = read_deformation(folder / "deformation.pdef");
  EXPECT_EQ(read.surface, written.surface);
  EXPECT_EQ(read.tool_shape, "disc");
  EXPECT_EQ(read.tool_radius, 0.005);
  EXPECT_EQ(read.tool_edge_radius, 0.001);
  EXPECT_EQ(read.reach, 0.02);
  EXPECT_EQ(read.rms_left_out, 1e-5);
  EXPECT_EQ(read.positions, written.positions);
  EXPECT_EQ(read.triangles, written.triangles);
  EXPECT_EQ(read.vertex_of, written.vertex_of);
  EXPECT_EQ(read.depths, written.depths);
  EXPECT_EQ(read.lateral_depths, written.lateral_depths);
  EXPECT_TRUE(read.press_slips);
  EXPECT_EQ(read.knots, written.knots);
  ASSERT_EQ(read.sites.size(), 2U);
  EXPECT_EQ(read.sites[1].tangent, (Vec3{0, 1, 0}));
  EXPECT_EQ(read.donor, written.donor);
  EXPECT_EQ(read.donor_offset, written.donor_offset);
  EXPECT_EQ(read.donor_weight, written.donor_weight);
  EXPECT_EQ(read.press_local, written.press_local);
  EXPECT_EQ(read.lateral_local, written.lateral_local);
  EXPECT_EQ(read.anisotropic, written.anisotropic);
  EXPECT_EQ(read.anisotropic_scale, written.anisotropic_scale);
  EXPECT_EQ(read.press_modes, written.press_modes);
  EXPECT_EQ(read.lateral_modes, written.lateral_modes);
  EXPECT_EQ(read.mode_scale, written.mode_scale);
  EXPECT_EQ(read.modes, written.modes);
}

TEST(DeformationFile, ThatIsNotValidIsRefusedByTheNameOfTheEntry) {
  const std::pair<const char*, std::function<void(Deformation&)>> faults[] = {
      {"/skin/triangles", [](Deformation& d) { d.triangles[0][2] = 3; }},
      {"/skin/vertex_of", [](Deformation& d) { d.vertex_of[0] = -1; }},
      {"/skin/position", [](Deformation& d) { d.positions[0][1] = std::nan(""); }},
      {"/site/inward",
       [](Deformation& d) {
         d.sites[0].inward = {0, 0, -2};
       }},
      {"/donor/site", [](Deformation& d) { d.donor[3] = 2; }},
      {"/donor/weight", [](Deformation& d) { d.donor_weight[3] = 0.5F; }},
      {"/donor/offset",
       [](Deformation& d) {
         d.donor_offset = {0, 2, 1, 4};
       }},
      {"/press/depth", [](Deformation& d) { d.depths = {0}; }},
      {"/press/depth",
       [](Deformation& d) {
         d.depths = {0.002, 0.001};
       }},
      {"/press/local", [](Deformation& d) { d.press_local.pop_back(); }},
      {"/press/modes",
       [](Deformation& d) { d.press_modes[0] = std::numeric_limits<float>::infinity(); }},
      {"/local/knot", [](Deformation& d) { d.knots[1] = 0.01; }},
      {"/lateral/local", [](Deformation& d) { d.lateral_local.push_back(0); }},
      {"/lateral/modes", [](Deformation& d) { d.lateral_modes.pop_back(); }},
      {"/lateral/anisotropic", [](Deformation& d) { d.anisotropic.pop_back(); }},
      {"/lateral/anisotropic_scale", [](Deformation& d) { d.anisotropic_scale.pop_back(); }},
      {"/lateral/anisotropic_scale", [](Deformation& d) { d.anisotropic_scale[1] = NAN; }},
      {"/mode/skin", [](Deformation& d) { d.modes.pop_back(); }}};
  const samples::TemporaryFolder folder;
  for (const auto& [entry, spoil] : faults) {
    Deformation d = sample_deformation();
    spoil(d);
    write_deformation(folder / "bad.pdef", d);
    try {
      read_deformation(folder / "bad.pdef");
      ADD_FAILURE() << entry << " is accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      EXPECT_NE(std::string(error.what()).find(entry), std::string::npos) << error.what();
    }
  }
}

TEST(DeformationFile, MayLackWhatDiffersBetweenDirections) {
  const samples::TemporaryFolder folder;
  Deformation written = sample_deformation();
  written.anisotropic.clear();
  written.anisotropic_scale.clear();
  write_deformation(folder / "symmetric.pdef", written);
  const Deformation read = read_deformation(folder / "symmetric.pdef");
  EXPECT_TRUE(read.anisotropic.empty());
  EXPECT_TRUE(read.anisotropic_scale.empty());
  EXPECT_EQ(read.lateral_local, written.lateral_local);
}

TEST(DeformationFile, DigestsTellSurfacesApart) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::string digest = surface_digest(positions, {{0, 1, 2}});
  EXPECT_EQ(digest.size(), 64U);
  EXPECT_NE(digest, surface_digest(positions, {{0, 2, 1}}));
  EXPECT_NE(digest, surface_digest({{0, 0, 0}, {1, 0, 0}, {0, 1, 1e-15}}, {{0, 1, 2}}));
}

TEST(DeformationFile, NormalsPointIntoTheBody) {
  // The corner of a cube at the origin, which fills x, y, z > 0: outside is below.
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> outward{{0, 2, 1}, {0, 3, 2}, {0, 1, 3}};
  const auto normals = inward_normals(positions, outward);
  for (const double component : normals[0]) EXPECT_NEAR(component, 1 / std::sqrt(3.0), 1e-15);
}

}  // namespace
}  // namespace palpate
