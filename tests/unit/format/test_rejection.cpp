// SPDX-License-Identifier: AGPL-3.0-or-later
// A good file with one thing broken must be refused, with a line that names file, object and
// remedy: the check itself, and what every reader must refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

std::vector<Case> common_cases() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, Kind kind, const Break& damage,
                       const std::string& object, const std::string& problem) {
    const std::string remedy =
        kind == Kind::Recording ? "record it again with" : "make it again with";
    cases.push_back({name, kind, damage, object, problem, remedy});
  };
  const std::vector<std::pair<std::string, Kind>> kinds{{"Body", Kind::Body},
                                                        {"Curves", Kind::Curves},
                                                        {"Library", Kind::Library},
                                                        {"Recording", Kind::Recording}};
  for (const auto& [name, kind] : kinds) {
    add(name + "OfLaterSchema", kind,
        edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 99, H5T_NATIVE_INT); }), ":/",
        kind == Kind::Body ? "has schema 99, this palpate reads 1, 2, 3 and 4; update palpate"
        : kind == Kind::Library
            ? "has schema 99, this palpate reads 1, 3, 4, 5, 6, 7 and 8; update palpate"
            : "has schema 99, this palpate reads 2; update palpate");
    add(name + "OfEarlierSchema", kind,
        edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 0, H5T_NATIVE_INT); }), ":/",
        "has schema 0, this palpate reads ");
    add(name + "OfOtherKind", kind,
        edit([](Hdf5Editor& e) { e.set_text("/", "artifact", "palpate.other"); }), ":/",
        "holds 'palpate.other', palpate.");
    add(name + "WithoutArtifact", kind,
        edit([](Hdf5Editor& e) { H5Adelete(e.file(), "artifact"); }), ":/",
        "is not a palpate artifact");
    add(name + "SchemaAsText", kind, edit([](Hdf5Editor& e) { e.set_text("/", "schema", "1"); }),
        ":/", "attribute 'schema' is not a single number");
    add(name + "WithoutProvenance", kind, remove("/provenance"), "/provenance", "is missing");
    add(name + "Truncated", kind, truncate_half, ".h5", "truncated file");
    add(name + "Empty", kind, content(""), ".h5", "is empty (0 bytes)");
    add(name + "IsText", kind, content("v 0 0 0\nv 1 0 0\n"), ".h5", "is not an HDF5 file");
    add(name + "HeaderOnly", kind, content("\x89HDF\r\n\x1a\n"), ".h5", "cannot be opened");
    add(
        name + "Absent", kind, [](const Path& path) { std::filesystem::remove(path); }, ".h5",
        "does not exist; check the path");
    add(
        name + "IsAFolder", kind,
        [](const Path& path) {
          std::filesystem::remove(path);
          std::filesystem::create_directory(path);
        },
        ".h5", "is not a regular file but a folder");
    add(
        name + "IsAFifo", kind,
        [](const Path& path) {
          std::filesystem::remove(path);
          ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        },
        ".h5", "is not a regular file but a FIFO");
  }
  return cases;
}

}  // namespace

TEST_P(Rejection, NamesFileObjectAndRemedy) {
  const Case& broken = GetParam();
  const TemporaryFolder folder;
  const Path path = folder / "artifact.h5";
  copy_sample(broken.kind, path);
  ASSERT_NO_THROW(read_sample(broken.kind, path));
  broken.damage(path);
  try {
    read_sample(broken.kind, path);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_THAT(error.where(), testing::HasSubstr(path.string()));
    EXPECT_THAT(error.where(), testing::HasSubstr(broken.object));
    EXPECT_THAT(message, testing::HasSubstr(broken.problem));
    EXPECT_THAT(error.remedy(), testing::HasSubstr(broken.remedy));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line";
    EXPECT_NE(error.kind(), ErrorKind::Internal);
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, Rejection, testing::ValuesIn(common_cases()), name_of);

}  // namespace palpate::samples
