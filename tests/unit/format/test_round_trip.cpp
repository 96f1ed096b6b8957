// SPDX-License-Identifier: AGPL-3.0-or-later
// What is written is what is read, to the last bit.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <regex>
#include <string>

#include "format/sha256.hpp"
#include "palpate_version.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/hdf5_editor.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::dump;
using samples::expect_refusal;
using samples::TemporaryFolder;

constexpr unsigned kSeeds = 5;

TEST(RoundTrip, Body) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Body body = samples::body(seed);
    write_body(folder / "body.h5", body);
    EXPECT_EQ(dump(read_body(folder / "body.h5")), dump(body));
    const Body sprung = samples::sprung_body(seed);
    write_body(folder / "sprung.h5", sprung);
    EXPECT_EQ(dump(read_body(folder / "sprung.h5")), dump(sprung));
    EXPECT_NE(dump(sprung), dump(body));
    const Body curved = samples::curved_body(seed);
    write_body(folder / "curved.h5", curved);
    EXPECT_EQ(dump(read_body(folder / "curved.h5")), dump(curved));
    EXPECT_NE(dump(curved), dump(sprung));
    const Body measured = samples::measured_body(seed);
    write_body(folder / "measured.h5", measured);
    EXPECT_EQ(dump(read_body(folder / "measured.h5")), dump(measured));
  }
}

TEST(RoundTrip, AMeasuredSurfaceKnowsNothingOfItsInside) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::function<void(Body&)>& change, const std::string& where) {
    Body body = samples::measured_body(1);
    change(body);
    expect_refusal([&] { write_body(folder / "measured.h5", body); }, ErrorKind::Internal, where,
                   "");
  };
  refused([](Body& body) { body.fixed_nodes = {0}; }, "/fixed_nodes");
  refused([](Body& body) { body.region_names = {"liver"}; }, "/region_names");
  refused([](Body& body) { body.foundation = {{0, 1, 1}}; }, "/foundation/facet");
  refused([](Body& body) { body.tetrahedron_region = {0}; }, "/tetrahedron_region");
  refused([](Body& body) { body.boundary.clear(); }, "/boundary");
  expect_refusal([] { require_inside(samples::measured_body(1), "precompute"); },
                 ErrorKind::Configuration, "precompute", "whose inside is unknown");
  EXPECT_NO_THROW(require_inside(samples::body(1), "precompute"));
}

TEST(RoundTrip, Curves) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Curves curves = samples::curves(seed);
    write_curves(folder / "curves.h5", curves);
    EXPECT_EQ(dump(read_curves(folder / "curves.h5")), dump(curves));
    const Curves relaxing = samples::relaxing_curves(seed);
    write_curves(folder / "relaxing.h5", relaxing);
    EXPECT_EQ(dump(read_curves(folder / "relaxing.h5")), dump(relaxing));
    EXPECT_NE(dump(relaxing), dump(curves));
  }
}

TEST(RoundTrip, CurvesKnowTheConfidenceOfTheErrorOfTheMesh) {
  const TemporaryFolder folder;
  Curves curves = samples::curves(1);
  curves.mesh_error_confidence = 0.95;
  write_curves(folder / "curves.h5", curves);
  EXPECT_EQ(read_curves(folder / "curves.h5").mesh_error_confidence, 0.95);
  curves.mesh_error_confidence = 1.5;
  expect_refusal([&] { write_curves(folder / "curves.h5", curves); }, ErrorKind::Internal,
                 "/@mesh_error_confidence", "is not a probability");
}

/// Curves of before have no columns for it.
TEST(RoundTrip, CurvesWithoutTheErrorOfTheMeshAreRead) {
  const TemporaryFolder folder;
  Curves curves = samples::curves(1);
  curves.mesh_error_confidence = std::numeric_limits<double>::quiet_NaN();
  write_curves(folder / "curves.h5", curves);
  {
    samples::Hdf5Editor editor(folder / "curves.h5");
    for (const char* name : {"facets_in_contact", "mesh_difference", "mesh_error"})
      editor.remove(std::string("/sample/") + name);
  }
  const Curves read = read_curves(folder / "curves.h5");
  EXPECT_TRUE(std::isnan(read.mesh_error_confidence));
  for (const SiteCurves& site : read.sites)
    for (const CurvePath& path : site.paths)
      for (const CurveSample& sample : path.samples) {
        EXPECT_TRUE(std::isnan(sample.facets_in_contact));
        EXPECT_TRUE(std::isnan(sample.mesh_difference));
        EXPECT_TRUE(std::isnan(sample.mesh_error));
      }
}

TEST(RoundTrip, ALibraryHasTheErrorOfTheMesh) {
  const TemporaryFolder folder;
  Library library = samples::library(1);
  write_library(folder / "library.h5", library);
  EXPECT_TRUE(std::isnan(read_library(folder / "library.h5").responses[0].normal_mesh_error));
  library.responses[0].normal_mesh_error = 0.02;
  write_library(folder / "library.h5", library);
  const Library read = read_library(folder / "library.h5");
  EXPECT_EQ(read.responses[0].normal_mesh_error, 0.02);
  EXPECT_TRUE(std::isnan(read.responses[0].lateral_mesh_error));
  EXPECT_TRUE(std::isnan(read.responses[1].normal_mesh_error));
  library.responses[1].lateral_mesh_error = 0.03;
  write_library(folder / "library.h5", library);
  EXPECT_EQ(read_library(folder / "library.h5").responses[1].lateral_mesh_error, 0.03);
}

TEST(RoundTrip, CurvesOfRelaxingTissueWithoutTheEnergyOfARegionAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::function<void(Curves&)>& change, const std::string& where,
                           const std::string& problem) {
    Curves curves = samples::relaxing_curves(1);
    change(curves);
    expect_refusal([&] { write_curves(folder / "curves.h5", curves); }, ErrorKind::Internal, where,
                   problem);
  };
  refused([](Curves& c) { c.sites[0].paths[0].samples[1].isochoric_energy.pop_back(); },
          "/relaxation/isochoric_energy[1]", "has 1 regions, and the relaxation 2");
  refused([](Curves& c) { c.relaxation = {}; }, "/relaxation/isochoric_energy[0]",
          "has 2 regions, and the relaxation 0");
  refused([](Curves& c) { c.relaxation.times_s[1] = 0.1; }, "/relaxation/time[1]",
          "not above the row before");
  refused(
      [](Curves& c) {
        c.relaxation.fractions[1][0] = 0.9;
        c.relaxation.fractions[1][1] = 0.2;
      },
      "/relaxation/fraction[3]", "do not sum to less than 1");
}

TEST(RoundTrip, Library) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Library library = samples::library(seed);
    write_library(folder / "library.h5", library);
    EXPECT_EQ(dump(read_library(folder / "library.h5")), dump(library));
    const Library coupled = samples::coupled_library(seed);
    write_library(folder / "coupled.h5", coupled);
    EXPECT_EQ(dump(read_library(folder / "coupled.h5")), dump(coupled));
    EXPECT_NE(dump(coupled), dump(library));
    const Library relaxing = samples::relaxing_library(seed);
    write_library(folder / "relaxing.h5", relaxing);
    EXPECT_EQ(dump(read_library(folder / "relaxing.h5")), dump(relaxing));
    const Library leaning = samples::leaning_library(seed);
    write_library(folder / "leaning.h5", leaning);
    EXPECT_EQ(dump(read_library(folder / "leaning.h5")), dump(leaning));
    const Library soft = samples::soft_library(seed);
    write_library(folder / "soft.h5", soft);
    EXPECT_EQ(dump(read_library(folder / "soft.h5")), dump(soft));
    EXPECT_TRUE(soft.has_soft_axes());
  }
}

TEST(RoundTrip, LibraryBeforeCertification) {
  const TemporaryFolder folder;
  Library library = samples::library(1);
  library.certificate = Certificate{};
  write_library(folder / "library.h5", library);
  EXPECT_EQ(dump(read_library(folder / "library.h5")), dump(library));
}

TEST(RoundTrip, Recording) {
  const TemporaryFolder folder;
  const Recording recording = samples::recording(3);
  write_recording(folder / "recording.h5", recording);
  EXPECT_EQ(dump(read_recording(folder / "recording.h5")), dump(recording));
}

TEST(RoundTrip, EmptyTablesSurvive) {
  const TemporaryFolder folder;
  Recording recording = samples::recording(1);
  recording.steps.clear();
  recording.provenance.steps.clear();
  write_recording(folder / "recording.h5", recording);
  EXPECT_EQ(dump(read_recording(folder / "recording.h5")), dump(recording));
  Curves curves = samples::curves(1);
  curves.sites.clear();
  write_curves(folder / "curves.h5", curves);
  EXPECT_EQ(dump(read_curves(folder / "curves.h5")), dump(curves));
}

// Merging shards and skipping what is up to date compare digests of files.
TEST(RoundTrip, SameContentGivesSameBytes) {
  const TemporaryFolder folder;
  write_library(folder / "a.h5", samples::library(2));
  write_library(folder / "b.h5", read_library(folder / "a.h5"));
  EXPECT_EQ(sha256_of_file(folder / "a.h5"), sha256_of_file(folder / "b.h5"));
}

// A resolved case longer than the 64 KiB HDF5 grants to an attribute.
TEST(RoundTrip, LongProvenance) {
  const TemporaryFolder folder;
  Body body = samples::body(1);
  body.provenance.steps[0].resolved_case = std::string(300000, 'x');
  for (int i = 0; i < 60; ++i) body.provenance.steps.push_back(body.provenance.steps[0]);
  write_body(folder / "body.h5", body);
  EXPECT_EQ(dump(read_body(folder / "body.h5")), dump(body));
}

TEST(Provenance, StepTellsBuildTimeAndInputs) {
  const TemporaryFolder folder;
  write_body(folder / "body.h5", samples::body(1));
  const ProvenanceStep step =
      make_provenance_step("fit", "a = 1\n", {folder / "body.h5"}, {{"Ceres", "2.1"}});
  EXPECT_EQ(step.stage, "fit");
  EXPECT_EQ(step.version, PALPATE_VERSION);
  EXPECT_EQ(step.git_revision, PALPATE_GIT_REVISION);
  EXPECT_TRUE(std::regex_match(step.utc, std::regex(R"(20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
  ASSERT_EQ(step.inputs.size(), 1U);
  EXPECT_EQ(step.inputs[0].name, "body.h5");
  EXPECT_EQ(step.inputs[0].sha256, sha256_of_file(folder / "body.h5"));
  EXPECT_EQ(step.facts.at(0).second, "2.1");
}

}  // namespace
}  // namespace palpate
