// SPDX-License-Identifier: AGPL-3.0-or-later
// The cost of a site on blocks of tissue pressed by a sphere. Each part is one run on one machine;
// only ratios within a part are meaningful.
//
// Usage: bench_precompute PART
//   newton [8|26]       against one site after another by Newton's method with a Cholesky
//                       factorization of the whole body: same body, sites, increments, predictor,
//                       tolerance and BLAS kernel, one thread
//   errors [CELLS...]   of the force against the tolerance asked for
//   growth [CELLS...]   time and memory against the size of the mesh, cells an edge
//   poisson [CELLS...]  time and error near nu = 1/2, with and without refined elements
//   elements [CELLS...] constant, nodal and no pressures
//   contact [CELLS]     forces on elements as large as the tool that are refined, or not
//   profile [CELLS...]  parts of the processor time of a site, with and without refined elements
//   sites               time against the number of sites
//   threads [SITES...]  one thread against two
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "app/blas_kernel.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/solve/profile.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// 60 x 60 x 30 mm with its base fixed, cells as cubes: 12 cells an edge make 8 125 quadratic
/// nodes, 18 make 26 011.
Body block(int cells) {
  return test::make_block(test::even(-0.03, 0.03, cells), test::even(-0.03, 0.03, cells),
                          test::even(-0.03, 0, cells / 2));
}

CampaignSettings settings(double poisson) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, poisson}}};
  s.indentation.tool.radius = 0.005;
  s.indentation.depth = 0.004;
  s.indentation.increments = 10;
  s.indentation.lateral_depths.clear();
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

/// Largest difference of the force anywhere on a path, over the force there.
double error(const CurvePath& path, const CurvePath& reference) {
  if (path.samples.size() != reference.samples.size()) return 1;
  double worst = 0;
  for (std::size_t i = 0; i < path.samples.size(); ++i) {
    const Vec3 &ours = path.samples[i].force, &exact = reference.samples[i].force;
    if (norm(exact) > 0) worst = std::max(worst, norm(ours - exact) / norm(exact));
  }
  return worst;
}

/// The largest of all sites: on the normal path and on the lateral one.
std::array<double, 2> errors(const Curves& curves, const Curves& reference) {
  std::array<double, 2> worst{};
  for (std::size_t i = 0; i < reference.sites.size(); ++i)
    for (std::size_t p = 0; p < worst.size(); ++p)
      worst[p] =
          std::max(worst[p], error(curves.sites[i].paths.at(p), reference.sites[i].paths.at(p)));
  return worst;
}

SiteCurves direct(const Body& body, CampaignSettings s, double tolerance, std::int32_t vertex) {
  s.indentation.force_tolerance = tolerance;
  const CampaignContext context(body, s, Engine::Direct);
  return solve_site(context, vertex, nullptr);
}

std::string fact(const CampaignReport& report, const std::string& name) {
  for (const auto& [key, value] : report.facts)
    if (key == name) return value;
  return {};
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
              error(newton.paths.front(), reference.paths.front()), mean,
              error(ours.paths.front(), reference.paths.front()), newton.cpu_seconds / mean,
              last_force(reference));
  std::fflush(stdout);
}

void against_newton(const std::vector<int>& cells) {
  std::printf(
      "sphere of 5 mm radius to 4 mm, 10 increments, frictionless; 16 sites; BLAS kernel %s\n"
      "| free nodes | nu | Newton, a site | its error | campaign, a site | its error | ratio | "
      "force "
      "|\n|---|---|---|---|---|---|---|---|\n",
      blas_kernel().c_str());
  for (const int each : cells)
    for (const double poisson : {0.45, 0.49}) compare(each, poisson);
}

/// How a block is pressed.
struct Press {
  const char* name;
  ToolShape shape;
  ToolFriction friction;
  bool refined;
};

constexpr Press kPresses[] = {
    {"sphere", ToolShape::Sphere, ToolFriction::Frictionless, false},
    {"sphere, refined elements", ToolShape::Sphere, ToolFriction::Frictionless, true},
    {"no-slip sphere", ToolShape::Sphere, ToolFriction::NoSlip, false},
    {"no-slip disc", ToolShape::Disc, ToolFriction::NoSlip, false},
};

/// Errors at several force tolerances, against a very small one.
void against_tolerance(int cells, const Press& press) {
  const Body body = block(cells);
  CampaignSettings s = settings(0.45);
  s.indentation.tool.shape = press.shape;
  s.indentation.friction = press.friction;
  s.indentation.refine_under_tool = press.refined ? 1 : 0;
  s.indentation.lateral_depths = {0.002};
  s.sites = inner_sites(body, 16);
  s.indentation.force_tolerance = 1e-8;
  CampaignReport report;
  const Curves exact = run_campaign(body, s, report);
  const double exact_seconds = report.cpu_seconds;
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    s.indentation.force_tolerance = tolerance;
    report = {};
    const auto [normal, lateral] = errors(run_campaign(body, s, report), exact);
    std::printf("| %lld | %s | %.0e | %.2f | %.1e | %.1e |\n",
                static_cast<long long>(report.unknowns / 3), press.name, tolerance,
                report.cpu_seconds / exact_seconds, normal, lateral);
    std::fflush(stdout);
  }
}

void against_tolerance(const std::vector<int>& cells) {
  std::printf(
      "nu = 0.45, normal path to 4 mm and lateral path of 3 mm; processor time over that of a "
      "tolerance of 1e-8, and largest error of 16 sites against it\n"
      "| free nodes | tool | tolerance | time | normal path | lateral path |\n"
      "|---|---|---|---|---|---|\n");
  for (const int each : cells)
    for (const Press& press : kPresses) against_tolerance(each, press);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1e-3 * static_cast<double>(usage.ru_maxrss);
}

/// Points on the upper face, at least a quarter of it from its border; evenly spread, however many
/// (the sequence of the plastic number, M. Roberts 2018).
std::vector<PressPoint> spread_points(std::size_t count) {
  const auto coordinate = [](double step, std::size_t i) {
    return 0.03 * (std::fmod(0.5 + step * static_cast<double>(i), 1.0) - 0.5);
  };
  std::vector<PressPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(
        {{coordinate(0.7548776662466927, i), coordinate(0.5698402909980532, i), 0}, {0, 0, -1}});
  return points;
}

/// Normal and lateral path of each site. @return seconds on the clock.
double campaign_seconds(const Body& body, std::size_t sites, int threads, CampaignReport& report) {
  CampaignSettings s = settings(0.49);
  s.indentation.lateral_depths = {0.002};
  s.threads = threads;
  s.points = spread_points(sites);
  run_campaign(body, s, report);
  return report.seconds;
}

/// Peaks of memory are those of the process: from the smallest mesh to the largest.
void growth(const std::vector<int>& cells) {
  std::printf(
      "normal path to 4 mm and lateral path of 3 mm, nu = 0.49, 16 sites, one thread\n"
      "| nodes | processor time, a site | set-up | float factor | peak memory "
      "|\n|---|---|---|---|---|\n");
  for (const int each : cells) {
    const Body body = block(each);
    CampaignReport report;
    campaign_seconds(body, 16, 1, report);
    const int per_edge = 2 * each + 1;
    std::printf("| %d | %.3f s | %.2f s | %.0f MB | %.0f MB |\n", per_edge * per_edge * (each + 1),
                report.cpu_seconds / 16, report.set_up_seconds,
                1e-6 * std::stod(fact(report, "rest_factor_bytes")), peak_megabytes());
    std::fflush(stdout);
  }
}

void against_sites() {
  const Body body = block(18);
  std::printf(
      "26 011 nodes, nu = 0.49, normal and lateral path, one thread\n"
      "| sites | wall time | a site, set-up included |\n|---|---|---|\n");
  for (const std::size_t sites : {1u, 4u, 16u, 64u}) {
    CampaignReport report;
    const double seconds = campaign_seconds(body, sites, 1, report);
    std::printf("| %zu | %.2f s | %.3f s |\n", sites, seconds,
                seconds / static_cast<double>(sites));
    std::fflush(stdout);
  }
}

void against_threads(const std::vector<int>& sites) {
  const Body body = block(18);
  std::printf(
      "26 011 nodes, nu = 0.49, normal and lateral path, BLAS kernel %s\n"
      "| sites | 1 thread | of it set-up | 2 threads | of it set-up | ratio "
      "|\n|---|---|---|---|---|---|\n",
      blas_kernel().c_str());
  CampaignReport report;
  campaign_seconds(body, 16, 2, report);  // memory that the system has yet to find
  for (const int each : sites) {
    const auto count = static_cast<std::size_t>(each);
    const double one = campaign_seconds(body, count, 1, report), one_set_up = report.set_up_seconds;
    const double two = campaign_seconds(body, count, 2, report);
    std::printf("| %d | %.1f s | %.1f s | %.1f s | %.1f s | %.2f |\n", each, one, one_set_up, two,
                report.set_up_seconds, one / two);
    std::fflush(stdout);
  }
}

/// What an element costs: the same sites with each kind of it.
void elements(const std::vector<int>& cells) {
  std::printf(
      "normal path to 4 mm in 10 increments, nu = 0.49, 16 sites, one thread\n"
      "| nodes | element | processor time, a site | over constant pressures | mean force "
      "|\n|---|---|---|---|---|\n");
  for (const int each : cells) {
    const Body body = block(each);
    const int per_edge = 2 * each + 1;
    double constant = 0;
    for (const auto& [dilatation, name] : {std::pair{Dilatation::Mean, "tet10-pressure"},
                                           std::pair{Dilatation::Nodal, "tet10-nodal-pressure"},
                                           std::pair{Dilatation::Pointwise, "tet10-displacement"},
                                           std::pair{Dilatation::LinearNodal, "tet4"}}) {
      CampaignSettings s = settings(0.49);
      s.dilatation = dilatation;
      s.sites = inner_sites(body, 16);
      CampaignReport report;
      const Curves curves = run_campaign(body, s, report);
      double force = 0;
      for (const SiteCurves& site : curves.sites)
        force += last_force(site) / static_cast<double>(curves.sites.size());
      const double each_site = report.cpu_seconds / static_cast<double>(curves.sites.size());
      if (dilatation == Dilatation::Mean) constant = each_site;
      std::printf("| %d | %s | %.3f s | %.2f | %.4f N |\n", per_edge * per_edge * (each + 1), name,
                  each_site, each_site / constant, force);
      std::fflush(stdout);
    }
  }
}

/// A site whose bulk modulus grows: time, solves and error.
void against_poisson(int cells, Dilatation element, bool refined) {
  const Body body = block(cells);
  // Newton's method takes minutes where all nodes around a corner are coupled.
  const int most_cells_of_newton = element == Dilatation::Nodal ? 8 : 12;
  double first = 0;
  for (const double poisson : {0.45, 0.49, 0.499, 0.4999, 0.49999}) {
    CampaignSettings s = settings(poisson);
    s.dilatation = element;
    s.indentation.refine_under_tool = refined ? 1 : 0;
    s.sites = inner_sites(body, 16);
    CampaignReport report;
    const Curves curves = run_campaign(body, s, report);
    const SiteCurves& site = curves.sites[s.sites.size() / 2];
    double solves = 0;
    for (const CurveSample& sample : site.paths.front().samples) solves += sample.iterations;
    const double each = report.cpu_seconds / 16;
    if (first == 0) first = each;
    std::string wrong = "-";
    if (!refined && cells <= most_cells_of_newton) {
      const SiteCurves exact = direct(body, s, 1e-8, s.sites[s.sites.size() / 2]);
      char text[32];
      std::snprintf(text, sizeof text, "%.1e", error(site.paths.front(), exact.paths.front()));
      wrong = text;
    }
    std::printf("| %lld | %s | %s | %.5f | %.3f s | %.2f | %.1f | %s | %.5f N |\n",
                static_cast<long long>(report.unknowns / 3),
                element == Dilatation::Nodal ? "nodal" : "element", refined ? "yes" : "no", poisson,
                each, each / first, solves / static_cast<double>(site.paths.front().samples.size()),
                wrong.c_str(), last_force(site));
    std::fflush(stdout);
  }
}

void against_poisson(const std::vector<int>& cells) {
  std::printf(
      "normal path to 4 mm, 16 sites, one thread\n"
      "| free nodes | pressures | refined | nu | processor time, a site | over nu = 0.45 | solves, "
      "an increment | error | force |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const int each : cells)
    for (const Dilatation element : {Dilatation::Mean, Dilatation::Nodal})
      for (const bool refined : {false, true}) against_poisson(each, element, refined);
}

/// How the elements under the tool are refined, in columns of a table.
constexpr std::array kRefinements{std::pair{0, "undivided"}, std::pair{1, "refined once"},
                                  std::pair{2, "twice"},
                                  std::pair{IndentationSettings::kByContact, "contact"}};

/// The parts of the processor time of the sites, in milliseconds a site, and their sum over it.
void profile(const char* name, const Body& body, CampaignSettings s) {
  std::array<Profile, kRefinements.size()> profiles;
  std::array<double, kRefinements.size()> seconds{}, sum{};
  for (std::size_t i = 0; i < kRefinements.size(); ++i) {
    s.indentation.refine_under_tool = kRefinements.at(i).first;
    active_profile = &profiles.at(i);
    CampaignReport report;
    run_campaign(body, s, report);
    active_profile = nullptr;
    seconds.at(i) = report.cpu_seconds;
  }
  const auto sites = static_cast<double>(s.points.empty() ? s.sites.size() : s.points.size());
  const auto row = [&](const char* part, const auto& of) {
    std::printf("| %s |", part);
    for (std::size_t i = 0; i < kRefinements.size(); ++i)
      std::printf(" %.1f ms | %.1f %% |", 1e3 * of(i) / sites, 100 * of(i) / seconds.at(i));
    std::printf("\n");
  };
  std::printf("\n| %s |", name);
  for (const auto& [levels, title] : kRefinements) std::printf(" %s | |", title);
  std::printf("\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t p = 0; p < kParts; ++p) {
    const auto part = static_cast<Part>(p);
    row(name_of(part), [&](std::size_t i) { return profiles.at(i).seconds(part); });
    for (std::size_t i = 0; i < kRefinements.size(); ++i) sum.at(i) += profiles.at(i).seconds(part);
  }
  row("sum of the parts", [&](std::size_t i) { return sum.at(i); });
  row("all", [&](std::size_t i) { return seconds.at(i); });
  std::printf("| relative to the first |");
  for (const double each : seconds) std::printf(" %.2f | |", each / seconds.front());
  std::printf("\n");
  std::fflush(stdout);
}

/// Depths over the tool radius.
constexpr std::array kDepths{0.02, 0.06, 0.1, 0.2, 0.3, 0.4};

/// Places in a facet of 5 mm.
constexpr std::array<Vec3, 6> kPlaces{{{0, 0, 0},
                                       {0.0012, 0.0007, 0},
                                       {0.0025, 0.0003, 0},
                                       {0.0026, 0.0024, 0},
                                       {0.0035, 0.0014, 0},
                                       {0.0017, 0.0034, 0}}};

/// Elements of 5 mm, as large as the tool.
Body coarse_block(int cells) {
  const double half = 0.0025 * cells;
  return test::make_block(test::even(-half, half, cells), test::even(-half, half, cells),
                          test::even(-half, 0, cells / 2));
}

/// Shallow presses at these places.
CampaignSettings coarse_settings() {
  CampaignSettings s = settings(0.45);
  s.indentation.depth = 0.4 * s.indentation.tool.radius;
  s.indentation.increments = 20;
  for (const Vec3& place : kPlaces) s.points.push_back({place, {0, 0, -1}});
  return s;
}

void profile(const std::vector<int>& cells) {
  std::printf(
      "one thread; processor time, a site: nu = 0.49, to 4 mm in 10 increments, 16 sites; elements "
      "as large as the tool: nu = 0.45, to 2 mm in 20 increments, 6 sites\n");
  for (const int each : cells) {
    const Body body = block(each);
    CampaignSettings s = settings(0.49);
    s.sites = inner_sites(body, 16);
    const int per_edge = 2 * each + 1;
    const std::string name = std::to_string(per_edge * per_edge * (each + 1)) + " nodes";
    profile(name.c_str(), body, s);
  }
  profile("elements as large as the tool", coarse_block(16), coarse_settings());
}

/// The force over that of Hertz at several places in a facet: mean and standard deviation, and the
/// processor time of a site.
void contact_row(const Body& body, const std::string& name, const CampaignSettings& s) {
  CampaignReport report;
  const Curves curves = run_campaign(body, s, report);
  std::printf("| %s | %.2f s |", name.c_str(), report.cpu_seconds / kPlaces.size());
  const auto& material = s.materials.front().law;
  const double R = s.indentation.tool.radius, young = rest_moduli(material).young,
               poisson = rest_moduli(material).poisson;
  for (const double depth : kDepths) {
    double sum = 0, squares = 0;
    for (const SiteCurves& site : curves.sites)
      for (const CurveSample& sample : site.paths.front().samples)
        if (std::abs(sample.displacement - depth * R) < 1e-9) {
          const double d = sample.displacement;
          const double over = norm(sample.force) /
                              (4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(R * d) * d);
          sum += over;
          squares += over * over;
        }
    const double n = kPlaces.size(), mean = sum / n;
    std::printf(" %.4f +- %.4f |", mean, std::sqrt(std::max(0.0, squares / n - mean * mean)));
  }
  std::printf("\n");
  std::fflush(stdout);
}

void contact(int cells) {
  std::printf(
      "nu = 0.45, elements of 5 mm under a sphere of 5 mm, 20 increments to 0.4 R; six places in a "
      "facet, force over that of Hertz\n| refined | processor time, a site |");
  for (const double depth : kDepths) std::printf(" %.2f R |", depth);
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  const Body body = coarse_block(cells);
  CampaignSettings s = coarse_settings();
  const auto with = [&](int levels) {
    s.indentation.refine_under_tool = levels;
    return s;
  };
  for (const int levels : {0, 1, 2, 3}) contact_row(body, std::to_string(levels), with(levels));
  for (const double size : {3.5, 2.5, IndentationSettings{}.size_over_contact}) {
    s.indentation.size_over_contact = size;
    char name[32];
    std::snprintf(name, sizeof name, "contact, %.2f", size);
    contact_row(body, name, with(IndentationSettings::kByContact));
  }
}

int usage() {
  std::fputs(
      "usage: bench_precompute newton [8|26] | errors [CELLS...] | growth [CELLS...] | elements "
      "[CELLS...] | poisson [CELLS...] | contact [CELLS] | profile [CELLS...] | sites | threads "
      "[SITES...]\n",
      stderr);
  return 2;
}

int run(const std::string& part, const std::vector<int>& numbers) {
  if (part == "newton") {
    std::vector<int> cells;
    for (const int thousands : numbers) cells.push_back(thousands == 8 ? 12 : 18);
    against_newton(cells.empty() ? std::vector<int>{12, 18} : cells);
  } else if (part == "errors") {
    against_tolerance(numbers.empty() ? std::vector<int>{12, 18} : numbers);
  } else if (part == "growth") {
    growth(numbers.empty() ? std::vector<int>{8, 12, 18, 24, 28} : numbers);
  } else if (part == "elements") {
    elements(numbers.empty() ? std::vector<int>{8, 12} : numbers);
  } else if (part == "poisson") {
    against_poisson(numbers.empty() ? std::vector<int>{12} : numbers);
  } else if (part == "contact") {
    contact(numbers.empty() ? 16 : numbers.front());
  } else if (part == "profile") {
    profile(numbers.empty() ? std::vector<int>{18} : numbers);
  } else if (part == "sites") {
    against_sites();
  } else if (part == "threads") {
    against_threads(numbers.empty() ? std::vector<int>{64, 160} : numbers);
  } else {
    return usage();
  }
  return 0;
}

}  // namespace
}  // namespace palpate::fem

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  std::vector<int> numbers;
  for (int i = 2; i < count; ++i) numbers.push_back(std::atoi(arguments[i]));
  return palpate::fem::run(count > 1 ? arguments[1] : "", numbers);
}
