// SPDX-License-Identifier: AGPL-3.0-or-later
// The campaign against one site after another by Newton's method with a Cholesky factorization of
// the whole body: same body, sites, increments, predictor, tolerance and BLAS kernel, one run, one
// thread.
//
// Usage: bench_precompute [NODES...] with NODES among 8 and 26 (thousand); both without.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "fem/cholesky.hpp"
#include "fem/indentation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// 60 x 60 x 30 mm with its base held, cells as cubes: 12 cells an edge make 8 125 quadratic nodes,
/// 18 make 26 011.
Body block(int cells) {
  return test::make_block(test::even(-0.03, 0.03, cells), test::even(-0.03, 0.03, cells),
                          test::even(-0.03, 0, cells / 2));
}

CampaignSettings settings(double poisson) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, poisson}}};
  s.indentation.tool_radius = 0.005;
  s.indentation.depth = 0.004;
  s.indentation.increments = 10;
  s.indentation.held_depths.clear();
  s.threads = 1;
  return s;
}

/// Sites at least 15 mm from the rim.
std::vector<std::int32_t> inner_sites(const Body& body, std::size_t count) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.node.size() && sites.size() < count; ++v) {
    const Vec3& X = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    if (std::max(std::abs(X[0]), std::abs(X[1])) < 0.0151)
      sites.push_back(static_cast<std::int32_t>(v));
  }
  return sites;
}

double last_force(const SiteCurves& site) {
  return norm(site.paths.front().samples.back().force);
}

/// Largest difference of the force anywhere on the path, over the force at its end.
double error(const SiteCurves& site, const SiteCurves& reference) {
  double worst = 0;
  const auto &a = site.paths.front().samples, &b = reference.paths.front().samples;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, norm(a[i].force - b[i].force));
  return a.size() == b.size() ? worst / last_force(reference) : 1;
}

SiteCurves direct(const Body& body, CampaignSettings s, double tolerance, std::int32_t vertex) {
  s.indentation.force_tolerance = tolerance;
  const CampaignContext context(body, s, Engine::Direct);
  return solve_site(context, vertex, nullptr);
}

void compare(int cells, double poisson) {
  const Body body = block(cells);
  CampaignSettings s = settings(poisson);
  s.sites = inner_sites(body, 16);
  CampaignReport report;
  const Curves curves = run_campaign(body, s, report);

  const std::size_t middle = s.sites.size() / 2;
  const SiteCurves newton = direct(body, s, 1e-4, s.sites[middle]);
  const SiteCurves reference = direct(body, s, 1e-8, s.sites[middle]);
  const SiteCurves& ours = curves.sites[middle];
  const double mean = report.cpu_seconds / static_cast<double>(s.sites.size());
  std::printf("| %lld | %.2f | %.2f s | %.1e | %.3f s | %.1e | %.0f | %.4f N |\n",
              static_cast<long long>(report.unknowns / 3), poisson, newton.cpu_seconds,
              error(newton, reference), mean, error(ours, reference), newton.cpu_seconds / mean,
              last_force(reference));
  std::fflush(stdout);
}

void run(const std::vector<int>& divisions) {
  std::printf(
      "sphere of 5 mm radius to 4 mm, 10 increments, frictionless; 16 sites; BLAS kernel %s\n"
      "| free nodes | nu | Newton, a site | its error | campaign, a site | its error | ratio | "
      "force "
      "|\n|---|---|---|---|---|---|---|---|\n",
      blas_kernel().c_str());
  for (const int cells : divisions)
    for (const double poisson : {0.45, 0.49}) compare(cells, poisson);
}

}  // namespace
}  // namespace palpate::fem

int main(int count, char** arguments) {
  std::vector<int> divisions;
  for (int i = 1; i < count; ++i) divisions.push_back(std::string(arguments[i]) == "8" ? 12 : 18);
  if (divisions.empty()) divisions = {12, 18};
  palpate::fem::run(divisions);
}
