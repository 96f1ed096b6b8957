// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/site_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "format/error.hpp"
#include "tests/support/sample_artifacts.hpp"

namespace palpate {
namespace {

std::string dump(const SiteCurves& site) {
  Curves curves;
  curves.sites = {site};
  return samples::dump(curves);
}

TEST(SiteRecord, ComesBackToTheBit) {
  const Curves curves = samples::curves(3);
  ASSERT_GT(curves.sites.size(), 10u);
  for (const SiteCurves& site : curves.sites)
    EXPECT_EQ(dump(site_from_bytes(site_bytes(site), "a.journal")), dump(site));
}

TEST(SiteRecord, OfRelaxingTissueComesBackWithTheEnergiesOfItsRegions) {
  const Curves curves = samples::relaxing_curves(3);
  for (const SiteCurves& site : curves.sites)
    EXPECT_EQ(dump(site_from_bytes(site_bytes(site), "a.journal")), dump(site));
  const std::string whole = site_bytes(curves.sites[0]);
  const std::size_t elastic = site_bytes(samples::curves(3).sites[0]).size();
  for (std::size_t length = elastic + 1; length < whole.size(); ++length)
    EXPECT_THROW(site_from_bytes(std::string_view(whole).substr(0, length), "a.journal"), Error);
}

/// A journal may be cut anywhere by a crash, and disks lie.
TEST(SiteRecord, CutOrLengthenedIsRefused) {
  const std::string bytes = site_bytes(samples::curves(3).sites[0]);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(site_from_bytes(std::string_view(bytes).substr(0, length), "a.journal"), Error)
        << length;
  EXPECT_THROW(site_from_bytes(bytes + '\0', "a.journal"), Error);
}

/// What the digest of results is for: two campaigns with the same results, on another day and
/// another machine.
TEST(ContentDigest, IsOfTheResultsAlone) {
  const Curves curves = samples::curves(3);
  const std::string digest = content_sha256(curves);
  EXPECT_EQ(digest.size(), 64u);
  Curves other = curves;
  other.provenance = {};
  for (SiteCurves& site : other.sites) site.cpu_seconds += 1;
  EXPECT_EQ(content_sha256(other), digest);
  const auto expect_other = [&](const std::function<void(Curves&)>& change) {
    Curves changed = curves;
    change(changed);
    EXPECT_NE(content_sha256(changed), digest);
  };
  expect_other([](Curves& c) { c.depth *= 1 + 1e-15; });
  expect_other([](Curves& c) { c.tool.radius *= 2; });
  expect_other([](Curves& c) { c.sites[0].vertex += 1; });
  expect_other([](Curves& c) {
    double& f = c.sites[0].paths[0].samples[0].force[2];
    f = std::nextafter(f, 1e9);
  });
  expect_other([](Curves& c) { std::swap(c.sites[0], c.sites[1]); });
  expect_other([](Curves& c) { c.relaxation = samples::relaxing_curves(3).relaxation; });
  expect_other([](Curves& c) {
    for (CurvePath& path : c.sites[0].paths)
      for (CurveSample& sample : path.samples) sample.isochoric_energy = {1e-3};
  });
}

}  // namespace
}  // namespace palpate
