// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/site_fields.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

SiteFields sample_fields() {
  SiteFields fields;
  fields.vertex = 7;
  fields.curves = std::string(64, 'a');
  fields.normal = {{0.001, {1e-3F, 0, 0, 2e-3F, 0, 0}}, {0.002, {3e-3F, 0, 1, 4e-3F, 5, 6}}};
  fields.lateral = {{0.002, {0, 1, 0}, 0.003, {0, 7e-4F, 0, 0, 0, 8e-4F}}};
  return fields;
}

TEST(SiteFields, AreTheSameWhenReadAgain) {
  const samples::TemporaryFolder folder;
  const auto file = fields_file(folder.path(), 7);
  EXPECT_EQ(file.filename(), "site-7.fields");
  const SiteFields written = sample_fields();
  write_site_fields(file, written);
  const SiteFields read = read_site_fields(file);
  EXPECT_EQ(read.vertex, 7);
  EXPECT_EQ(read.curves, written.curves);
  ASSERT_EQ(read.normal.size(), 2U);
  ASSERT_EQ(read.lateral.size(), 1U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.normal[i].depth, written.normal[i].depth);
    EXPECT_EQ(read.normal[i].skin, written.normal[i].skin);
  }
  EXPECT_EQ(read.lateral[0].depth, 0.002);
  EXPECT_EQ(read.lateral[0].direction, (Vec3{0, 1, 0}));
  EXPECT_EQ(read.lateral[0].travel, 0.003);
  EXPECT_EQ(read.lateral[0].skin, written.lateral[0].skin);
}

TEST(SiteFields, OfASiteThatFailedAreEmpty) {
  const samples::TemporaryFolder folder;
  write_site_fields(folder / "none.fields", {3, "b", {}, {}});
  const SiteFields read = read_site_fields(folder / "none.fields");
  EXPECT_TRUE(read.normal.empty());
  EXPECT_TRUE(read.lateral.empty());
}

TEST(SiteFields, ThatAreNotFiniteOrDamagedAreRefused) {
  const samples::TemporaryFolder folder;
  SiteFields fields = sample_fields();
  fields.normal[0].skin[1] = std::numeric_limits<float>::infinity();
  write_site_fields(folder / "bad.fields", fields);
  EXPECT_THROW(read_site_fields(folder / "bad.fields"), Error);
  EXPECT_THROW(read_site_fields(folder / "absent.fields"), Error);
  write_site_fields(folder / "cut.fields", sample_fields());
  std::filesystem::resize_file(folder / "cut.fields", 300);
  EXPECT_THROW(read_site_fields(folder / "cut.fields"), Error);
}

}  // namespace
}  // namespace palpate
