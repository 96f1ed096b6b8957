// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/flat_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "format/error.hpp"
#include "format/seal.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

const std::vector<Vec3> kPoints{{1, 2, 3}, {-4, 5e-300, 6}};

std::string sample_file() {
  FlatWriter writer;
  writer.array("/points", kPoints);
  writer.array("/flags", std::vector<std::uint8_t>{1, 0, 1});
  writer.texts("/names", {"liver", "", "Größe"});
  writer.number("/radius", 0.005);
  writer.array("/none", std::vector<float>{});
  return writer.file();
}

std::string problem_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.remedy(), "make it again");
    return error.what();
  }
  return "accepted";
}

FlatReader reader_of(const std::string& bytes) {
  return {bytes, "a.plib", "make it again"};
}

/// A file whose content has been changed and sealed again.
std::string resealed(std::string bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  std::memcpy(bytes.data() + at, &value, size);
  bytes.resize(bytes.size() - seal_of("").size());
  return bytes + seal_of(bytes);
}

constexpr std::size_t kHead = 64, kEntry = 128;  // bytes
constexpr std::size_t kTypeAt = 56, kOffsetAt = 64, kRowsAt = 72;

TEST(FlatFile, GivesBackWhatWasPutIn) {
  const std::string bytes = sample_file();
  const FlatReader reader = reader_of(bytes);
  EXPECT_EQ(reader.array<Vec3>("/points", 2), kPoints);
  EXPECT_EQ(reader.array<std::uint8_t>("/flags"), (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_EQ(reader.texts("/names"), (std::vector<std::string>{"liver", "", "Größe"}));
  EXPECT_EQ(reader.number("/radius"), 0.005);
  EXPECT_TRUE(reader.array<float>("/none").empty());
  EXPECT_TRUE(reader.has("/radius"));
  EXPECT_FALSE(reader.has("/radiu"));
}

/// A program that maps the file can use the numbers where they lie.
TEST(FlatFile, HasItsNumbersAtMultiplesOf64Bytes) {
  const std::string bytes = sample_file();
  for (std::size_t entry = 0; entry < 5; ++entry) {
    std::uint64_t offset = 0;
    std::memcpy(&offset, bytes.data() + kHead + kEntry * entry + kOffsetAt, sizeof offset);
    EXPECT_EQ(offset % 64, 0U);
  }
  std::uint64_t points = 0;
  std::memcpy(&points, bytes.data() + kHead + kOffsetAt, sizeof points);
  EXPECT_EQ(std::memcmp(bytes.data() + points, kPoints.data(), 48), 0);
}

TEST(FlatFile, RefusesAnEntryThatIsMissingOrOfAnotherShape) {
  const std::string bytes = sample_file();
  const FlatReader reader = reader_of(bytes);
  EXPECT_EQ(problem_of([&] { reader.number("/depth"); }),
            "a.plib:/depth: is missing; make it again");
  EXPECT_THAT(problem_of([&] { reader.array<float>("/radius"); }), HasSubstr("of another type"));
  EXPECT_THAT(problem_of([&] { reader.array<Vec3>("/points", 3); }), HasSubstr("has 2 rows, 3"));
  EXPECT_THAT(problem_of([&] { reader.array<double>("/points"); }), HasSubstr("has 3 columns, 1"));
}

TEST(FlatFile, RefusesWhatIsNotOneOrOfALaterVersion) {
  EXPECT_THAT(problem_of([] { reader_of("solid stl"); }), HasSubstr("is not a flat library"));
  EXPECT_THAT(problem_of([] { reader_of(""); }), HasSubstr("is not a flat library"));
  EXPECT_THAT(problem_of([] { reader_of(sample_file().substr(0, 20)); }),
              HasSubstr("is not a flat library"));
  try {
    reader_of(resealed(sample_file(), 8, 6, 4));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), HasSubstr("version 6"));
    EXPECT_THAT(error.remedy(), HasSubstr("update palpate"));
  }
}

/// Sealed by somebody who meant it: no entry may lead outside of the file.
TEST(FlatFile, RefusesEntriesThatLieOutside) {
  const auto refused = [](std::size_t at, std::uint64_t value, std::size_t size) {
    return problem_of([&] { reader_of(resealed(sample_file(), at, value, size)); });
  };
  constexpr std::uint64_t kHuge = ~std::uint64_t{0};
  EXPECT_THAT(refused(12, 1U << 30, 4), HasSubstr("more entries than bytes"));
  EXPECT_THAT(refused(kHead + kOffsetAt, 1 << 20, 8), HasSubstr("lies outside"));
  EXPECT_THAT(refused(kHead + kOffsetAt, kHuge - 63, 8), HasSubstr("lies outside"));
  EXPECT_THAT(refused(kHead + kOffsetAt, 8, 8), HasSubstr("lies outside"));
  EXPECT_THAT(refused(kHead + kRowsAt, kHuge / 24 + 1, 8), HasSubstr("lies outside"));
  EXPECT_THAT(refused(kHead + kTypeAt, 77, 4), HasSubstr("of unknown type"));
  // The second text would end beyond the file.
  const std::string bytes = sample_file();
  std::uint64_t names = 0;
  std::memcpy(&names, bytes.data() + kHead + 2 * kEntry + kOffsetAt, sizeof names);
  const std::string longer = resealed(bytes, names + 8, kHuge, 8);
  EXPECT_THAT(problem_of([&] { reader_of(longer).texts("/names"); }), HasSubstr("beyond the end"));
}

}  // namespace
}  // namespace palpate
