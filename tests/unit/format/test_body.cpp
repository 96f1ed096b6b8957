// SPDX-License-Identifier: AGPL-3.0-or-later
// What a reader of bodies must refuse.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/sample_artifacts.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

/// The same data, but the dataset says they lie in a raw file beside it.
void store_externally(const Path& path) {
  const Path raw = path.parent_path() / "raw.bin";
  const std::size_t bytes = body(1).nodes.size() * sizeof(Vec3);
  std::ofstream(raw, std::ios::binary) << std::string(bytes, '\0');
  Hdf5Editor editor(path);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, raw.c_str(), 0, bytes);
  editor.claim("/nodes", {body(1).nodes.size(), 3}, H5T_IEEE_F64LE, properties);
  H5Pclose(properties);
}

std::vector<Case> curved_and_sprung_body_cases() {
  constexpr auto kSprung = Kind::SprungBody, kCurved = Kind::CurvedBody;
  return {
      {"BodyMiddlesMissing", kCurved, remove("/curved_edges/middle"), "/curved_edges/middle",
       "is missing"},
      {"BodyMiddlesTooFew", kCurved, replace("/curved_edges/middle", {3, 3}, H5T_IEEE_F64LE),
       "/curved_edges/middle", "(3, 3)"},
      {"BodyMiddleNaN", kCurved, poke("/curved_edges/middle", 4, kNaN), "/curved_edges/middle[1]",
       "nan is not finite"},
      {"BodyMiddleFarAway", kCurved, poke("/curved_edges/middle", 4, 0.5),
       "/curved_edges/middle[1]", "a quarter of its length"},
      {"BodyCurvedEdgeUnknown", kCurved, poke("/curved_edges/ends", 1, 63), "/curved_edges/ends[0]",
       "is not an edge of the boundary"},
      {"BodyCurvedEdgesTwice", kCurved, edit([](Hdf5Editor& e) {
         for (const std::size_t i : {0U, 1U})
           e.poke("/curved_edges/ends", 2 + i, curved_body(1).curved_edges[0].ends[i]);
       }),
       "/curved_edges/ends[1]", "is not above the row before it"},
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
  };
}

std::vector<Case> body_mesh_cases() {
  const auto kind = Kind::Body;
  return {
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
  };
}

std::vector<Case> body_marking_cases() {
  const auto kind = Kind::Body;
  return {
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
      {"BodySiteNeitherYesNorNo", kind, poke("/response/is_site", 0, 2), "/response/is_site[0]",
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

INSTANTIATE_TEST_SUITE_P(CurvedAndSprungBodies, Rejection,
                         testing::ValuesIn(curved_and_sprung_body_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(BodyMeshes, Rejection, testing::ValuesIn(body_mesh_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(BodyMarkings, Rejection, testing::ValuesIn(body_marking_cases()), name_of);

}  // namespace
}  // namespace palpate::samples
