// SPDX-License-Identifier: AGPL-3.0-or-later
// The error of the mesh under the tool, against forces on elements that are small beside every
// contact. Points are pressed on the same body; only the elements under the tool differ.
//
// Usage: bench_mesh_error PART
//   size             error and cost against the size of the elements over the contact radius
//   bound            the bound that few sites give of all, with refine_under_tool = "contact"
//   elements         error and cost against the element size of the case
//   CASE BODY        the bound for the body.h5 of a case
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "bench/precompute/guarded.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/campaign/finer_mesh.hpp"
#include "fitting/response/mesh_error.hpp"
#include "format/numbers.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/support/round_cap.hpp"

namespace palpate {
namespace {

using fem::CampaignSettings;
using fem::IndentationSettings;

constexpr double kRadius = 0.005;  // m, of the tool
constexpr double kUsual = IndentationSettings{}.size_over_contact;
/// Elements over contact radius of forces that stand for converged ones, where many are compared,
/// and where the errors are smaller.
constexpr double kConverged = 1, kFinest = 0.75;
constexpr std::array kDepths{0.05, 0.1, 0.2, 0.4};  // over the radius of the tool

/// Evenly spread numbers from 0 to 1 (the sequences of the plastic number, M. Roberts 2018).
double spread(std::size_t i, int dimension) {
  constexpr std::array kSteps{0.8191725134, 0.6710436067, 0.5497004779};
  return std::fmod(0.5 + kSteps.at(to_index(dimension)) * static_cast<double>(i + 1), 1.0);
}

/// A block, twice as wide as high, whose nodes inside and on top are moved by up to 0.15 of a cell:
/// no two facets are alike.
Body uneven_block(double cell, double half = 0.02) {
  const int cells = static_cast<int>(std::lround(half / cell)) * 2;
  const double size = 2 * half / cells, inside = half - 1e-6;
  Body body = test::make_block(test::even(-half, half, cells), test::even(-half, half, cells),
                               test::even(-half, 0, cells / 2));
  std::size_t i = 0;
  test::deform(body, [&](const Vec3& x) {
    ++i;
    Vec3 moved = x;
    for (const std::size_t c : {0U, 1U})
      if (std::abs(x[c]) < inside) moved[c] += 0.3 * size * (spread(i, static_cast<int>(c)) - 0.5);
    if (x[2] < -1e-6 && x[2] > -inside) moved[2] += 0.3 * size * (spread(i, 2) - 0.5);
    return moved;
  });
  return body;
}

Body round_cap(double size) {
  const test::RoundCap cap;
  Body body = test::even_cap(cap, size);
  test::curve_onto_sphere(cap.radius, body);
  return body;
}

/// A body, and points within a few facets of its middle.
struct Pressed {
  std::string name;
  Body body;
  std::vector<fem::PressPoint> points;
};

constexpr std::size_t kPlaces = 4;

Pressed block_of(double cell) {
  Pressed pressed{"block, " + std::to_string(static_cast<int>(std::lround(1e4 * cell))),
                  uneven_block(cell),
                  {}};
  for (std::size_t i = 0; i < kPlaces; ++i)
    pressed.points.push_back(
        {{2 * cell * (spread(i, 0) - 0.5), 2 * cell * (spread(i, 1) - 0.5), 0}, {0, 0, -1}});
  return pressed;
}

Pressed cap_of(double size) {
  Pressed pressed{
      "ball, " + std::to_string(static_cast<int>(std::lround(1e4 * size))), round_cap(size), {}};
  const double R = test::RoundCap{}.radius;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double angle = 2 * std::numbers::pi * spread(i, 0);
    const double away = 1.5 * size / R * std::sqrt(spread(i, 1));
    const Vec3 out{std::sin(away) * std::cos(angle), std::sin(away) * std::sin(angle),
                   std::cos(away)};
    pressed.points.push_back({R * out, -1 * out});
  }
  return pressed;
}

CampaignSettings press(double depth) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.45}}};
  s.indentation.tool.radius = kRadius;
  s.indentation.depth = depth;
  s.indentation.increments = static_cast<int>(std::lround(depth / (kDepths.front() * kRadius)));
  s.indentation.lateral_depths.clear();
  s.indentation.lateral_travel = 0;
  s.threads = 1;
  return s;
}

CampaignSettings by_contact(CampaignSettings s, double size_over_contact) {
  s.indentation.refine_under_tool = IndentationSettings::kByContact;
  s.indentation.size_over_contact = size_over_contact;
  return s;
}

struct Forces {
  Curves curves;
  double seconds = 0;  ///< of the processor, for a site
};

Forces forces(const Body& body, const CampaignSettings& s) {
  fem::CampaignReport report;
  Forces found{fem::run_campaign(body, s, report), 0};
  found.seconds = report.cpu_seconds / static_cast<double>(found.curves.sites.size());
  return found;
}

/// N, at a depth of the normal path of a site; NaN where the path ended before.
const CurveSample* at_depth(const SiteCurves& site, double depth) {
  for (const CurveSample& sample : site.paths.front().samples)
    if (std::abs(sample.displacement - depth) < 1e-6 * depth) return &sample;
  return nullptr;
}

double relative_error(const SiteCurves& site, const SiteCurves& exact, double depth) {
  const CurveSample *ours = at_depth(site, depth), *truth = at_depth(exact, depth);
  if (ours == nullptr || truth == nullptr) return kUnknown;
  const CurvePath& path = site.paths.front();
  return response_force(path, *ours) / response_force(path, *truth) - 1;
}

/// Mean and standard deviation of what is known.
struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    if (std::isnan(x)) return;
    n += 1;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / n - mean() * mean())); }
};

void print_depths(const char* first) {
  std::printf("%s", first);
  for (const double depth : kDepths) std::printf(" %g R |", depth);
  std::printf("\n|");
  for (std::size_t i = 0; i < kDepths.size() + 3; ++i) std::printf("---|");
  std::printf("\n");
}

std::string name_of(double size_over_contact) {
  return size_over_contact > 0 ? std::to_string(size_over_contact).substr(0, 4) : "none";
}

std::vector<Pressed> bodies() {
  std::vector<Pressed> all;
  for (const double cell : {0.004, 0.005}) all.push_back(block_of(cell));
  for (const double size : {0.005}) all.push_back(cap_of(size));
  return all;
}

using Row = std::array<Moments, kDepths.size()>;

void print_row(const std::string& name, double seconds, double relative, const Row& row) {
  std::printf("| %s | %.2f s | %.2f |", name.c_str(), seconds, relative);
  for (const Moments& m : row) std::printf(" %+.2f +- %.2f |", 100 * m.mean(), 100 * m.deviation());
  std::printf("\n");
  std::fflush(stdout);
}

/// Relative errors in percent: mean and standard deviation over the places, and over all bodies.
void against_size() {
  print_depths("| elements over contact radius | processor time, a site | over none |");
  constexpr std::array kSizes{0.0, 2.5, kUsual, 1.25};
  std::array<Row, kSizes.size()> all{};
  std::array<double, kSizes.size()> seconds{};
  const std::vector<Pressed> pressed = bodies();
  for (const Pressed& body : pressed) {
    CampaignSettings s = press(kDepths.back() * kRadius);
    s.points = body.points;
    const Forces converged = forces(body.body, by_contact(s, kConverged));
    const Curves& exact = converged.curves;
    std::printf("%s: %.2f s for converged forces\n", body.name.c_str(), converged.seconds);
    std::fflush(stdout);
    double none = 0;
    for (std::size_t k = 0; k < kSizes.size(); ++k) {
      const Forces found = forces(body.body, kSizes.at(k) > 0 ? by_contact(s, kSizes.at(k)) : s);
      if (k == 0) none = found.seconds;
      Row row{};
      for (std::size_t d = 0; d < kDepths.size(); ++d)
        for (std::size_t i = 0; i < exact.sites.size(); ++i) {
          const double error =
              relative_error(found.curves.sites[i], exact.sites[i], kDepths.at(d) * kRadius);
          row.at(d).add(error);
          all.at(k).at(d).add(error);
        }
      seconds.at(k) += found.seconds / static_cast<double>(pressed.size());
      print_row(body.name + ": " + name_of(kSizes.at(k)), found.seconds, found.seconds / none, row);
    }
  }
  for (std::size_t k = 0; k < kSizes.size(); ++k)
    print_row("all: " + name_of(kSizes.at(k)), seconds.at(k), seconds.at(k) / seconds.front(),
              all.at(k));
}

/// The same places on blocks of ever smaller elements, against elements of 2 mm that the contact
/// divides further.
void against_elements() {
  print_depths("| element size over tool radius | processor time, a site | set-up |");
  const auto body_of = [](double cell) {
    Pressed pressed = block_of(0.004);
    pressed.body = uneven_block(cell);
    return pressed;
  };
  CampaignSettings s = press(kDepths.back() * kRadius);
  s.points = body_of(0.002).points;
  const Curves exact = forces(body_of(0.002).body, by_contact(s, kUsual)).curves;
  for (const double size : {kUsual, 0.0})
    for (const double cell : {0.01, 0.00667, 0.005, 0.00333, 0.0025}) {
      fem::CampaignReport report;
      const Body body = body_of(cell).body;
      const Curves found = fem::run_campaign(body, size > 0 ? by_contact(s, size) : s, report);
      Row row{};
      for (std::size_t d = 0; d < kDepths.size(); ++d)
        for (std::size_t i = 0; i < exact.sites.size(); ++i)
          row.at(d).add(relative_error(found.sites[i], exact.sites[i], kDepths.at(d) * kRadius));
      print_row((size > 0 ? "by the contact, " : "none, ") + std::to_string(cell / kRadius),
                report.cpu_seconds / static_cast<double>(kPlaces), report.set_up_seconds, row);
    }
}

/// What the stored bound says of the samples at a depth, and what is true.
struct Judgement {
  int covered = 0;  ///< the error is within the bound
  std::vector<double> bounds, errors;
};

/// The largest error along the path of a site that was pressed on a finer mesh.
struct SiteEstimate {
  double estimated = 0, truth = 0;
  bool within_two() const { return estimated <= 2 * truth && truth <= 2 * estimated; }
};

double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return kUnknown;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

/// Error of a sample as the finest mesh has it, N.
double true_error(const CurvePath& path, const CurvePath& exact, std::size_t i) {
  return response_force(exact, exact.samples[i]) - response_force(path, path.samples[i]);
}

Judgement judge(const Curves& curves, const Curves& exact, std::size_t i) {
  Judgement judgement;
  for (std::size_t k = 0; k < curves.sites.size(); ++k) {
    const CurvePath& path = curves.sites[k].paths.front();
    const CurvePath& truth = exact.sites[k].paths.front();
    if (path.samples.size() <= i || truth.samples.size() <= i) continue;
    const CurveSample& sample = path.samples[i];
    const double force = response_force(path, sample);
    const double error = std::abs(true_error(path, truth, i));
    judgement.covered += error <= sample.mesh_error ? 1 : 0;
    judgement.bounds.push_back(sample.mesh_error / force);
    judgement.errors.push_back(error / force);
  }
  return judgement;
}

std::vector<SiteEstimate> estimates(const Curves& curves, const Curves& exact) {
  std::vector<SiteEstimate> found;
  for (std::size_t k = 0; k < curves.sites.size(); ++k) {
    const CurvePath& path = curves.sites[k].paths.front();
    const CurvePath& truth = exact.sites[k].paths.front();
    SiteEstimate site;
    for (std::size_t i = 1; i < std::min(path.samples.size(), truth.samples.size()); ++i) {
      const double force = response_force(path, path.samples[i]);
      if (std::isnan(path.samples[i].mesh_difference)) continue;
      site.estimated = std::max(site.estimated, std::abs(path.samples[i].mesh_difference) / force);
      site.truth = std::max(site.truth, std::abs(true_error(path, truth, i)) / force);
    }
    if (site.estimated > 0) found.push_back(site);
  }
  return found;
}

/// `chosen`: the sites that are pressed on the finer mesh too.
void print_bound(const std::string& name, const Body& body, const CampaignSettings& s,
                 const std::vector<std::int32_t>& chosen) {
  fem::CampaignReport report, on_finer_mesh;
  Curves curves = fem::run_campaign(body, s, report);
  fem::press_on_finer_mesh(body, s, chosen, curves, on_finer_mesh);
  fitting::bound_mesh_errors(curves, fem::at_sharp_edges(body, curves.tool, curves.depth));
  const Curves exact = forces(body, by_contact(s, kFinest)).curves;
  const std::vector<SiteEstimate> pressed = estimates(curves, exact);
  const auto sites = static_cast<double>(curves.sites.size());
  std::printf("%s: %zu sites, %.2f s a site; %zu on a finer mesh, %.2f s a site; confidence %.2f\n",
              name.c_str(), curves.sites.size(), report.cpu_seconds / sites, chosen.size(),
              on_finer_mesh.cpu_seconds / static_cast<double>(chosen.size()),
              curves.mesh_error_confidence);
  for (const SiteEstimate& site : pressed)
    std::printf("  largest error along a path: %.2f %% estimated, %.2f %% true%s\n",
                100 * site.estimated, 100 * site.truth,
                site.within_two() ? "" : " (not within a factor of two)");
  std::printf(
      "| depth | median error | 95 %% | largest | median bound | covered "
      "|\n|---|---|---|---|---|---|"
      "\n");
  const CurvePath& first = curves.sites.front().paths.front();
  for (std::size_t i = 1; i < first.samples.size(); ++i) {
    const Judgement at = judge(curves, exact, i);
    std::printf("| %.2f mm | %.2f %% | %.2f %% | %.2f %% | %.2f %% | %d of %zu |\n",
                1e3 * first.samples[i].displacement, 100 * percentile(at.errors, 0.5),
                100 * percentile(at.errors, 0.95), 100 * percentile(at.errors, 1),
                100 * percentile(at.bounds, 0.5), at.covered, at.errors.size());
  }
  std::fflush(stdout);
}

std::vector<std::int32_t> sites_near(const Body& body, const Vec3& centre, double reach,
                                     std::size_t count) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.node.size() && sites.size() < count; ++v)
    if (body.response.is_site[v] != 0 &&
        norm(body.nodes[to_index(body.response.node[v])] - centre) < reach)
      sites.push_back(static_cast<std::int32_t>(v));
  return sites;
}

/// The vertices of the skin within an angle of the pole as response vertices.
Body cap_with_sites(double size, double angle) {
  Body body = round_cap(size);
  const double R = test::RoundCap{}.radius;
  body.response = {};
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    const Vec3& x = body.nodes[n];
    if (norm(x) < 0.9999 * R || x[2] < R * std::cos(angle)) continue;
    body.response.node.push_back(static_cast<std::int32_t>(n));
    body.response.inward.push_back((-1 / norm(x)) * x);
    body.response.is_site.push_back(1);
  }
  return body;
}

void against_truth() {
  CampaignSettings s = press(kDepths.back() * kRadius);
  s.indentation.refine_under_tool = IndentationSettings::kByContact;
  const Body block = uneven_block(0.004);
  s.sites = sites_near(block, {}, 0.0081, 8);
  print_bound("block, elements of 4 mm", block, s, fem::sites_far_apart(block, s.sites, 4));
  const Body cap = cap_with_sites(0.0048, 0.45);
  s.sites = sites_near(cap, {}, 1, 8);
  print_bound("ball, elements of 4.8 mm", cap, s, fem::sites_far_apart(cap, s.sites, 4));
}

/// Every eighth site of a case, on the body that `palpate mesh` made; with the elements of the
/// case, and refined by the contact.
void of_case(const char* file, const char* body_file) {
  const app::Workspace space = app::make_workspace(file, "", 1);
  const Body body = read_body(body_file);
  CampaignSettings s = app::campaign_settings(space);
  s.indentation.lateral_depths.clear();
  std::vector<std::int32_t> sites = sites_near(body, {}, kInfinity, body.response.node.size());
  for (std::size_t i = 0; i < sites.size(); i += 8) s.sites.push_back(sites[i]);
  s.mesh_error_sites = 4;
  for (const int refined : {0, IndentationSettings::kByContact}) {
    s.indentation.refine_under_tool = refined;
    print_bound(space.c.name + (refined == 0 ? ", as it is" : ", by the contact"), body, s,
                fem::sites_on_finer_mesh(body, s, s.sites));
  }
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  const std::string part = count > 1 ? arguments[1] : "";
  if (part == "size") {
    palpate::against_size();
  } else if (part == "bound") {
    palpate::against_truth();
  } else if (part == "elements") {
    palpate::against_elements();
  } else if (count == 3) {
    return palpate::guarded([&] { palpate::of_case(arguments[1], arguments[2]); });
  } else {
    std::fputs("usage: bench_mesh_error size | bound | elements | CASE BODY\n", stderr);
    return 2;
  }
  return 0;
}
