// SPDX-License-Identifier: AGPL-3.0-or-later
// A good file with one thing broken must be refused, with a line that names file, object and
// remedy.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "format/error.hpp"
#include "format/hdf5_file.hpp"
#include "tests/unit/format/hdf5_editor.hpp"
#include "tests/unit/format/sample_artifacts.hpp"
#include "tests/unit/format/temporary_folder.hpp"

namespace palpate {
namespace {

using samples::Hdf5Editor;
using samples::TemporaryFolder;
using Path = std::filesystem::path;
using Break = std::function<void(const Path&)>;

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

enum class Kind { Body, SprungBody, Curves, Library, CoupledLibrary, Recording };

void write_sample(Kind kind, const Path& path) {
  switch (kind) {
    case Kind::Body:
      return write_body(path, samples::body(1));
    case Kind::SprungBody:
      return write_body(path, samples::sprung_body(1));
    case Kind::Curves:
      return write_curves(path, samples::curves(1));
    case Kind::Library:
      return write_library(path, samples::library(1));
    case Kind::CoupledLibrary:
      return write_library(path, samples::coupled_library(1));
    case Kind::Recording:
      return write_recording(path, samples::recording(1));
  }
}

/// Each kind is written once: a test copies it and breaks the copy.
void copy_sample(Kind kind, const Path& path) {
  static const TemporaryFolder originals;
  const Path original = originals / std::to_string(static_cast<int>(kind));
  if (!std::filesystem::exists(original)) write_sample(kind, original);
  std::filesystem::copy_file(original, path, std::filesystem::copy_options::overwrite_existing);
}

void read_sample(Kind kind, const Path& path) {
  switch (kind) {
    case Kind::Body:
    case Kind::SprungBody:
      static_cast<void>(read_body(path));
      return;
    case Kind::Curves:
      static_cast<void>(read_curves(path));
      return;
    case Kind::Library:
    case Kind::CoupledLibrary:
      static_cast<void>(read_library(path));
      return;
    case Kind::Recording:
      static_cast<void>(read_recording(path));
      return;
  }
}

/// One broken thing, and what the message must say of it.
struct Case {
  std::string name;
  Kind kind;
  Break damage;
  std::string object;   ///< named in the message
  std::string problem;  ///< part of the message
  std::string remedy = "make it again with";
};

Break edit(std::function<void(Hdf5Editor&)> change) {
  return [change = std::move(change)](const Path& path) {
    Hdf5Editor editor(path);
    change(editor);
  };
}
Break poke(const std::string& object, std::size_t position, double value) {
  return edit([=](Hdf5Editor& e) { e.poke(object, position, value); });
}
Break replace(const std::string& object, std::vector<hsize_t> extent, hid_t type,
              double value = 0) {
  return edit([=](Hdf5Editor& e) { e.replace(object, extent, type, value); });
}
Break remove(const std::string& object) {
  return edit([=](Hdf5Editor& e) { e.remove(object); });
}
Break real(const std::string& object, const std::string& name, double value) {
  return edit([=](Hdf5Editor& e) { e.set_attribute(object, name, value, H5T_NATIVE_DOUBLE); });
}
Break content(const std::string& text) {
  return [=](const Path& path) { std::ofstream(path, std::ios::binary) << text; };
}

void swap_corners(const Path& path) {
  const Tetrahedron first = samples::body(1).tetrahedra[0];
  Hdf5Editor editor(path);
  editor.poke("/tetrahedra", 0, first[1]);
  editor.poke("/tetrahedra", 1, first[0]);
}

void truncate_half(const Path& path) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
}

/// 2^40 numbers in deflated chunks of which none is stored.
void claim_a_terabyte(const Path& path) {
  Hdf5Editor editor(path);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 1 << 20;
  H5Pset_chunk(properties, 1, &chunk);
  H5Pset_deflate(properties, 9);
  editor.claim("/response/normal_knot", {hsize_t{1} << 40}, H5T_IEEE_F32LE, properties);
  H5Pclose(properties);
}

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

void link_elsewhere(const Path& path) {
  const Path other = path.parent_path() / "other.h5";
  std::filesystem::copy_file(path, other);
  Hdf5Editor editor(path);
  editor.remove("/surface/position");
  H5Lcreate_external(other.c_str(), "/surface/position", editor.file(), "/surface/position",
                     H5P_DEFAULT, H5P_DEFAULT);
}

/// The same data, but the dataset says they lie in a raw file beside it.
void store_externally(const Path& path) {
  const Path raw = path.parent_path() / "raw.bin";
  const std::size_t bytes = samples::body(1).nodes.size() * sizeof(Vec3);
  std::ofstream(raw, std::ios::binary) << std::string(bytes, '\0');
  Hdf5Editor editor(path);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, raw.c_str(), 0, bytes);
  editor.claim("/nodes", {samples::body(1).nodes.size(), 3}, H5T_IEEE_F64LE, properties);
  H5Pclose(properties);
}

// What every reader must refuse.
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
        kind == Kind::Library || kind == Kind::Body
            ? "has schema 99, this palpate reads 1 to 2; update palpate"
            : "has schema 99, this palpate reads 1; update palpate");
    add(name + "OfEarlierSchema", kind,
        edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 0, H5T_NATIVE_INT); }), ":/",
        "has schema 0, this palpate reads 1");
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
        ".h5", "is not a regular file");
  }
  return cases;
}

std::vector<Case> body_cases() {
  const auto kind = Kind::Body;
  const auto poke_u8 = [](const std::string& object, double value) {
    return poke(object, 0, value);
  };
  constexpr auto kSprung = Kind::SprungBody;
  return {
      {"BodySpringsMissing", kSprung, remove("/foundation/facet"), "/foundation/facet",
       "is missing"},
      {"BodySprungFacetTooLarge", kSprung, poke("/foundation/facet", 3, 100000),
       "/foundation/facet[3]", "index 100000 is not below"},
      {"BodySprungFacetsUnsorted", kSprung, poke("/foundation/facet", 2, 1), "/foundation/facet[2]",
       "is not above the row before it"},
      {"BodySpringNegative", kSprung, poke("/foundation/normal_stiffness", 1, -1.0),
       "/foundation/normal_stiffness[1]", "is not finite and not negative"},
      {"BodySpringNaN", kSprung, poke("/foundation/tangential_stiffness", 0, kNaN),
       "/foundation/tangential_stiffness[0]", "is not finite and not negative"},
      {"BodySpringsTooFew", kSprung, replace("/foundation/normal_stiffness", {3}, H5T_IEEE_F64LE),
       "/foundation/normal_stiffness", "4"},
      {"BodyNodesMissing", kind, remove("/nodes"), "/nodes", "is missing"},
      {"BodyNodeNaN", kind, poke("/nodes", 4, kNaN), "/nodes[1]", "nan is not finite"},
      {"BodyNodeInfinite", kind, poke("/nodes", 0, kInfinity), "/nodes[0]", "inf is not finite"},
      {"BodyNodesOfRank1", kind, replace("/nodes", {192}, H5T_IEEE_F64LE), "/nodes",
       "has shape (192), (any, 3) expected"},
      {"BodyNodesInThePlane", kind, replace("/nodes", {64, 2}, H5T_IEEE_F64LE), "/nodes",
       "has shape (64, 2), (any, 3) expected"},
      {"BodyNodesInSinglePrecision", kind, replace("/nodes", {64, 3}, H5T_IEEE_F32LE), "/nodes",
       "has the wrong type, 64-bit float expected"},
      {"BodyNodesNeverWritten", kind, edit([](Hdf5Editor& e) {
         e.claim("/nodes", {64, 3}, H5T_IEEE_F64LE);
       }),
       "/nodes", "claims more data than the file holds"},
      {"BodyNodesElsewhere", kind, store_externally, "/nodes", "is kept in another file"},
      {"BodyNodesAreAGroup", kind, edit([](Hdf5Editor& e) {
         e.remove("/nodes");
         H5Gclose(H5Gcreate2(e.file(), "/nodes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
       }),
       "/nodes", "is not a readable dataset"},
      {"BodyWithoutNodes", kind, replace("/nodes", {0, 3}, H5T_IEEE_F64LE), "/tetrahedra[0]",
       "is not below 0"},
      {"BodyWithoutTetrahedra", kind, replace("/tetrahedra", {0, 4}, H5T_STD_I32LE), "/tetrahedra",
       "is empty"},
      {"BodyTetrahedraUnsigned", kind, replace("/tetrahedra", {6, 4}, H5T_STD_U32LE), "/tetrahedra",
       "32-bit signed integer expected"},
      {"BodyCornerTooLarge", kind, poke("/tetrahedra", 5, 64), "/tetrahedra[1]",
       "index 64 is not below 64"},
      {"BodyCornerNegative", kind, poke("/tetrahedra", 5, -1), "/tetrahedra[1]", "index -1"},
      {"BodyCornerTwice", kind, replace("/tetrahedra", {6, 4}, H5T_STD_I32LE, 3), "/tetrahedra[0]",
       "names a corner twice"},
      {"BodyInverted", kind, swap_corners, "/tetrahedra[0]", "is inverted or flat"},
      {"BodyFlat", kind, replace("/nodes", {64, 3}, H5T_IEEE_F64LE, 1), "/tetrahedra[0]",
       "is inverted or flat"},
      {"BodyRegionOutOfRange", kind, poke("/tetrahedron_region", 9, 2), "/tetrahedron_region[9]",
       "index 2 is not below 2"},
      {"BodyRegionsTooFew", kind, replace("/tetrahedron_region", {5}, H5T_STD_I32LE),
       "/tetrahedron_region", "has 5 rows, 162 expected"},
      {"BodyRegionNamesAreNumbers", kind, replace("/region_names", {2}, H5T_STD_I32LE),
       "/region_names", "text of variable length expected"},
      {"BodyBoundaryOutOfRange", kind, poke("/boundary", 0, 1000), "/boundary[0]", "index 1000"},
      {"BodyFixedNodesUnordered", kind, poke("/fixed_nodes", 3, 2), "/fixed_nodes[3]",
       "is not above the row before it"},
      {"BodyResponseNodeInside", kind, poke("/response/node", 0, 21), "/response/node[0]",
       "is not a corner of a boundary facet"},
      {"BodyResponseNodeTwice", kind, poke("/response/node", 1, 0), "/response/node[1]",
       "names a node twice"},
      {"BodyInwardNotUnit", kind, poke("/response/inward", 0, 1.5), "/response/inward[0]",
       "1 expected"},
      {"BodyInwardNaN", kind, poke("/response/inward", 0, kNaN), "/response/inward[0]",
       "is not a unit direction"},
      {"BodyInwardTooFew", kind, replace("/response/inward", {0, 3}, H5T_IEEE_F64LE),
       "/response/inward", "has 0 rows, 56 expected"},
      {"BodyTriangleOutOfRange", kind, poke("/response/triangles", 4, 56), "/response/triangles[1]",
       "index 56 is not below 56"},
      {"BodySiteNeitherYesNorNo", kind, poke_u8("/response/is_site", 2), "/response/is_site[0]",
       "is not 0 or 1"},
      {"BodyNameMissing", kind, edit([](Hdf5Editor& e) { H5Adelete(e.file(), "name"); }), ":/",
       "attribute 'name' is missing"},
      {"BodyStageEmpty", kind,
       edit([](Hdf5Editor& e) { e.set_text("/provenance/00_mesh", "stage", ""); }), "/provenance",
       "is out of order"},
      {"BodyDigestsMissing", kind,
       edit([](Hdf5Editor& e) { e.set_text("/provenance/00_mesh", "input_sha256", "zz"); }),
       "/provenance/00_mesh", "differ in length"},
  };
}

std::vector<Case> curves_cases() {
  const auto kind = Kind::Curves;
  return {
      {"CurvesVertexNegative", kind, poke("/site/vertex", 0, -1), "/site/vertex[0]",
       "finite and not negative"},
      {"CurvesVerticesUnordered", kind, poke("/site/vertex", 2, 3), "/site/vertex[2]",
       "is not above the row before it"},
      {"CurvesStatusUnknown", kind, poke("/site/status", 1, 3), "/site/status[1]",
       "is not a status"},
      {"CurvesKindUnknown", kind, poke("/path/kind", 1, 2), "/path/kind[1]",
       "is not a kind of path"},
      {"CurvesPathOffsetDecreasing", kind, poke("/site/first_path", 2, 1), "/site/first_path[2]",
       "is not the sum of the counts before it"},
      {"CurvesSampleOffsetDecreasing", kind, poke("/path/first_sample", 1, 0),
       "/path/first_sample[1]", "is not the sum of the counts before it"},
      {"CurvesCountHuge", kind, poke("/path/sample_count", 0, 1e18), "/path/sample_count[0]",
       "leads beyond"},
      {"CurvesCountNegative", kind, poke("/site/path_count", 0, -1), "/site/path_count[0]",
       "finite and not negative"},
      {"CurvesForceNaN", kind, poke("/sample/force", 3, kNaN), "/sample/force[1]",
       "nan is not finite"},
      {"CurvesDirectionNotUnit", kind, poke("/path/direction", 3, 2), "/path/direction[1]",
       "1 expected"},
      {"CurvesStartNotAtTouch", kind, poke("/sample/displacement", 0, 1e-9),
       "/sample/displacement[0]", "does not begin at 0"},
      {"CurvesSamplesTooFew", kind, replace("/sample/penetration", {3}, H5T_IEEE_F64LE),
       "/sample/penetration", "has shape (3)"},
      {"CurvesReasonMissing", kind, remove("/site/reason"), "/site/reason", "is missing"},
      {"CurvesReasonOfAFailureEmpty", kind, poke("/site/status", 0, 2), "/site/reason[0]",
       "is empty, yet the site is not complete"},
      {"CurvesReasonWithoutAFailure", kind, poke("/site/status", 3, 0), "/site/reason[3]",
       "gives a reason, yet the site is complete"},
      {"CurvesSampleGroupMissing", kind, remove("/sample"), "/sample/displacement", "is missing"},
      {"CurvesDepthNaN", kind, real("/", "depth", kNaN), "/@depth", "is not finite"},
      {"CurvesRadiusNegative", kind, real("/", "tool_radius", -1), "/@tool_radius", "negative"},
      {"CurvesDigestShort", kind,
       edit([](Hdf5Editor& e) { e.set_text("/", "body_sha256", "abc"); }), "/@body_sha256",
       "is not a SHA-256"},
  };
}

std::vector<Case> library_cases() {
  const auto kind = Kind::Library;
  const auto coupled = Kind::CoupledLibrary;
  return {
      {"LibraryCoupledBaseZero", coupled, poke("/response/coupling_base", 0, 0),
       "/response/coupling_base[0]", "finite and above 0"},
      {"LibraryCoupledSlopeNegative", coupled, poke("/response/coupling_slope", 1, -1),
       "/response/coupling_slope[1]", "finite and not negative"},
      {"LibraryCoupledWithoutWeights", coupled, remove("/response/coupling_knot"),
       "/response/coupling_knot", "is missing"},
      {"LibraryCoupledWithoutBase", coupled, remove("/response/coupling_base"),
       "/response/coupling_base", "is missing"},
      // A library of decoupled responses cannot pass for the other kind.
      {"LibraryOfOtherKindOfResponse", kind,
       edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 2, H5T_NATIVE_INT); }),
       "/response/coupling_offset", "is missing"},
      {"LibraryPositionNaN", kind, poke("/surface/position", 0, kNaN), "/surface/position[0]",
       "nan is not finite"},
      {"LibraryPositionElsewhere", kind, link_elsewhere, "/surface/position",
       "is kept in another file by a link"},
      {"LibraryInwardNotUnit", kind, poke("/surface/inward", 1, 2), "/surface/inward[0]",
       "1 expected"},
      {"LibraryTriangleOutOfRange", kind, poke("/surface/triangles", 0, 999),
       "/surface/triangles[0]", "index 999"},
      {"LibraryOffsetDecreasing", kind, poke("/response/normal_offset", 2, 0),
       "/response/normal_offset[2]", "is below the row before it"},
      {"LibraryOffsetNotFromZero", kind, poke("/response/lateral_offset", 0, 1),
       "/response/lateral_offset[0]", "is not 0"},
      {"LibraryOffsetBeyondKnots", kind, poke("/response/normal_offset", 56, 1e15),
       "/response/normal_offset", "ends at 1000000000000000"},
      {"LibraryOffsetsTooFew", kind, replace("/response/normal_offset", {56}, H5T_STD_I64LE),
       "/response/normal_offset", "has shape (56), (57) expected"},
      {"LibraryCurveVanished", kind, poke("/response/normal_offset", 1, 0),
       "/response/normal_offset[0]", "under 2 knots"},
      {"LibraryKnotNotFromZero", kind, poke("/response/normal_knot", 0, 1e-5),
       "/response/normal_knot[0]", "begins not at 0"},
      {"LibraryKnotRepeated", kind, poke("/response/lateral_knot", 1, 0),
       "/response/lateral_knot[1]", "is not above the knot before it"},
      {"LibraryKnotNaN", kind, poke("/response/normal_knot", 1, kNaN), "/response/normal_knot[1]",
       "nan is not finite"},
      {"LibrarySlopeNegative", kind, poke("/response/normal_slope", 1, -1e-3),
       "/response/normal_slope[1]", "is not finite and not negative"},
      {"LibrarySlopeInfinite", kind, poke("/response/lateral_slope", 0, kInfinity),
       "/response/lateral_slope[0]", "inf is not finite"},
      {"LibrarySlopesTooFew", kind, replace("/response/normal_slope", {7}, H5T_IEEE_F32LE),
       "/response/normal_slope", "has shape (7)"},
      {"LibraryKnotsInDoublePrecision", kind, replace("/response/normal_knot", {7}, H5T_IEEE_F64LE),
       "/response/normal_knot", "32-bit float expected"},
      {"LibraryKnotsAreABomb", kind, claim_a_terabyte, "/response/normal_knot",
       "claims more data than the file holds"},
      {"LibraryStatusUnknown", kind, poke("/response/status", 0, 9), "/response/status[0]",
       "is not a status"},
      {"LibraryHoleThatIsNone", kind, poke("/response/status", 5, 0), "/response/normal_offset[5]",
       "under 2 knots"},
      {"LibraryErrorNaN", kind, poke("/response/normal_error", 2, kNaN),
       "/response/normal_error[2]", "nan"},
      {"LibraryCertificateMissing", kind, remove("/certificate"), "/certificate", "is missing"},
      {"LibraryStickNaN", kind, real("/certificate", "stick", kNaN), "/certificate@stick",
       "not negative"},
      {"LibraryFrictionInfinite", kind, real("/certificate", "friction", kInfinity),
       "/certificate@friction", "is not finite"},
      {"LibraryWorstTriangleOutOfRange", kind, edit([](Hdf5Editor& e) {
         e.set_attribute("/certificate", "worst_triangle", 108, H5T_NATIVE_INT);
       }),
       "/certificate@worst_triangle", "-1 or a triangle"},
      {"LibraryWorstTriangleHuge", kind, edit([](Hdf5Editor& e) {
         e.set_attribute("/certificate", "worst_triangle", 1LL << 40, H5T_NATIVE_LLONG);
       }),
       "/certificate@worst_triangle", "is out of range"},
      {"LibraryBoundMissing", kind, poke("/certificate/triangle/stick", 4, kNaN),
       "/certificate/triangle/stick[4]", "nan is not"},
      {"LibraryCosineAboveOne", kind, poke("/certificate/triangle/cos_theta", 4, 1.1),
       "/certificate/triangle/cos_theta[4]", "between -1 and 1"},
      {"LibraryDeviceNameMissing", kind, remove("/certificate/device/name"),
       "/certificate/device/name", "is missing"},
  };
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

std::vector<Case> all_cases() {
  std::vector<Case> cases = common_cases();
  for (const auto& more : {body_cases(), curves_cases(), library_cases(), recording_cases()}) {
    cases.insert(cases.end(), more.begin(), more.end());
  }
  return cases;
}

void PrintTo(const Case& broken, std::ostream* out) {
  *out << broken.name;
}

class Rejection : public testing::TestWithParam<Case> {};

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

INSTANTIATE_TEST_SUITE_P(Broken, Rejection, testing::ValuesIn(all_cases()),
                         [](const auto& param) { return param.param.name; });

/// Every attribute of a file, as (object, name).
using AttributeList = std::vector<std::pair<std::string, std::string>>;

herr_t note_attribute(hid_t object, const char* name, const H5A_info_t*, void* list) {
  std::array<char, 256> path{};
  H5Iget_name(object, path.data(), path.size());
  static_cast<AttributeList*>(list)->emplace_back(path.data(), name);
  return 0;
}
herr_t note_object(hid_t file, const char* name, const H5O_info_t*, void* list) {
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_attribute, list);
  H5Oclose(object);
  return 0;
}
AttributeList attributes_of(const Path& path) {
  AttributeList list;
  const Hdf5Editor editor(path);
  H5Ovisit(editor.file(), H5_INDEX_NAME, H5_ITER_INC, note_object, &list);
  return list;
}

/// What a reader may do without: texts for people, and what later versions added.
bool may_be_missing(const std::string& name) {
  for (const char* optional :
       {"description", "creator", "basis", "tool_edge_radius", "tool_length"})
    if (name == optional) return true;
  return false;
}

/// Texts have no units to speak of.
bool is_texts(const std::string& dataset) {
  return dataset == "/region_names" || dataset == "/site/reason" ||
         dataset == "/certificate/device/name";
}

class EveryAttribute : public testing::TestWithParam<Kind> {
 protected:
  /// The refusal of the sample after this change; empty when it was accepted.
  std::string refusal(const std::function<void(Hdf5Editor&)>& change) const {
    const Path path = folder_ / "artifact.h5";
    copy_sample(GetParam(), path);
    edit(change)(path);
    try {
      read_sample(GetParam(), path);
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
    return "";
  }
  AttributeList attributes() const {
    copy_sample(GetParam(), folder_ / "artifact.h5");
    return attributes_of(folder_ / "artifact.h5");
  }

  const TemporaryFolder folder_;
};

TEST_P(EveryAttribute, IsMissed) {
  int tried = 0;
  for (const auto& [object, name] : attributes()) {
    const bool is_text_list = is_texts(object);
    if (may_be_missing(name) || (is_text_list && name == "units")) continue;
    const std::string said =
        refusal([&, o = object, n = name](Hdf5Editor& editor) { editor.remove_attribute(o, n); });
    EXPECT_THAT(said, testing::HasSubstr(object)) << name;
    EXPECT_THAT(said, testing::HasSubstr(name)) << object;
    ++tried;
  }
  EXPECT_GT(tried, 20);
}

TEST_P(EveryAttribute, OfUnitsIsBelieved) {
  // Millimetres read as metres would be a body a thousand times as large.
  int tried = 0;
  for (const auto& [object, name] : attributes()) {
    const bool is_text_list = is_texts(object);
    if (name != "units" || is_text_list) continue;
    const std::string said =
        refusal([o = object](Hdf5Editor& editor) { editor.set_text(o, "units", "mm"); });
    EXPECT_THAT(said, testing::HasSubstr(object + "@units"));
    ++tried;
  }
  EXPECT_GT(tried, 8);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryAttribute,
                         testing::Values(Kind::Body, Kind::Curves, Kind::Library,
                                         Kind::CoupledLibrary, Kind::Recording));

// An inverted tetrahedron is a matter of the shape, not of the file.
TEST(RejectionKind, InvertedTetrahedronIsBadGeometry) {
  const TemporaryFolder folder;
  write_body(folder / "body.h5", samples::body(1));
  swap_corners(folder / "body.h5");
  try {
    read_body(folder / "body.h5");
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
  }
}

// A file cut at any length is refused, never read as far as it goes.
TEST(Truncation, AtAnyLength) {
  const TemporaryFolder folder;
  const Path path = folder / "library.h5";
  copy_sample(Kind::Library, path);
  const auto whole = std::filesystem::file_size(path);
  for (int part = 0; part < 50; ++part) {
    copy_sample(Kind::Library, path);
    std::filesystem::resize_file(path, whole * static_cast<std::uintmax_t>(part) / 50);
    EXPECT_THROW(static_cast<void>(read_library(path)), Error) << part << "/50";
  }
}

// One wrong byte anywhere: refused, or of no consequence (a letter of the seal's own mark). HDF5 on
// its own would read other numbers, loop, or crash.
TEST(Damage, OneByteNeverChangesWhatIsRead) {
  const TemporaryFolder folder;
  const Path path = folder / "library.h5";
  const std::string known = samples::dump(samples::library(1));
  copy_sample(Kind::Library, path);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
  int refused = 0, harmless = 0;
  constexpr std::streamoff kSeal = 81;
  for (std::streamoff position = 0; position < size;
       position += position < size - kSeal - 211 ? 211 : 1) {
    copy_sample(Kind::Library, path);
    {
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      const int good = file.seekg(position).get();
      file.seekp(position).put(static_cast<char>(good ^ 0x55));
    }
    try {
      EXPECT_EQ(samples::dump(read_library(path)), known) << "byte " << position;
      ++harmless;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("is damaged")) << "byte " << position;
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_EQ(harmless, 17) << "letters of the mark and the last line end";
}

// HDF5 cannot lock a file on some network disks, nor one that another program holds.
TEST(Locking, RefusedLockNamesTheSwitch) {
  const TemporaryFolder folder;
  const Path path = folder / "body.h5";
  copy_sample(Kind::Body, path);
  const int descriptor = open(path.c_str(), O_RDWR);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  try {
    static_cast<void>(read_body(path));
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.remedy(), testing::HasSubstr("HDF5_USE_FILE_LOCKING=FALSE"));
  }
  close(descriptor);
}

// HDF5's printing belongs to the program around; it must be as before.
TEST(Silence, ErrorPrintingIsRestored) {
  H5E_auto2_t before = nullptr, after = nullptr;
  void *before_data = nullptr, *after_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &before_data);
  testing::internal::CaptureStderr();
  const TemporaryFolder folder;
  write_body(folder / "body.h5", samples::body(1));
  truncate_half(folder / "body.h5");
  EXPECT_THROW(static_cast<void>(read_body(folder / "body.h5")), Error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  H5Eget_auto2(H5E_DEFAULT, &after, &after_data);
  EXPECT_EQ(before, after);
  EXPECT_EQ(before_data, after_data);
}

// Every identifier is closed again, also on the way out of a failure.
TEST(Identifiers, NoneIsLeftOpen) {
  const TemporaryFolder folder;
  write_library(folder / "library.h5", samples::library(1));
  static_cast<void>(read_library(folder / "library.h5"));
  poke("/response/normal_slope", 1, -1.0)(folder / "library.h5");
  EXPECT_THROW(static_cast<void>(read_library(folder / "library.h5")), Error);
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

}  // namespace
}  // namespace palpate
