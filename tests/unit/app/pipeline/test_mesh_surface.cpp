// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/mesh_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "format/error.hpp"
#include "format/sha256.hpp"
#include "mesher/geometry/soup.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/vtk/read_vtk_xml.hpp"
#include "mesher/read/vtk/vtk_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

/// A tetrahedron in millimetres, with or without its face x + y + z = 50.
std::string off_text(bool closed) {
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  return "OFF\n4 " + std::string(closed ? "4" : "3") + " 0\n0 0 0\n50 0 0\n0 50 0\n0 0 50\n" +
         faces + (closed ? "3 1 2 3\n" : "");
}

mesher::Settings settings_for(const std::filesystem::path& file) {
  mesher::Settings s;
  s.surface = {file, 1e-3, "matrix", {mesher::RepairMode::None}};
  s.supports = {mesher::PlaneSupport{{0, 0, 0.001}, {0, 0, -1}}};
  s.patch_spacing = s.element_size = 0.01;
  return s;
}

TEST(MeshSurface, WritesTheFaultyFacesInTheUnitOfTheFileAndNamesIt) {
  const samples::TemporaryFolder folder;
  const auto file = folder.path() / "open.off";
  std::ofstream(file) << off_text(false);
  const auto faulty = folder.path() / "faulty-faces.vtp";
  try {
    mesh_surface(settings_for(file), folder.path());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), testing::HasSubstr("3 border edges"));
    EXPECT_THAT(error.problem(), testing::HasSubstr(faulty.string()));
  }
  const mesher::Soup soup = mesher::surface_of(
      mesher::read_vtk_xml(mesher::read_bytes(faulty), faulty.string()), faulty.string());
  EXPECT_EQ(soup.polygons.size(), 3U);  // each face has one of the border edges
  EXPECT_NEAR(mesher::largest_dimension(soup.points), 50, 1e-9);
}

TEST(MeshSurface, ShowsWhatARepairMoved) {
  const samples::TemporaryFolder folder;
  const auto file = folder.path() / "open.off", picture = folder.path() / "repair.json";
  std::ofstream(file) << off_text(false);
  mesher::Settings settings = settings_for(file);
  settings.surface.repair.mode = mesher::RepairMode::Auto;
  mesh_surface(settings, folder.path());
  const auto json = nlohmann::json::parse(mesher::read_bytes(picture));
  EXPECT_EQ(json.at("surface_sha256"), sha256_of_file(file));
  EXPECT_TRUE(json.at("repaired").contains("distance"));

  std::ofstream(file) << off_text(true);
  mesh_surface(settings, folder.path());
  EXPECT_FALSE(std::filesystem::exists(picture));  // a sound surface is not repaired
}

TEST(MeshSurface, RemovesTheFileOfAnEarlierRefusal) {
  const samples::TemporaryFolder folder;
  const auto file = folder.path() / "closed.off";
  std::ofstream(file) << off_text(true);
  std::ofstream(folder.path() / "faulty-faces.vtp") << "of an earlier run";
  const Body body = mesh_surface(settings_for(file), folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "faulty-faces.vtp"));
  EXPECT_FALSE(body.tetrahedra.empty());
}

}  // namespace
}  // namespace palpate::app
