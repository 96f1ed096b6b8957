// SPDX-License-Identifier: AGPL-3.0-or-later
// A site against CalculiX (Debian's calculix-ccx) in one run: blocks of tissue with a patch of 3 mm
// radius bonded to the tool and pressed 3 mm in 10 increments, elements of displacements alone.
// CalculiX gets the deck that `palpate export site --calculix` writes; the campaign presses a sharp
// disc of the same radius without slip.
//
// Usage: bench_calculix [SIZE...]   of the elements under the patch, mm; 2.5 and 1.5 by default
#include <sys/resource.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/export/deck.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/factor/cholesky.hpp"
#include "tests/support/block_body.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr double kRadius = 0.003;

/// 60 x 60 x 30 mm with its base fixed, cells of `fine` in the middle of the top that grow
/// outwards.
Body block(double fine) {
  return test::graded_block(0.03, 0.0075, fine, 1.6);
}

fem::CampaignSettings settings() {
  fem::CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.49}}};
  s.dilatation = fem::Dilatation::Pointwise;
  s.indentation.tool = {fem::ToolShape::Disc, kRadius, 0, 0};
  s.indentation.friction = fem::ToolFriction::NoSlip;
  s.indentation.depth = 0.003;
  s.indentation.increments = 10;
  s.indentation.lateral_depths.clear();
  s.threads = 1;
  return s;
}

std::vector<std::int32_t> inner_sites(const Body& body) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.node.size() && sites.size() < 16; ++v) {
    const Vec3& X = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    if (std::max(std::abs(X[0]), std::abs(X[1])) < 0.0051)
      sites.push_back(static_cast<std::int32_t>(v));
  }
  return sites;
}

double children_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Foreign {
  double seconds = 0, force = 0;
};

Foreign run_calculix(const app::Deck& deck) {
  std::string name = (fs::temp_directory_path() / "palpate-ccx-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = name;
  std::ofstream(folder / "site.inp") << app::calculix_deck(deck);
  const double before = children_seconds();
  const std::string command =
      "cd " + folder.string() + " && OMP_NUM_THREADS=1 ccx site > site.log 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("ccx failed, see " + name);
  Foreign result{children_seconds() - before, 0};
  std::ifstream printed(folder / "site.dat");
  for (std::string line; std::getline(printed, line);) {
    if (line.find("total force") == std::string::npos) continue;
    Vec3 force{};
    printed >> force[0] >> force[1] >> force[2];
    result.force = norm(force);
  }
  fs::remove_all(folder);
  return result;
}

/// Radius of a disc as large as the facets that the patch moves as a whole.
double equal_radius(const app::Deck& deck) {
  std::vector<bool> moved(static_cast<std::size_t>(deck.mesh.nodes()), false);
  for (const std::int32_t node : deck.patch) moved[static_cast<std::size_t>(node)] = true;
  double area = 0;
  for (const fem::Facet& facet : deck.mesh.facets) {
    const auto& X = deck.mesh.X;
    if (std::any_of(facet.begin(), facet.end(),
                    [&](int node) { return !moved[static_cast<std::size_t>(node)]; }))
      continue;
    const Eigen::Vector3d a = X.col(facet[1]) - X.col(facet[0]),
                          b = X.col(facet[2]) - X.col(facet[0]);
    area += 0.5 * a.cross(b).norm();
  }
  return std::sqrt(area / M_PI);
}

void compare(double fine) {
  const Body body = block(fine);
  fem::CampaignSettings s = settings();
  s.sites = inner_sites(body);
  const app::Deck deck =
      app::make_patch_deck(body, s, s.sites[s.sites.size() / 2], s.indentation.tool.radius);
  s.indentation.tool.radius = equal_radius(deck);
  fem::CampaignReport report;
  const Curves curves = fem::run_campaign(body, s, report);
  const std::size_t middle = s.sites.size() / 2;
  const double ours = norm(curves.sites[middle].paths.front().samples.back().force);
  const double mean = report.cpu_seconds / static_cast<double>(s.sites.size());
  const Foreign theirs = run_calculix(deck);
  std::printf("| %.1f mm | %lld | %.2f s | %.4f N | %.3f s | %.4f N | %.0f |\n", 1e3 * fine,
              static_cast<long long>(report.unknowns / 3), theirs.seconds, theirs.force, mean, ours,
              theirs.seconds / mean);
  std::fflush(stdout);
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  std::vector<double> sizes;
  for (int i = 1; i < count; ++i) sizes.push_back(1e-3 * std::atof(arguments[i]));
  if (sizes.empty()) sizes = {2.5e-3, 1.5e-3};
  std::printf(
      "bonded patch of 3 mm radius to 3 mm, 10 increments, nu = 0.49, displacements alone; BLAS "
      "kernel %s\n| elements | free nodes | CalculiX, a site | its force | campaign, a site | its "
      "force "
      "| ratio |\n|---|---|---|---|---|---|---|\n",
      palpate::fem::blas_kernel().c_str());
  for (const double fine : sizes) palpate::compare(fine);
  return 0;
}
