// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/flat_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "format/error.hpp"
#include "format/flat_file.hpp"
#include "format/seal.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

using samples::dump;
using samples::TemporaryFolder;

/// dump() prints every field of a library, numbers to the last bit.
TEST(FlatLibrary, IsTheSameLibraryAsTheHdf5File) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 5; ++seed) {
    for (const Library& library :
         {samples::library(seed), samples::coupled_library(seed), samples::relaxing_library(seed),
          samples::leaning_library(seed), samples::soft_library(seed)}) {
      write_library(folder / "library.h5", library);
      write_flat_library(folder / "library.plib", library);
      EXPECT_EQ(dump(read_library(folder / "library.plib")), dump(library));
      EXPECT_EQ(dump(read_library(folder / "library.plib")),
                dump(read_library(folder / "library.h5")));
    }
  }
}

TEST(FlatLibrary, IsReadFromMemory) {
  const Library library = samples::coupled_library(3);
  EXPECT_EQ(dump(library_from_bytes(flat_bytes(library, "a.plib"))), dump(library));
}

TEST(FlatLibrary, WithOneWrongByteIsRefused) {
  const std::string bytes = flat_bytes(samples::library(1), "a.plib");
  for (std::size_t at = 0; at < bytes.size(); at += at < 4096 ? 1 : 97) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    EXPECT_THROW(read_flat_library(damaged, "a.plib"), Error) << "byte " << at;
  }
}

TEST(FlatLibrary, CutAtAnyLengthIsRefused) {
  const std::string bytes = flat_bytes(samples::library(1), "a.plib");
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 300)
    EXPECT_THROW(read_flat_library(bytes.substr(0, size), "a.plib"), Error) << size;
}

/// Content that no writer of ours makes, with a seal that is right. `where`: what the error names.
void expect_refused(const Library& good, const std::string& name, std::size_t byte,
                    const void* value, std::size_t size) {
  std::string bytes = flat_bytes(good, "a.plib");
  for (std::size_t entry = 0;; ++entry) {
    const char* at = bytes.data() + 64 + 128 * entry;
    if (name != at) continue;
    std::uint64_t offset = 0;
    std::memcpy(&offset, at + 64, sizeof offset);
    std::memcpy(bytes.data() + offset + byte, value, size);
    break;
  }
  bytes.resize(bytes.size() - seal_of("").size());
  bytes += seal_of(bytes);
  try {
    read_flat_library(bytes, "a.plib");
    ADD_FAILURE() << name << " was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.where(), testing::StartsWith("a.plib:" + name));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("export runtime"));
  }
}

TEST(FlatLibrary, IsCheckedAsTheHdf5FileIs) {
  const Library good = samples::coupled_library(2);
  const float negative = -1, not_a_number = std::nanf("");
  const double far = 1e300, infinite = std::numeric_limits<double>::infinity();
  const std::int32_t corner = 1 << 20;
  const std::int64_t row = 1 << 20;
  const std::uint8_t status = 7;
  expect_refused(good, "/response/normal_slope", 4, &negative, 4);
  expect_refused(good, "/response/lateral_knot", 4, &not_a_number, 4);
  expect_refused(good, "/response/normal_offset", 8, &row, 8);
  expect_refused(good, "/response/coupling_base", 0, &negative, 4);
  expect_refused(good, "/response/status", 0, &status, 1);
  expect_refused(good, "/surface/position", 0, &infinite, 8);
  expect_refused(good, "/surface/inward", 0, &far, 8);
  expect_refused(good, "/surface/triangles", 0, &corner, 4);
  expect_refused(good, "/coupled", 0, &status, 1);
  const Library relaxing = samples::relaxing_library(2);
  const double early = 1e-9;
  expect_refused(relaxing, "/relaxation/time", 8, &early, 8);  // not above the one before
  expect_refused(relaxing, "/response/relaxation_fraction", 4, &negative, 4);
  expect_refused(samples::leaning_library(1), "/response/lean", 4, &not_a_number, 4);
  expect_refused(samples::leaning_library(1), "/response/lean", 8, &negative, 4);  // too long
  expect_refused(samples::soft_library(1), "/response/soft_axis", 4, &not_a_number, 4);
  expect_refused(samples::soft_library(1), "/response/soft_axis", 8, &negative, 4);  // too long
  Library decoupled = samples::soft_library(1);
  decoupled.kind = ResponseKind::Decoupled;
  EXPECT_THROW(flat_bytes(decoupled, "a.plib"), Error);
}

/// A reader must not take the curves without what it does not know of them.
TEST(FlatLibrary, OfTissueThatRelaxesOrLeansOrIsCoupledIsOfALaterVersion) {
  const auto version = [](const Library& library) {
    return static_cast<int>(flat_bytes(library, "a.plib")[8]);
  };
  EXPECT_EQ(version(samples::library(1)), 1);
  EXPECT_EQ(version(samples::relaxing_library(2)), 2);
  EXPECT_EQ(version(samples::relaxing_library(1)), 3);  // coupled
  EXPECT_EQ(version(samples::coupled_library(1)), 3);
  for (const unsigned seed : {0U, 1U, 2U}) {
    const Library leaning = samples::leaning_library(seed);
    EXPECT_EQ(version(leaning), leaning.kind == ResponseKind::Coupled ? 4 : 3);
    EXPECT_EQ(version(samples::soft_library(seed)), 5);
  }
}

}  // namespace
}  // namespace palpate
