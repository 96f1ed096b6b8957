// SPDX-License-Identifier: AGPL-3.0-or-later
// Damaged files: whatever bytes a reader is given, it makes a mesh or refuses them with a place.
#include <fstream>
#include <random>

#include "mesher/read/file/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

/// A file of each format and encoding.
const std::vector<std::string> kFiles{"gmsh/body_1.msh",
                                      "gmsh/body_22.msh",
                                      "gmsh/body_22_binary.msh",
                                      "gmsh/body_41.msh",
                                      "gmsh/body_41_binary.msh",
                                      "gmsh/ball_22_binary.msh",
                                      "gmsh/ball.inp",
                                      "gmsh/ball.mesh",
                                      "meshio/body.inp",
                                      "meshio/body.vtu",
                                      "vtk/body_ascii.vtu",
                                      "vtk/body_binary.vtu",
                                      "vtk/body_appended_zlib.vtu",
                                      "vtk/body_appended.vtu",
                                      "vtk/body_raw.vtu",
                                      "vtk/body_4.vtk",
                                      "vtk/body_4_binary.vtk",
                                      "vtk/body_5_binary.vtk",
                                      "tetgen/cube.node",
                                      "tetgen/cube.ele"};

class Damage : public testing::TestWithParam<std::string> {
 protected:
  /// @return whether a mesh was made
  bool read(const std::string& bytes) {
    const std::filesystem::path original = test::mesh_file(GetParam());
    const std::filesystem::path path = folder_ / original.filename().string();
    std::ofstream(path, std::ios::binary) << bytes;
    for (const char* sibling : {".node", ".ele", ".face"}) {
      std::filesystem::path from = original, to = path;
      from.replace_extension(sibling);
      to.replace_extension(sibling);
      if (to != path && std::filesystem::exists(from))
        std::filesystem::copy_file(from, to, std::filesystem::copy_options::skip_existing);
    }
    try {
      const VolumeMesh mesh = read_volume_mesh({path, 1e-3, "", {}}, {});
      for (const Tetrahedron& t : mesh.tetrahedra)
        for (const std::int32_t node : t)
          EXPECT_LT(static_cast<std::size_t>(node), mesh.nodes.size());
      return true;
    } catch (const Error& error) {
      EXPECT_NE(error.kind(), ErrorKind::Internal) << error.what();
      EXPECT_THAT(error.where(), testing::HasSubstr(folder_.path().string())) << error.what();
      EXPECT_FALSE(error.remedy().empty());
      return false;
    }
  }

  std::string original() const { return read_bytes(test::mesh_file(GetParam())); }

  samples::TemporaryFolder folder_;
};

TEST_P(Damage, TruncatedFilesAreRefused) {
  const std::string bytes = original();
  ASSERT_TRUE(read(bytes));
  for (std::size_t part = 0; part < 40; ++part) read(bytes.substr(0, bytes.size() * part / 40));
  for (std::size_t size = 1; size < 400; size += 13) read(bytes.substr(0, size));
  EXPECT_FALSE(read(bytes.substr(0, bytes.size() / 2)));
}

TEST_P(Damage, ChangedBytesGiveAMeshOrARefusal) {
  const std::string bytes = original();
  std::mt19937_64 random(1);
  for (int run = 0; run < 150; ++run) {
    std::string damaged = bytes;
    // Half of the changes are in the head, where the counts are.
    for (int change = 0; change <= run % 3; ++change) {
      const std::size_t range =
          random() % 2 == 0 ? std::min<std::size_t>(600, bytes.size()) : bytes.size();
      damaged[random() % range] = static_cast<char>(random());
    }
    read(damaged);
  }
}

TEST_P(Damage, DigitsAndLinesOutOfPlaceGiveAMeshOrARefusal) {
  const std::string bytes = original();
  std::mt19937_64 random(2);
  for (int run = 0; run < 100; ++run) {
    std::string damaged = bytes;
    const std::size_t at = random() % bytes.size();
    const std::size_t digit = bytes.find_first_of("0123456789", at);
    switch (run % 4) {
      case 0:
        if (digit != std::string::npos) damaged.insert(digit, "1000000000000");
        break;
      case 1:
        if (digit != std::string::npos) damaged.replace(digit, 1, "nan");
        break;
      case 2:
        damaged.erase(at, random() % 200);
        break;
      default:
        damaged.insert(at, bytes.substr(random() % bytes.size(), random() % 200));
    }
    read(damaged);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Damage, testing::ValuesIn(kFiles), [](const auto& one) {
  std::string name = one.param;
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  return name;
});

}  // namespace
}  // namespace palpate::mesher
