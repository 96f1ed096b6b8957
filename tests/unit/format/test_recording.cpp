// SPDX-License-Identifier: AGPL-3.0-or-later
// What a reader of recordings must refuse, and what it need not have.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "format/recording.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

/// The first of two chunks is there, the second would read as zeros.
void lose_a_chunk(const Path& path) {
  Hdf5Editor editor(path);
  const hsize_t rows = 5000, chunk = 4000, start = 0;
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &chunk);
  H5Pset_deflate(properties, 1);
  editor.claim("/step/depth", {rows}, H5T_IEEE_F64LE, properties);
  const hid_t dataset = H5Dopen2(editor.file(), "/step/depth", H5P_DEFAULT);
  const hid_t all = H5Dget_space(dataset), half = H5Screate_simple(1, &chunk, nullptr);
  H5Sselect_hyperslab(all, H5S_SELECT_SET, &start, nullptr, &chunk, nullptr);
  std::mt19937_64 noise(1);  // incompressible, so that the size alone looks plausible
  std::vector<double> data(chunk);
  for (double& value : data) value = static_cast<double>(noise() >> 12) * 0x1p-52;
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, half, all, H5P_DEFAULT, data.data());
  H5Sclose(half), H5Sclose(all), H5Dclose(dataset), H5Pclose(properties);
}

std::vector<Case> recording_cases() {
  const auto kind = Kind::Recording;
  const std::string remedy = "record it again with";
  return {
      {"RecordingForceNaN", kind, poke("/step/force", 30, kNaN), "/step/force[10]",
       "nan is not finite", remedy},
      {"RecordingTimeBackwards", kind, poke("/step/time", 5, 1), "/step/time[5]", "goes backwards",
       remedy},
      {"RecordingElementBelowMinusOne", kind, poke("/step/element", 2, -2), "/step/element[2]",
       "is not -1 or a triangle", remedy},
      {"RecordingColumnTooShort", kind, replace("/step/tank", {3}, H5T_IEEE_F64LE), "/step/tank",
       "has shape (3), (5000) expected", remedy},
      {"RecordingChunkLost", kind, lose_a_chunk, "/step/depth", "was never written completely",
       remedy},
      {"RecordingClampNaN", kind, real("/settings", "max_force", kNaN), "/settings@max_force",
       "no number", remedy},
      {"RecordingRateNegative", kind, real("/", "rate", -1), "/@rate", "negative", remedy},
  };
}

TEST(Recording, AStepOfItsProvenanceMayHaveNeitherInputsNorFacts) {
  const TemporaryFolder folder;
  Recording session = recording(5);
  ASSERT_FALSE(session.provenance.steps.empty());
  session.provenance.steps.back().inputs.clear();
  session.provenance.steps.back().facts.clear();
  write_recording(folder / "a.h5", session);
  EXPECT_EQ(dump(read_recording(folder / "a.h5")), dump(session));
}

INSTANTIATE_TEST_SUITE_P(Recordings, Rejection, testing::ValuesIn(recording_cases()), name_of);

}  // namespace
}  // namespace palpate::samples
