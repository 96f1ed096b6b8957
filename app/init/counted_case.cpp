// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/counted_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "app/case/case.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/error.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {
namespace {

constexpr int kMostTrials = 5;
constexpr double kNearEnough = 0.1;  ///< of the wanted number of sites
constexpr double kWorthSaying = 0.3;

double distance(std::int64_t sites, int wanted) {
  return std::abs(static_cast<double>(sites) / wanted - 1);
}

std::int64_t count_sites(const FirstCase& first, const std::filesystem::path& target) {
  Workspace space;
  space.c = parse_case(first.toml, target.string());
  space.case_folder = std::filesystem::absolute(target).parent_path();
  const Body body = mesher::mesh(mesh_settings(space));
  return std::count(body.response.is_site.begin(), body.response.is_site.end(), 1);
}

std::string remark_on(std::int64_t sites, int wanted, const FirstSizes& sizes) {
  std::string said = fmt::format("sites: {}", sites);
  if (distance(sites, wanted) <= kWorthSaying) return said;
  said += fmt::format(" instead of {}", wanted);
  if (sites > wanted && (sizes.is_coarsest || sizes.is_thin))
    said += ": larger patches would not show the shape";
  return said;
}

}  // namespace

FirstCase counted_case(const BodyFile& body, const Base& base, int wanted, const std::string& name,
                       const std::filesystem::path& target) {
  const std::string file =
      std::filesystem::proximate(body.path, std::filesystem::absolute(target).parent_path())
          .generic_string();
  const auto made = [&](const FirstSizes& sizes) {
    return first_case(body, base, sizes, file, name);
  };
  FirstSizes best;
  double asked = wanted, last_spacing = 0;
  for (int i = 0; i < kMostTrials; ++i) {
    FirstSizes sizes =
        first_sizes(body.surface, base, std::max(1, static_cast<int>(asked * body.area_excess)));
    if (sizes.patch_spacing == last_spacing) break;
    last_spacing = sizes.patch_spacing;
    try {
      sizes.sites = count_sites(made(sizes), target);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::Configuration) throw;
      if (best.sites) break;
      FirstCase first = made(sizes);
      first.remarks.push_back("`palpate mesh` refuses the body: " + error.problem());
      return first;
    }
    if (!best.sites || distance(*sizes.sites, wanted) < distance(*best.sites, wanted)) best = sizes;
    if (distance(*best.sites, wanted) <= kNearEnough) break;
    asked *= wanted / static_cast<double>(std::max<std::int64_t>(1, *sizes.sites));
  }
  FirstCase first = made(best);
  first.remarks.push_back(remark_on(*best.sites, wanted, best));
  return first;
}

}  // namespace palpate::app
