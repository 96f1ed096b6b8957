// SPDX-License-Identifier: AGPL-3.0-or-later
// Nothing half-written, and nothing invalid, ever bears the final name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include "format/crash_safe_file.hpp"
#include "format/hdf5_file.hpp"
#include "format/sha256.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;
using samples::SmallDisk;
using samples::TemporaryFolder;
using samples::text_of;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Path = std::filesystem::path;

struct Artifact {
  std::string name;
  std::function<void(const Path&)> write;
};

class FullDisk : public testing::TestWithParam<Artifact> {};

TEST_P(FullDisk, LeavesNothing) {
  const TemporaryFolder folder;
  const SmallDisk disk(4000);
  expect_refusal([&] { GetParam().write(folder / "new.h5"); }, ErrorKind::Internal, "new.h5",
                 "File too large");
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST_P(FullDisk, KeepsThePreviousFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "old.h5") << "previous content";
  const SmallDisk disk(4000);
  expect_refusal([&] { GetParam().write(folder / "old.h5"); }, ErrorKind::Internal, "old.h5",
                 "File too large");
  EXPECT_EQ(text_of(folder / "old.h5"), "previous content");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("old.h5"));
}

INSTANTIATE_TEST_SUITE_P(
    Writers, FullDisk,
    testing::Values(
        Artifact{"Body", [](const Path& p) { write_body(p, samples::body(1)); }},
        Artifact{"Curves", [](const Path& p) { write_curves(p, samples::curves(1)); }},
        Artifact{"Library", [](const Path& p) { write_library(p, samples::library(1)); }},
        Artifact{"Recording", [](const Path& p) { write_recording(p, samples::recording(1)); }},
        Artifact{"Text",
                 [](const Path& p) { write_file_crash_safely(p, std::string(5000, 'x')); }}),
    [](const auto& param) { return param.param.name; });

TEST(Writer, RefusesInvalidContentBeforeTouchingTheDisk) {
  const TemporaryFolder folder;
  Library library = samples::library(1);
  library.responses[4].normal.slope[1] = -1;
  expect_refusal([&] { write_library(folder / "library.h5", library); }, ErrorKind::Internal,
                 "/response/normal_slope[", "is not finite and not negative");
  Curves curves = samples::curves(1);
  curves.sites[2].paths[0].samples[0].force[1] = std::numeric_limits<double>::quiet_NaN();
  expect_refusal([&] { write_curves(folder / "curves.h5", curves); }, ErrorKind::Internal,
                 "/sample/force[", "nan is not finite");
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Writer, RefusesTextsThatWouldBeCut) {
  const TemporaryFolder folder;
  Body body = samples::body(1);
  body.name = std::string("cut\0here", 8);
  expect_refusal([&] { write_body(folder / "body.h5", body); }, ErrorKind::Internal, "@name",
                 "zero byte");
  EXPECT_THAT(folder.names(), IsEmpty());
}

// Sites finish on several threads; files may be read and written meanwhile.
TEST(Writer, ThreadsMayReadAndWriteDifferentFiles) {
  const TemporaryFolder folder;
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&folder, t] {
      const Path path = folder / ("library" + std::to_string(t) + ".h5");
      for (int i = 0; i < 5; ++i) {
        write_library(path, samples::library(t));
        EXPECT_EQ(samples::dump(read_library(path)), samples::dump(samples::library(t)));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace palpate
