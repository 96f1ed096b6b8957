// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/timely_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/case/case.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNoTime = 1e-4, kAnyTime = 1e4;  // min

struct Timely {
  FirstCase first;
  Case c;
  bool is_refined() const {
    return c.campaign.indentation.refine_under_tool == fem::IndentationSettings::kByContact;
  }
  double depth_over_patch() const { return c.campaign.indentation.depth / c.mesh.patch_spacing; }
};

CaseOf case_of(const std::string& file, const samples::TemporaryFolder& folder) {
  CaseOf of{read_body_file(test::source_folder() / file, ""), {}, "", folder / "case.toml"};
  of.base = find_base(of.body.surface);
  return of;
}

Timely timely(const FirstWishes& wishes) {
  const samples::TemporaryFolder folder;
  const CaseOf of = case_of("data/bodies/pad.off", folder);
  Timely result{timely_case(of, wishes), {}};
  result.c = parse_case(result.first.toml, "case.toml");
  return result;
}

TEST(TimelyCase, WithoutALimitIsThatOfTheShapeAndSaysNothingOfTime) {
  const Timely any = timely({.sites = 20, .minutes = 0, .threads = 2});
  EXPECT_THAT(any.first.toml, Not(HasSubstr("campaign takes")));
  EXPECT_THAT(any.first.remarks.back(), HasSubstr("sites: "));
}

TEST(TimelyCase, ThatFitsIsThatOfTheShapeAndSaysHowLongItTakes) {
  const Timely any = timely({.sites = 20, .minutes = 0, .threads = 2});
  const Timely fits = timely({.sites = 20, .minutes = kAnyTime, .threads = 2});
  EXPECT_EQ(fits.c.mesh.patch_spacing, any.c.mesh.patch_spacing);
  EXPECT_EQ(fits.c.campaign.indentation.depth, any.c.campaign.indentation.depth);
  EXPECT_THAT(fits.first.toml, HasSubstr("# Its campaign takes about "));
  EXPECT_THAT(fits.first.remarks.back(), HasSubstr("time: about "));
  EXPECT_THAT(fits.first.remarks.back(), Not(HasSubstr("wanted")));
  EXPECT_THAT(fits.first.remarks.back(), Not(HasSubstr("not refined")));
  EXPECT_TRUE(fits.is_refined());
}

TEST(TimelyCase, WithoutTimeHasTheLargestPatchesOrTheSmallestDepthAndAdmitsThatItDoesNotFit) {
  const Timely hurried = timely({.sites = {}, .minutes = kNoTime, .threads = 2});
  const BodyFile body = read_body_file(test::source_folder() / "data/bodies/pad.off", "");
  const FirstSizes usual = first_sizes(body.surface, find_base(body.surface), 200);
  EXPECT_GT(hurried.c.mesh.patch_spacing, usual.patch_spacing);
  EXPECT_THAT(hurried.first.toml, HasSubstr("would take too long"));
  EXPECT_THAT(hurried.first.remarks.back(), HasSubstr("sites would take longer than"));
  EXPECT_THAT(hurried.first.remarks.back(), HasSubstr("more than the"));
}

TEST(TimelyCase, KeepsTheSitesThatAreAskedForAndPressesLessDeep) {
  const Timely any = timely({.sites = 20, .minutes = 0, .threads = 2});
  const Timely hurried = timely({.sites = 20, .minutes = kNoTime, .threads = 2});
  EXPECT_EQ(hurried.c.mesh.patch_spacing, any.c.mesh.patch_spacing);
  EXPECT_LT(hurried.depth_over_patch(), 0.7 * any.depth_over_patch());
  EXPECT_GE(hurried.depth_over_patch(), 0.95 * kShallowestOverPatch);
  EXPECT_NEAR(hurried.c.campaign.indentation.lateral_travel,
              hurried.c.campaign.indentation.depth / 2,
              0.05 * hurried.c.campaign.indentation.depth);
  // Elements are refined less where that is faster, and then both places say so.
  EXPECT_EQ(hurried.is_refined(),
            hurried.first.toml.find("and takes too long") == std::string::npos);
  EXPECT_EQ(hurried.is_refined(),
            hurried.first.remarks.back().find("refined under the tool") == std::string::npos);
  EXPECT_THAT(hurried.first.toml, HasSubstr("deeper takes too long"));
  EXPECT_THAT(hurried.first.remarks.back(), HasSubstr("pressed less deep"));
  EXPECT_THAT(hurried.first.remarks.back(), Not(HasSubstr("thin parts")));  // it has none
}

/// What a user loses least by comes first: sites, then accuracy of shallow forces, then depth.
TEST(TimelyCase, SavesTimeWhereTheLossIsLeast) {
  FirstSizes sizes;
  sizes.patch_spacing = 0.01;
  sizes.depth = 0.004;
  EXPECT_EQ(cheapest_saving(sizes, true, true), Saving::LargerPatches);
  EXPECT_EQ(cheapest_saving(sizes, false, true), Saving::OneRefinement);
  EXPECT_EQ(cheapest_saving(sizes, false, false), Saving::SmallerDepth);
  sizes.is_coarsest = true;
  EXPECT_EQ(cheapest_saving(sizes, true, true), Saving::OneRefinement);
  sizes.refinement = Refinement::Once;
  EXPECT_EQ(cheapest_saving(sizes, true, true), Saving::NoRefinement);
  sizes.refinement = Refinement::None;
  EXPECT_EQ(cheapest_saving(sizes, true, true), Saving::SmallerDepth);
  sizes.depth = kShallowestOverPatch * sizes.patch_spacing;
  EXPECT_EQ(cheapest_saving(sizes, true, true), Saving::None);
}

/// An aneurysm whose thin parts have sites once it is pressed less deep: those count, too.
TEST(TimelyCase, CountsTheSitesOfTheDepthThatItChooses) {
  const samples::TemporaryFolder folder;
  const CaseOf of = case_of("tests/data/surfaces/sofa/aneurysm3d_1.off", folder);
  const FirstCase first = timely_case(of, {.sites = 60, .minutes = kNoTime, .threads = 2});
  const Case c = parse_case(first.toml, of.target.string());
  FirstSizes sizes = counted_case(of, 60).sizes;
  ASSERT_LT(c.campaign.indentation.depth, 0.7 * sizes.depth);
  CountedCase counted;
  counted.sizes = sizes;
  counted.sizes.depth = c.campaign.indentation.depth;
  count_sites(of, counted);
  EXPECT_GT(*counted.sizes.sites, *sizes.sites);
  EXPECT_THAT(first.remarks[first.remarks.size() - 2],
              HasSubstr(std::to_string(*counted.sizes.sites)));
}

}  // namespace
}  // namespace palpate::app
