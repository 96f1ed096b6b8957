// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/counted_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "app/pipeline/settings.hpp"
#include "mesher/mesher.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

struct Counted {
  FirstSizes sizes;
  std::string toml, remark;
  std::int64_t sites = 0;  ///< of the body that the case makes
};

Counted counted(const std::string& file, int wanted) {
  const samples::TemporaryFolder folder;
  CaseOf made{read_body_file(test::source_folder() / file, ""), {}, "", folder / "case.toml"};
  made.base = find_base(made.body.surface);
  const CountedCase found = counted_case(made, wanted);
  Counted result{found.sizes, made.with(found.sizes).toml, remark_on_sites(found.sizes, wanted)};
  const Body body = mesher::mesh(mesh_settings(made.opened_with(found.sizes)));
  result.sites = std::count(body.response.is_site.begin(), body.response.is_site.end(), 1);
  return result;
}

// Isotropic remeshing fails on the head, and Delaunay refinement makes twice the vertices that the
// area lets one expect.
TEST(CountedCase, MakesAboutTheSitesThatAreWanted) {
  for (const char* file : {"data/bodies/sofa/liver.obj", "tests/data/surfaces/sofa/tongue.obj"}) {
    const Counted made = counted(file, 150);
    EXPECT_NEAR(static_cast<double>(made.sites), 150, 0.3 * 150) << file;
    EXPECT_THAT(made.remark, testing::Eq("sites: " + std::to_string(made.sites)));
  }
  const Counted head = counted("tests/data/surfaces/sofa/head.obj", 300);
  EXPECT_NEAR(static_cast<double>(head.sites), 300, 0.3 * 300);
}

/// The mesher refuses the elements that belong to 200 sites: they cut the bends short.
TEST(CountedCase, TriesSmallerPatchesWhereTheMesherRefusesTheBody) {
  const Counted snake = counted("tests/data/surfaces/sofa/snake_body.obj", 200);
  EXPECT_GT(snake.sites, 220);
  EXPECT_LT(snake.sites, 400);
}

TEST(CountedCase, SaysHowManySitesThereAreWhereFewerAreImpossible) {
  const Counted head = counted("tests/data/surfaces/sofa/head.obj", 12);
  EXPECT_GT(head.sites, 24);
  EXPECT_THAT(head.toml,
              testing::HasSubstr("shows the shape: " + std::to_string(head.sites) + " sites"));
  EXPECT_THAT(head.remark, testing::HasSubstr("sites: " + std::to_string(head.sites) +
                                              " instead of 12: larger"));
}

}  // namespace
}  // namespace palpate::app
