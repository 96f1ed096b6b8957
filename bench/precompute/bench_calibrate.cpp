// SPDX-License-Identifier: AGPL-3.0-or-later
// What one step of a calibration costs: forces of all sites and their derivatives by each constant,
// by the adjoint and by differences, in one run on one thread, in processor time.
//
// Usage: bench_calibrate [CELLS [SITES]]   a block of two layers, cells an edge (default 12 and 8)
//
// The constants are the Young's moduli and Poisson's ratios of the two layers. Differences press
// the same sites to the same depths once more for each constant (twice for central ones), as
// tightly as they need: at the tolerance of a campaign they would be noise. `campaign` is the
// normal paths with twelve increments, without derivatives. The last lines repeat the adjoint with
// other constants and the factor of the first.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "app/blas_kernel.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/campaign/campaign_cache.hpp"
#include "fem/campaign/sensitivity.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kDepth = 0.004;  // m
// Steps of the differences: of a modulus, and of 1/2 less the Poisson's ratio.
constexpr double kStep = 1e-3, kPoissonStep = 4e-3;

/// 60 x 60 x 30 mm with its base fixed, the lower half a region of its own.
Body layered(int cells) {
  Body body = test::make_block(test::even(-0.03, 0.03, cells), test::even(-0.03, 0.03, cells),
                               test::even(-0.03, 0, cells / 2));
  body.region_names = {"top", "base"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double z = 0;
    for (const std::int32_t n : body.tetrahedra[t])
      z += 0.25 * body.nodes[static_cast<std::size_t>(n)][2];
    body.tetrahedron_region[t] = z < -0.015 ? 1 : 0;
  }
  return body;
}

struct Constants {
  double top = 8e3, base = 20e3, top_poisson = 0.45, base_poisson = 0.45;
};

CampaignSettings settings_of(const Body& body, const Constants& c, std::size_t sites) {
  CampaignSettings s;
  s.materials = {{"top", {c.top, c.top_poisson}}, {"base", {c.base, c.base_poisson}}};
  s.indentation.tool.radius = 0.005;
  s.indentation.depth = kDepth;
  s.indentation.lateral_depths.clear();
  s.indentation.azimuths.clear();
  s.threads = 1;
  for (std::size_t v = 0; v < body.response.node.size() && s.sites.size() < sites; ++v) {
    const Vec3& X = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    if (body.response.is_site[v] != 0 && std::max(std::abs(X[0]), std::abs(X[1])) < 0.0151)
      s.sites.push_back(static_cast<std::int32_t>(v));
  }
  return s;
}

/// Processor time: other work on the machine does not count.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double seconds(Work&& work) {
  const double start = processor_time();
  work();
  return processor_time() - start;
}

using Sites = std::vector<SiteSensitivity>;

/// The slope of the last sample of a site by differences of two runs.
double quotient(const Sites& high, const Sites& low, std::size_t site, double width) {
  return (high[site].samples.back().force - low[site].samples.back().force) / width;
}

/// One campaign whose derivatives are computed by the adjoint and by differences.
struct Problem {
  Body body;
  Constants middle;
  CampaignSettings settings;
  std::vector<double> depths{kDepth / 4, kDepth / 2, 3 * kDepth / 4, kDepth};
  std::vector<RegionConstant> constants{
      {"top", "young"}, {"base", "young"}, {"top", "poisson"}, {"base", "poisson"}};

  /// The settings with other constants.
  CampaignSettings with(CampaignSettings changed, const Constants& c) const {
    changed.materials = settings_of(body, c, 0).materials;
    return changed;
  }
  Sites adjoint(const CampaignSettings& s, CampaignCache& cache) const {
    return run_sensitivity(body, s, depths, constants, {}, &cache);
  }
};

void print_time(const char* what, double spent, double campaign) {
  std::printf("%-52s %8.2f s %6.2f of a campaign\n", what, spent, spent / campaign);
}

/// Forces above and below each constant by a small step, and the processor time they take.
struct Differences {
  std::vector<Sites> high, low;
  std::vector<double> width;
  double one_sided_s, central_s;
};

Differences differences(const Problem& problem, const CampaignSettings& tight) {
  const Constants& middle = problem.middle;
  const auto forces = [&](const Constants& c) {
    return run_sensitivity(problem.body, problem.with(tight, c), problem.depths, {});
  };
  Differences found{};
  std::vector<Constants> more(4, middle), less(4, middle);
  const auto vary = [&](std::size_t i, double Constants::*member, double step) {
    more[i].*member += step;
    less[i].*member -= step;
    found.width.push_back(2 * step);
  };
  vary(0, &Constants::top, kStep * middle.top);
  vary(1, &Constants::base, kStep * middle.base);
  vary(2, &Constants::top_poisson, kPoissonStep * (0.5 - middle.top_poisson));
  vary(3, &Constants::base_poisson, kPoissonStep * (0.5 - middle.base_poisson));
  found.one_sided_s = seconds([&] {
    forces(middle);
    for (const Constants& c : more) found.high.push_back(forces(c));
  });
  found.central_s = found.one_sided_s + seconds([&] {
                      for (const Constants& c : less) found.low.push_back(forces(c));
                    });
  return found;
}

/// At one tolerance the adjoint and the differences are the same derivatives.
void print_errors(const Problem& problem, const Differences& by_steps, const Sites& exact,
                  const Sites& adjoint) {
  for (std::size_t c = 0; c < problem.constants.size(); ++c) {
    double largest = 0, tightly = 0, loosely = 0;
    for (std::size_t s = 0; s < exact.size(); ++s) {
      const double slope = exact[s].samples.back().slope[c];
      const double by_step = quotient(by_steps.high[c], by_steps.low[c], s, by_steps.width[c]);
      largest = std::max(largest, std::abs(slope));
      tightly = std::max(tightly, std::abs(slope - by_step));
      loosely = std::max(loosely, std::abs(slope - adjoint[s].samples.back().slope[c]));
    }
    std::printf(
        "  %s of %s: central differences within %.1e of the adjoint, that at the tolerance "
        "of a campaign within %.1e\n",
        problem.constants[c].name.c_str(), problem.constants[c].region.c_str(), tightly / largest,
        loosely / largest);
  }
}

void run(int cells, std::size_t sites) {
  Problem problem;
  problem.body = layered(cells);
  problem.settings = settings_of(problem.body, problem.middle, sites);
  std::printf("%zu sites, %zu depths, %zu constants\n", problem.settings.sites.size(),
              problem.depths.size(), problem.constants.size());

  CampaignReport report;
  const double campaign = seconds([&] { run_campaign(problem.body, problem.settings, report); });
  std::printf("%-52s %8.2f s   1.00\n", "campaign", campaign);

  CampaignCache cache;
  Sites adjoint;
  const double by_adjoint = seconds([&] { adjoint = problem.adjoint(problem.settings, cache); });
  print_time("forces and derivatives, adjoint", by_adjoint, campaign);

  CampaignSettings tight = problem.settings;
  tight.indentation.force_tolerance = 1e-7;
  const Differences by_steps = differences(problem, tight);
  print_time("the same by one-sided differences", by_steps.one_sided_s, campaign);
  print_time("the same by central differences", by_steps.central_s, campaign);
  std::printf("differences over adjoint: %.1f one-sided, %.1f central\n",
              by_steps.one_sided_s / by_adjoint, by_steps.central_s / by_adjoint);
  print_errors(problem, by_steps, problem.adjoint(tight, cache), adjoint);

  const auto again = [&](const char* what, const Constants& c) {
    const CampaignSettings s = problem.with(problem.settings, c);
    const int before = cache.factors.factorizations();
    print_time(what, seconds([&] { problem.adjoint(s, cache); }), campaign);
    std::printf("  (%d factorization%s)\n", cache.factors.factorizations() - before,
                cache.factors.factorizations() - before == 1 ? "" : "s");
  };
  const Constants& middle = problem.middle;
  again("adjoint again, all moduli half as large again", {1.5 * middle.top, 1.5 * middle.base});
  again("adjoint again, one modulus by a tenth", {1.65 * middle.top, 1.5 * middle.base});
  again("adjoint again, Poisson's ratios 0.49", {middle.top, middle.base, 0.49, 0.49});
}

}  // namespace
}  // namespace palpate::fem

int main(int argc, char** argv) {
  palpate::app::ensure_blas_kernel(argv);
  const int cells = argc > 1 ? std::atoi(argv[1]) : 12;
  const int sites = argc > 2 ? std::atoi(argv[2]) : 8;
  if (cells < 2 || sites < 1) {
    std::fprintf(stderr, "usage: bench_calibrate [CELLS [SITES]]\n");
    return 2;
  }
  palpate::fem::run(cells, static_cast<std::size_t>(sites));
  return 0;
}
