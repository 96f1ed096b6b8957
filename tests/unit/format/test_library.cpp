// SPDX-License-Identifier: AGPL-3.0-or-later
// What a certificate means to the runtime and to people, and libraries of schema 1.
#include "format/library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/format/breakage.hpp"

namespace palpate {
namespace {

using samples::kInfinity;
using samples::kNaN;

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

TEST(LipschitzBoundText, IsRoundedUpToAValidSetting) {
  EXPECT_EQ(lipschitz_bound_text(104.41), "104.5 N/m");
  EXPECT_EQ(lipschitz_bound_text(104.5), "104.5 N/m");
}

TEST(Verdict, NamesTheRateTheReasonAndWhatThrottledSlidesBring) {
  const Certificate c = certificate(100, 400, 104.4);
  EXPECT_EQ(verdict(c, {"device", kNaN, kNaN, kNaN, kNaN}),
            "damping unknown: not certified for this device");
  EXPECT_EQ(verdict(c, {"device", 0.1, kInfinity, 0, 0}), "not certified: the slide has no bound");
  EXPECT_EQ(verdict(c, {"device", 0.1, 8000, 0, 0}),
            "certified passive from 8000 Hz; from 2088 Hz with lipschitz_bound = 104.4 N/m");
  EXPECT_EQ(verdict(certificate(100, 400), {"device", 0.1, 8000, 0, 0}),
            "certified passive from 8000 Hz");
}

TEST(LibraryOfSchemaOne, HasOtherNamesForTheBoundsOfTheCertificate) {
  const samples::TemporaryFolder folder;
  const auto path = folder / "library.h5";
  samples::copy_sample(samples::Kind::Library, path);
  const Certificate written = read_library(path).certificate;
  {
    samples::Hdf5Editor editor(path);
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
}  // namespace palpate
