// SPDX-License-Identifier: AGPL-3.0-or-later
// What a site costs at a given error of its force, on the block and with the presses on which
// other programs have been timed: 60 x 60 x 30 mm, E = 10 kPa, nu = 0.49, base held, 10 increments.
// Errors are those at points between nodes, against a mesh refined to 1 mm about each of them.
//
// Usage: bench_peers [CELLS...]     cells an edge; without any 8 12 19
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include "app/blas_kernel.hpp"
#include "fem/campaign/campaign.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kHalf = 0.03;
constexpr std::size_t kTimed = 16, kJudged = 4;

struct Press {
  const char* name;
  CampaignSettings settings;
};

Press disc() {
  Press press{"stuck disc, r = 3 mm, to 3 mm", {}};
  press.settings.indentation.tool = {ToolShape::Disc, 0.003, 0, 0};
  press.settings.indentation.friction = ToolFriction::NoSlip;
  press.settings.indentation.depth = 0.003;
  return press;
}

Press sphere() {
  Press press{"frictionless sphere, R = 5 mm, to 4 mm", {}};
  press.settings.indentation.tool.radius = 0.005;
  press.settings.indentation.depth = 0.004;
  return press;
}

/// The same points for every mesh, at least 15 mm from the rim.
std::vector<PressPoint> points(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> across(-0.015, 0.015);
  std::vector<PressPoint> points(count);
  for (PressPoint& point : points) {
    const double x = across(random), y = across(random);
    point = {{x, y, 0}, {0, 0, -1}};
  }
  return points;
}

/// Cells of 1 mm about `centre`, growing outwards, that end at -half and half.
std::vector<double> refined_about(double centre) {
  std::vector<double> lines{-kHalf};
  for (const double offset : test::graded(2 * kHalf, 0.006, 0.001, 1.8)) {
    const double x = centre + offset, cell = 0.4 * std::max(0.001, 0.4 * std::abs(offset));
    if (x > lines.back() + cell && x < kHalf - cell) lines.push_back(x);
  }
  lines.push_back(kHalf);
  return lines;
}

Body refined(const PressPoint& point) {
  std::vector<double> down{-kHalf};
  for (const double z : refined_about(0))
    if (z > -kHalf && z <= 0) down.push_back(z);
  return test::make_block(refined_about(point.position[0]), refined_about(point.position[1]), down);
}

double last_force(const SiteCurves& site) {
  return norm(site.paths.front().samples.back().force);
}

/// The errors of the meshes are 2e-3 to 0.3; CalculiX stops at residuals of 5e-3 of the mean force
/// and FEBio at 1e-3 of the displacements unless told otherwise.
constexpr double kForceTolerance = 1e-3;

CampaignSettings with(const Press& press, std::vector<PressPoint> where, bool divided,
                      bool lateral) {
  CampaignSettings s = press.settings;
  s.materials = {{"tissue", {10e3, 0.49}}};
  s.indentation.increments = 10;
  s.indentation.refine_under_tool = divided;
  s.indentation.force_tolerance = kForceTolerance;
  s.indentation.lateral_depths.clear();
  if (lateral) s.indentation.lateral_depths = {0.002};
  s.points = std::move(where);
  return s;
}

std::vector<double> reference_forces(const Press& press) {
  std::vector<double> forces;
  for (const PressPoint& point : points(kJudged)) {
    CampaignReport report;
    const Curves curves = run_campaign(refined(point), with(press, {point}, false, false), report);
    forces.push_back(last_force(curves.sites.front()));
    std::printf("| %s | %lld | 1 mm | | | | %.4f N |\n", press.name,
                static_cast<long long>(report.unknowns / 3), forces.back());
    std::fflush(stdout);
  }
  return forces;
}

/// Processor time, s: of a site, and of what is done once for all sites of a body.
struct Cost {
  double site, set_up;
};

Cost cost(const Body& body, const Press& press, bool divided, bool lateral, Curves& curves) {
  CampaignReport report;
  const std::clock_t start = std::clock();
  curves = run_campaign(body, with(press, points(kTimed), divided, lateral), report);
  const double all = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return {report.cpu_seconds / static_cast<double>(kTimed), all - report.cpu_seconds};
}

void row(const Body& body, int cells, const Press& press, bool divided,
         const std::vector<double>& exact) {
  Curves curves;
  const Cost normal = cost(body, press, divided, false, curves);
  double worst = 0, mean = 0, force = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = std::abs(last_force(curves.sites[i]) / exact[i] - 1);
    worst = std::max(worst, error);
    mean += error / static_cast<double>(exact.size());
    force += last_force(curves.sites[i]) / static_cast<double>(exact.size());
  }
  const Cost both = cost(body, press, divided, true, curves);
  const int per_edge = 2 * cells + 1;
  std::printf(
      "| %s | %d | %.2f mm%s | %.3f s | %.3f s | %.1f s | %.4f N, off by %.1f %% (worst %.1f %%) "
      "|\n",
      press.name, per_edge * per_edge * (cells + 1), 1e3 * 2 * kHalf / cells,
      divided ? ", halved under the tool" : "", normal.site, both.site, normal.set_up, force,
      100 * mean, 100 * worst);
  std::fflush(stdout);
}

void run(const std::vector<int>& meshes) {
  std::printf(
      "%zu sites, one thread, processor time\n"
      "| press | nodes | facets | a site, normal path | and a lateral one | set-up, once | "
      "force at the end, mean |\n|---|---|---|---|---|---|---|\n",
      kTimed);
  for (const Press& press : {disc(), sphere()}) {
    const std::vector<double> exact = reference_forces(press);
    for (const int cells : meshes) {
      const Body body =
          test::make_block(test::even(-kHalf, kHalf, cells), test::even(-kHalf, kHalf, cells),
                           test::even(-kHalf, 0, cells / 2));
      for (const bool divided : {false, true}) row(body, cells, press, divided, exact);
    }
  }
}

}  // namespace
}  // namespace palpate::fem

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  std::vector<int> cells;
  for (int i = 1; i < count; ++i) cells.push_back(std::atoi(arguments[i]));
  palpate::fem::run(cells.empty() ? std::vector<int>{8, 12, 19} : cells);
}
