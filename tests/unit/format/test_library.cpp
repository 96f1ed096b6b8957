// SPDX-License-Identifier: AGPL-3.0-or-later
// What a certificate means to the runtime, libraries of schema 1, and what a reader must refuse.
#include "format/library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

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

void link_elsewhere(const Path& path) {
  const Path other = path.parent_path() / "other.h5";
  std::filesystem::copy_file(path, other);
  Hdf5Editor editor(path);
  editor.remove("/surface/position");
  H5Lcreate_external(other.c_str(), "/surface/position", editor.file(), "/surface/position",
                     H5P_DEFAULT, H5P_DEFAULT);
}

std::vector<Case> relaxation_cases() {
  const auto relaxing = Kind::RelaxingLibrary;
  return {
      {"LibraryRelaxingTimeZero", relaxing, poke("/relaxation/time", 0, 0), "/relaxation/time[0]",
       "finite and above 0"},
      {"LibraryRelaxingTimesDescending", relaxing, poke("/relaxation/time", 1, 1e-6),
       "/relaxation/time[1]", "is not above the time before it"},
      {"LibraryRelaxingFractionNegative", relaxing, poke("/response/relaxation_fraction", 1, -0.1),
       "/response/relaxation_fraction[1]", "finite and not negative"},
      {"LibraryRelaxingAltogether", relaxing, poke("/response/relaxation_fraction", 1, 1),
       "/response/relaxation_fraction[0]", "has a sum of 1 or more"},
      {"LibraryRelaxingWithoutFractions", relaxing, remove("/response/relaxation_fraction"),
       "/response/relaxation_fraction", "is missing"},
      {"LibraryRelaxingWithoutAToolRadius", relaxing,
       edit([](Hdf5Editor& e) { e.set_attribute("/", "tool_radius", 0.0, H5T_NATIVE_DOUBLE); }),
       "/@tool_radius", "is not above 0"},
  };
}

std::vector<Case> soft_axis_cases() {
  const auto soft = Kind::SoftLibrary;
  const auto says = [](const char* name, int value) {
    return edit([=](Hdf5Editor& e) { e.set_attribute("/", name, value, H5T_NATIVE_INT); });
  };
  return {
      {"LibrarySoftAxisNotANumber", soft, poke("/response/soft_axis", 4, kNaN),
       "/response/soft_axis[1]", "is longer than 0.707"},
      {"LibrarySoftAxisInfinite", soft, poke("/response/soft_axis", 0, -kInfinity),
       "/response/soft_axis[0]", "is longer than 0.707"},
      {"LibrarySoftAxisTooLong", soft, poke("/response/soft_axis", 3, 0.7072),
       "/response/soft_axis[1]", "is longer than 0.707"},
      {"LibrarySoftAxesTooFew", soft, replace("/response/soft_axis", {2, 3}, H5T_IEEE_F32LE),
       "/response/soft_axis", "has 2 rows"},
      {"LibrarySoftAxesMissing", soft, remove("/response/soft_axis"), "/response/soft_axis",
       "is missing"},
      {"LibraryThatSaysItHasNoSoftAxes", soft, says("soft_axes", 0), "/@soft_axes", "is not 1"},
      {"LibraryThatDoesNotSaySoftAxes", Kind::CoupledLibrary, says("schema", 8), ":/", "soft_axes"},
      {"LibrarySoftAxesOfDecoupledResponses", soft, says("coupled", 0), "/response/soft_axis",
       "is of decoupled responses, which have no soft axes"},
  };
}

std::vector<Case> schema_cases() {
  const auto kind = Kind::Library;
  return {
      // A library of decoupled responses cannot pass for the other kind.
      {"LibraryOfOtherKindOfResponse", kind,
       edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 4, H5T_NATIVE_INT); }), ":/",
       "has coupled responses that an earlier palpate has fitted"},
      {"LibraryOfASchemaThatSaysMore", kind,
       edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 6, H5T_NATIVE_INT); }), ":/",
       "relaxes"},
      {"LibraryRelaxingThatSaysItIsCoupled", Kind::RelaxingLibrary,  // it does
       edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 5, H5T_NATIVE_INT); }), ":/",
       "has coupled responses that an earlier palpate has fitted"},
      {"LibraryOfSchemaTwo", kind,
       edit([](Hdf5Editor& e) { e.set_attribute("/", "schema", 2, H5T_NATIVE_INT); }), ":/",
       "has schema 2, this palpate reads 1, 3, 4, 5, 6, 7 and 8"},
  };
}

std::vector<Case> surface_and_response_cases() {
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
  };
}

std::vector<Case> status_and_certificate_cases() {
  const auto kind = Kind::Library;
  return {
      {"LibraryStatusUnknown", kind, poke("/response/status", 0, 9), "/response/status[0]",
       "is not a status"},
      {"LibraryHoleThatIsNone", kind, poke("/response/status", 5, 0), "/response/normal_offset[5]",
       "under 2 knots"},
      {"LibraryErrorNaN", kind, poke("/response/normal_error", 2, kNaN),
       "/response/normal_error[2]", "nan"},
      {"LibraryCertificateMissing", kind, remove("/certificate"), "/certificate", "is missing"},
      {"LibraryStickNaN", kind, real("/certificate", "stick", kNaN), "/certificate@stick",
       "not negative"},
      {"LibraryMinLipschitzBoundNegative", kind, real("/certificate", "min_lipschitz_bound", -1.0),
       "/certificate@min_lipschitz_bound", "not negative"},
      {"LibraryLipschitzBoundNegative", kind, real("/certificate", "lipschitz_bound", -1.0),
       "/certificate@lipschitz_bound", "not negative"},
      // Slides of this library change the force by up to 1530 N/m, and the runtime can hold them to
      // 953.5 N/m at the best.
      {"LibraryLipschitzBoundBelowTheSmallestEnforceable", kind,
       real("/certificate", "lipschitz_bound", 953.0), "/certificate@lipschitz_bound",
       "953 N/m, below the smallest bound that the runtime can enforce"},
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

INSTANTIATE_TEST_SUITE_P(Relaxation, Rejection, ::testing::ValuesIn(relaxation_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(SoftAxes, Rejection, ::testing::ValuesIn(soft_axis_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Schemas, Rejection, ::testing::ValuesIn(schema_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(SurfacesAndResponses, Rejection,
                         testing::ValuesIn(surface_and_response_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(StatusAndCertificates, Rejection,
                         testing::ValuesIn(status_and_certificate_cases()), name_of);

/// A certificate of one triangle.
Certificate certificate(double stick, double slip, double min_bound = kNaN, double bound = kNaN) {
  Certificate c;
  c.stick = stick;
  c.slip = slip;
  c.min_lipschitz_bound = min_bound;
  c.lipschitz_bound = bound;
  c.triangles.resize(1);
  return c;
}

TEST(EnforcedLipschitzBound, IsThatOfTheCertificate) {
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, 200, 120, 150)), 150);
}

TEST(EnforcedLipschitzBound, IsWithoutAChoiceThatOfSlidesUpToFourTimesThatOfStick) {
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, 200)), 200);
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, 80)), 100);
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, kInfinity)), 400);
}

TEST(EnforcedLipschitzBound, IsAtLeastTheSmallestEnforceableBound) {
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, kInfinity, 500)), 500);
  EXPECT_EQ(enforced_lipschitz_bound(certificate(100, kInfinity, kInfinity)), 400);
}

TEST(EnforcedLipschitzBound, IsInfiniteWithoutACertificate) {
  EXPECT_TRUE(std::isinf(enforced_lipschitz_bound(Certificate{})));
}

TEST(CertifiedLipschitzBound, IsInfiniteWhereTheBoundMayNotBeEnforceable) {
  EXPECT_EQ(certified_lipschitz_bound(certificate(100, 200)), 200);
  EXPECT_EQ(certified_lipschitz_bound(certificate(100, kInfinity, 120)), 400);
  EXPECT_TRUE(std::isinf(certified_lipschitz_bound(certificate(100, kInfinity))));
  EXPECT_TRUE(std::isinf(certified_lipschitz_bound(certificate(100, 200, 180, 150))));
}

TEST(LibraryOfSchemaOne, HasOtherNamesForTheBoundsOfTheCertificate) {
  const TemporaryFolder folder;
  const auto path = folder / "library.h5";
  copy_sample(Kind::Library, path);
  const Certificate written = read_library(path).certificate;
  {
    Hdf5Editor editor(path);
    editor.set_attribute("/", "schema", 1, H5T_NATIVE_INT);
    const auto rename = [&](const char* name, const char* old_name) {
      ASSERT_GE(H5Arename_by_name(editor.file(), "/certificate", name, old_name, H5P_DEFAULT), 0);
    };
    rename("min_lipschitz_bound", "hold");
    rename("lipschitz_bound", "limit");
    rename("interpolated", "filled");
  }
  const Certificate read = read_library(path).certificate;
  ASSERT_FALSE(std::isnan(written.min_lipschitz_bound));
  EXPECT_EQ(read.min_lipschitz_bound, written.min_lipschitz_bound);
  EXPECT_EQ(read.lipschitz_bound, written.lipschitz_bound);
  EXPECT_EQ(read.interpolated, written.interpolated);
}

}  // namespace
}  // namespace palpate::samples
