// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/artifact.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

/// A file says by itself what it is, which layout it has, and what made it.
TEST(ArtifactRoot, TellsKindSchemaPurposeAndCreator) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "a.h5";
  hdf5::Writer writer(file);
  write_root(writer, "palpate.sample", 4, "A sample.");
  writer.commit();
  hdf5::Reader reader(file, "make it again");
  EXPECT_EQ(reader.require_artifact("palpate.sample", {3, 4}), 4);
  EXPECT_EQ(reader.text("/", "description"), "A sample.");
  EXPECT_EQ(reader.text("/", "creator"), creator_text());
}

}  // namespace
}  // namespace palpate
