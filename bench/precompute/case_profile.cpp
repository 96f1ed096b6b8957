// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the processor time of the sites of a case goes.
//
// Usage: bench_case_profile CASE BODY [SITES]
//   SITES (16) sites, evenly spread over those of the body.h5 of the case, are pressed by one
//   thread.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "bench/precompute/guarded.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/solve/profile.hpp"
#include "format/body.hpp"

namespace palpate {
namespace {

std::vector<std::int32_t> spread_sites(const Body& body, std::size_t count) {
  std::vector<std::int32_t> all, some;
  for (std::size_t v = 0; v < body.response.node.size(); ++v)
    if (body.response.is_site[v] != 0) all.push_back(static_cast<std::int32_t>(v));
  for (std::size_t i = 0; i < count && i < all.size(); ++i)
    some.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
  return some;
}

void print_forces(const Curves& curves) {
  for (const SiteCurves& site : curves.sites) {
    std::printf("%d %.2f s", site.vertex, site.cpu_seconds);
    for (const CurvePath& path : site.paths)
      std::printf("  %zu: %.9g N, %d iterations", path.samples.size(),
                  norm(path.samples.back().force), [&] {
                    int sum = 0;
                    for (const CurveSample& sample : path.samples) sum += sample.iterations;
                    return sum;
                  }());
    std::printf("\n");
  }
}

void profile(const std::string& case_file, const std::string& body_file, std::size_t count) {
  const Body body = read_body(body_file);
  fem::CampaignSettings s =
      app::campaign_settings(app::make_workspace(case_file, "", 1, app::SizeOfBody{}));
  s.sites = spread_sites(body, count);
  s.threads = 1;
  fem::Profile spent;
  fem::active_profile = &spent;
  fem::CampaignReport report;
  const Curves curves = fem::run_campaign(body, s, report);
  fem::active_profile = nullptr;
  print_forces(curves);
  const auto sites = static_cast<double>(s.sites.size());
  std::printf("\n| part | a site | | times |\n|---|---|---|---|\n");
  double sum = 0;
  for (std::size_t p = 0; p < fem::kParts; ++p) {
    const auto part = static_cast<fem::Part>(p);
    sum += spent.seconds(part);
    std::printf("| %s | %.1f ms | %.1f %% | %.1f |\n", fem::name_of(part),
                1e3 * spent.seconds(part) / sites, 100 * spent.seconds(part) / report.cpu_seconds,
                static_cast<double>(spent.times(part)) / sites);
  }
  std::printf("| sum of the parts | %.1f ms | %.1f %% | |\n| all | %.1f ms | | |\n",
              1e3 * sum / sites, 100 * sum / report.cpu_seconds, 1e3 * report.cpu_seconds / sites);
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  const std::size_t sites = count == 4 ? std::strtoul(arguments[3], nullptr, 10) : 16;
  if (count < 3 || count > 4 || sites == 0) {
    std::fputs("usage: bench_case_profile CASE BODY [SITES]\n", stderr);
    return 2;
  }
  palpate::app::ensure_blas_kernel(arguments);
  return palpate::guarded([&] { palpate::profile(arguments[1], arguments[2], sites); });
}
