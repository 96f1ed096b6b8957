// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/provenance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include "format/artifact.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;

class ProvenanceOfAFile : public testing::Test {
 protected:
  Provenance written_and_read(const Provenance& provenance) const {
    hdf5::Writer writer(file_);
    write_provenance(writer, provenance);
    writer.commit();
    return read_provenance(hdf5::Reader(file_, "make it again"));
  }
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.h5";
};

TEST_F(ProvenanceOfAFile, NamesInputsByTheirBytesAndNotTheirFolder) {
  std::ofstream(folder_ / "input.txt", std::ios::binary) << "abc";
  const ProvenanceStep step = make_provenance_step("fit", "[fit]\n", {folder_ / "input.txt"});
  ASSERT_EQ(step.inputs.size(), 1u);
  EXPECT_EQ(step.inputs[0].name, "input.txt");
  // FIPS 180-4, the example of "abc".
  EXPECT_EQ(step.inputs[0].sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_THROW(make_provenance_step("fit", "", {folder_ / "none.txt"}), Error);
}

TEST_F(ProvenanceOfAFile, IsStampedInUtc) {
  std::tm stamp{};
  const std::time_t before = std::time(nullptr);
  const ProvenanceStep step = make_provenance_step("mesh", "", {});
  const std::time_t after = std::time(nullptr);
  ASSERT_NE(strptime(step.utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &stamp), nullptr) << step.utc;
  EXPECT_GE(timegm(&stamp), before);
  EXPECT_LE(timegm(&stamp), after);
  EXPECT_EQ(creator_text(), "palpate " + step.version + " (" + step.git_revision + ")");
}

/// More than ten steps: their groups are still in order.
TEST_F(ProvenanceOfAFile, ComesBackStepByStepInOrder) {
  Provenance provenance;
  for (int i = 0; i < 12; ++i)
    provenance.steps.push_back(make_provenance_step("stage " + std::to_string(i), "a = 1\n", {},
                                                    {{"kernel", "Haswell"}, {"empty", ""}}));
  const Provenance found = written_and_read(provenance);
  ASSERT_EQ(found.steps.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(found.steps[i].stage, provenance.steps[i].stage);
    EXPECT_EQ(found.steps[i].resolved_case, "a = 1\n");
    EXPECT_EQ(found.steps[i].facts, provenance.steps[i].facts);
  }
}

TEST_F(ProvenanceOfAFile, RefusesAStepWithoutStageOrWithABrokenDigest) {
  Provenance provenance{{make_provenance_step("", "", {})}};
  const Checks checks(file_);
  expect_refusal([&] { check_provenance(checks, provenance); }, ErrorKind::Internal, "@stage",
                 "is empty");
  provenance.steps[0].stage = "mesh";
  provenance.steps[0].inputs = {{"a.obj", "123"}};
  expect_refusal([&] { check_provenance(checks, provenance); }, ErrorKind::Internal,
                 "@input_sha256", "is not a SHA-256");
  provenance.steps.assign(101, make_provenance_step("mesh", "", {}));
  expect_refusal([&] { check_provenance(checks, provenance); }, ErrorKind::Internal, "/provenance",
                 "over 100 steps");
}

}  // namespace
}  // namespace palpate
