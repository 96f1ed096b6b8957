// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/counted_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "app/case/case.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "mesher/mesher.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

struct Counted {
  FirstCase first;
  std::int64_t sites = 0;  ///< of the body that the case makes
};

Counted counted(const std::string& file, int wanted) {
  const samples::TemporaryFolder folder;
  const std::filesystem::path target = folder / "case.toml";
  const BodyFile body = read_body_file(test::source_folder() / file, "");
  Counted result{counted_case(body, find_base(body.surface), wanted, "", target)};
  Workspace space;
  space.c = parse_case(result.first.toml, target.string());
  space.case_folder = target.parent_path();
  const Body made = mesher::mesh(mesh_settings(space));
  result.sites = std::count(made.response.is_site.begin(), made.response.is_site.end(), 1);
  return result;
}

// Isotropic remeshing fails on the head, and Delaunay refinement makes twice the vertices that the
// area lets one expect.
TEST(CountedCase, MakesAboutTheSitesThatAreWanted) {
  for (const char* file : {"data/bodies/sofa/liver.obj", "tests/data/surfaces/sofa/tongue.obj"}) {
    const Counted made = counted(file, 150);
    EXPECT_NEAR(static_cast<double>(made.sites), 150, 0.3 * 150) << file;
    EXPECT_THAT(made.first.remarks.back(), testing::Eq("sites: " + std::to_string(made.sites)));
  }
  const Counted head = counted("tests/data/surfaces/sofa/head.obj", 300);
  EXPECT_NEAR(static_cast<double>(head.sites), 300, 0.3 * 300);
}

TEST(CountedCase, SaysHowManySitesThereAreWhereFewerAreImpossible) {
  const Counted head = counted("tests/data/surfaces/sofa/head.obj", 12);
  EXPECT_GT(head.sites, 24);
  EXPECT_THAT(head.first.toml,
              testing::HasSubstr("shows the shape: " + std::to_string(head.sites) + " sites"));
  EXPECT_THAT(head.first.remarks.back(), testing::HasSubstr("sites: " + std::to_string(head.sites) +
                                                            " instead of 12: larger"));
}

}  // namespace
}  // namespace palpate::app
