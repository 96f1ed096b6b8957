// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/counted_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "app/case/case.hpp"
#include "app/pipeline/settings.hpp"
#include "format/error.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {
namespace {

constexpr int kMostTrials = 5;
constexpr double kNearEnough = 0.1;  ///< of the wanted number of sites
constexpr double kWorthSaying = 0.3;
/// More sites where the mesher refuses a body, and how often: its elements may be too large for a
/// thin part or a bend.
constexpr double kFinerWhereRefused = 1.5;
constexpr int kMostFiner = 2;

double distance(std::int64_t sites, int wanted) {
  return std::abs(static_cast<double>(sites) / wanted - 1);
}

}  // namespace

FirstCase CaseOf::with(const FirstSizes& sizes) const {
  const std::string file =
      std::filesystem::proximate(body.path, std::filesystem::absolute(target).parent_path())
          .generic_string();
  return first_case(body, base, sizes, file, name);
}

Workspace CaseOf::opened_with(const FirstSizes& sizes) const {
  Workspace space;
  space.c = parse_case(with(sizes).toml, target.string());
  space.case_folder = std::filesystem::absolute(target).parent_path();
  return space;
}

void count_sites(const CaseOf& made, CountedCase& counted) {
  counted.body = mesher::mesh(mesh_settings(made.opened_with(counted.sizes)));
  const auto& is_site = counted.body->response.is_site;
  counted.sizes.sites = std::count(is_site.begin(), is_site.end(), 1);
}

CountedCase counted_case(const CaseOf& made, int wanted) {
  CountedCase best, refused;
  int refusals = 0;
  double asked = wanted, last_spacing = 0;
  double fewer = 0, more = 0;  // what was asked for where that many were made
  for (int i = 0; i < kMostTrials; ++i) {
    CountedCase trial;
    trial.sizes =
        first_sizes(made.body.surface, made.base,
                    std::max(1, static_cast<int>(asked * made.body.area_excess)), made.body.inward);
    if (trial.sizes.patch_spacing == last_spacing) break;
    last_spacing = trial.sizes.patch_spacing;
    try {
      count_sites(made, trial);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::Configuration) throw;
      if (best.body) break;
      trial.refusal = fmt::format("{}; {}", error.problem(), error.remedy());
      if (refusals == 0) refused = std::move(trial);
      if (++refusals > kMostFiner) break;
      asked *= kFinerWhereRefused;
      continue;
    }
    const std::int64_t made_sites = std::max<std::int64_t>(1, *trial.sizes.sites);
    (made_sites < wanted ? fewer : more) = asked;
    asked = fewer > 0 && more > 0 ? std::sqrt(fewer * more)
                                  : asked * wanted / static_cast<double>(made_sites);
    if (!best.body || distance(*trial.sizes.sites, wanted) < distance(*best.sizes.sites, wanted))
      best = std::move(trial);
    if (distance(*best.sizes.sites, wanted) <= kNearEnough) break;
  }
  return best.body ? std::move(best) : std::move(refused);
}

std::string remark_on_sites(const FirstSizes& sizes, int wanted) {
  std::string said = fmt::format("sites: {}", *sizes.sites);
  if (distance(*sizes.sites, wanted) <= kWorthSaying) return said;
  said += fmt::format(" instead of {}", wanted);
  if (*sizes.sites > wanted && (sizes.is_coarsest || sizes.is_thin))
    said += ": larger patches would not show the shape";
  return said;
}

}  // namespace palpate::app
