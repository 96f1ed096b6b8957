// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites against FEBio 4, by the decks that `palpate export site --febio` writes, run as they are
// written: a bonded patch and three tools pressed into a block, elements of displacements alone,
// nu = 0.45, the same volumetric energy in both. The decks give FEBio a tenth of the contact
// stiffness, without which its contact does not converge.
//
// Usage: bench_febio FEBIO [SIZE...]   path of febio4; elements under the tool, mm (default 3)
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/export/deck.hpp"
#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/indentation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr double kPatchRadius = 0.005;

/// 30 x 30 x 15 mm, base fixed, finer towards the middle of its top.
Body block(double fine) {
  return test::graded_block(0.015, 0.006, fine, 1.7);
}

fem::CampaignSettings pressing(const fem::ToolGeometry& tool, int increments) {
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.dilatation = fem::Dilatation::Pointwise;
  settings.indentation.tool = tool;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = increments;
  settings.indentation.lateral_depths.clear();
  settings.indentation.lateral_travel = 0;
  return settings;
}

/// N, the sum of the forces that FEBio prints last, along z. Ends the program where the run did not
/// end well.
double run_febio(const std::string& febio, const app::Deck& deck) {
  std::string name = (fs::temp_directory_path() / "palpate-febio-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = name;
  std::ofstream(folder / "site.feb") << app::febio_deck(deck);
  const std::string command =
      "cd " + folder.string() + " && OMP_NUM_THREADS=1 '" + febio + "' -i site.feb > site.out 2>&1";
  if (std::system(command.c_str()) != 0) {
    std::fprintf(stderr, "error: %s did not solve %s/site.feb; see site.out beside it\n",
                 febio.c_str(), name.c_str());
    std::exit(1);
  }
  std::ifstream printed(folder / (deck.tool ? "tool_forces.txt" : "patch_forces.txt"));
  double sum = 0;
  for (std::string line; std::getline(printed, line);) {
    if (line.rfind("*Step", 0) == 0) sum = 0;
    if (line.empty() || line.front() == '*') continue;
    std::istringstream numbers(line);
    double id = 0, x = 0, y = 0, z = 0;
    char comma = 0;
    if (line.find(',') == std::string::npos)
      numbers >> id >> x >> y >> z;
    else
      numbers >> id >> comma >> x >> comma >> y >> comma >> z;
    sum += z;
  }
  fs::remove_all(folder);
  return std::abs(sum);
}

void print_row(double fine, const char* what, int increments, double ours, double theirs) {
  std::printf("| %.1f mm | %s | %d | %.6f N | %.6f N | %+.3f %% |\n", 1e3 * fine, what, increments,
              ours, theirs, 100 * (ours / theirs - 1));
  std::fflush(stdout);
}

void compare_patch(const std::string& febio, double fine) {
  const Body body = block(fine);
  const auto settings = pressing({}, 2);
  const std::int32_t vertex = test::site_nearest(body);
  const double ours =
      std::abs(fem::press_patch(body, settings, vertex, kPatchRadius).samples.back().force[2]);
  print_row(fine, "bonded patch of 5 mm", 2, ours,
            run_febio(febio, app::make_patch_deck(body, settings, vertex, kPatchRadius)));
}

void compare_tool(const std::string& febio, double fine, const char* what,
                  const fem::ToolGeometry& tool, int increments) {
  const Body body = block(fine);
  const auto settings = pressing(tool, increments);
  const std::int32_t vertex = test::site_nearest(body);
  const fem::CampaignContext context(body, settings, fem::Engine::SharedFactor);
  const SiteCurves curves = fem::solve_site(context, vertex, nullptr);
  print_row(fine, what, increments, std::abs(curves.paths.front().samples.back().force[2]),
            run_febio(febio, app::make_tool_deck(body, settings, vertex)));
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  if (count < 2) {
    std::fprintf(stderr, "usage: bench_febio FEBIO [SIZE...]\n");
    return 2;
  }
  const std::string febio = arguments[1];
  std::vector<double> sizes;
  for (int i = 2; i < count; ++i) sizes.push_back(1e-3 * std::atof(arguments[i]));
  if (sizes.empty()) sizes = {3e-3};
  std::printf(
      "| elements under the tool | pressed 2 mm | increments | palpate | FEBio | difference |\n"
      "|---|---|---|---|---|---|\n");
  using palpate::fem::ToolShape;
  for (const double fine : sizes) {
    palpate::compare_patch(febio, fine);
    for (const int increments : {2, 10})
      palpate::compare_tool(febio, fine, "sphere of 5 mm", {ToolShape::Sphere, 0.005, 0, 0},
                            increments);
    palpate::compare_tool(febio, fine, "disc of 5 mm, edge of 1 mm",
                          {ToolShape::Disc, 0.005, 0.001, 0}, 2);
    palpate::compare_tool(febio, fine, "cylinder of 3 mm, 8 mm long",
                          {ToolShape::Cylinder, 0.003, 0, 0.008}, 2);
  }
  return 0;
}
