// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites against FEBio 4, by the decks that `palpate export site --febio` writes, run as they are
// written: a bonded patch and three tools pressed into a block, elements of displacements alone,
// nu = 0.45, the same volumetric energy in both. The decks give FEBio a tenth of the contact
// stiffness, without which its contact does not converge.
//
// With --relaxing instead: a sphere pressed at two speeds into the block with a Prony series of two
// terms, and held there, against press_relaxing at every step of FEBio.
//
// Usage: bench_febio FEBIO [--relaxing] [SIZE...]
// FEBIO: path of febio4; SIZE: elements under the tool, mm (default 3)
#include <algorithm>
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
#include "fem/relaxation/relaxing_press.hpp"
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

struct TimedForce {
  double time_s = 0;
  double force = 0;  ///< N, along z
};

/// The sums of the forces that FEBio prints for each of its steps.
std::vector<TimedForce> printed_forces(const fs::path& file) {
  std::vector<TimedForce> steps;
  std::ifstream printed(file);
  for (std::string line; std::getline(printed, line);) {
    if (line.rfind("*Step", 0) == 0) steps.emplace_back();
    if (line.rfind("*Time", 0) == 0)
      steps.back().time_s = std::stod(line.substr(line.find('=') + 1));
    if (line.empty() || line.front() == '*') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double id = 0, x = 0, y = 0, z = 0;
    numbers >> id >> x >> y >> z;
    steps.back().force += z;
  }
  for (TimedForce& step : steps) step.force = std::abs(step.force);
  return steps;
}

/// Ends the program where the run did not end well.
std::vector<TimedForce> run_febio(const std::string& febio, const app::Deck& deck) {
  std::string name = (fs::temp_directory_path() / "palpate-febio-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = name;
  std::ofstream(folder / "site.feb") << app::febio_deck(deck);
  const std::string command =
      "cd " + folder.string() + " && OMP_NUM_THREADS=1 '" + febio + "' -i site.feb > site.out 2>&1";
  const bool solved = std::system(command.c_str()) == 0;
  const auto steps = printed_forces(folder / (deck.tool ? "tool_forces.txt" : "patch_forces.txt"));
  if (!solved || steps.empty()) {
    std::fprintf(stderr, "error: %s did not solve %s/site.feb; see site.out beside it\n",
                 febio.c_str(), name.c_str());
    std::exit(1);
  }
  fs::remove_all(folder);
  return steps;
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
  print_row(
      fine, "bonded patch of 5 mm", 2, ours,
      run_febio(febio, app::make_patch_deck(body, settings, vertex, kPatchRadius)).back().force);
}

void compare_tool(const std::string& febio, double fine, const char* what,
                  const fem::ToolGeometry& tool, int increments) {
  const Body body = block(fine);
  const auto settings = pressing(tool, increments);
  const std::int32_t vertex = test::site_nearest(body);
  const fem::CampaignContext context(body, settings, fem::Engine::SharedFactor);
  const SiteCurves curves = fem::solve_site(context, vertex, nullptr);
  print_row(fine, what, increments, std::abs(curves.paths.front().samples.back().force[2]),
            run_febio(febio, app::make_tool_deck(body, settings, vertex)).back().force);
}

/// The force of a motion where a step of it ends, else between its steps.
double force_at(const fem::RelaxingPress& press, double time) {
  const auto& samples = press.samples;
  const auto after = std::find_if(samples.begin() + 1, samples.end(),
                                  [&](const auto& s) { return s.time_s >= time * (1 - 1e-9); });
  if (after == samples.end()) return std::abs(samples.back().force[2]);
  const auto& before = *(after - 1);
  const double part = (time - before.time_s) / (after->time_s - before.time_s);
  return std::abs(before.force[2] + part * (after->force[2] - before.force[2]));
}

/// A sphere of 5 mm, a press at constant speed and a hold, tissue with a Prony series: the force at
/// the end of each, and the largest difference at a step of FEBio, over the largest force.
void compare_relaxing(const std::string& febio, double fine, double press_s, double hold_s) {
  const Body body = block(fine);
  auto settings = pressing({fem::ToolShape::Sphere, 0.005, 0, 0}, 10);
  settings.materials.front().relaxation = {{0.3, 0.05}, {0.3, 0.5}};
  const std::int32_t vertex = test::site_nearest(body);
  app::Deck deck = app::make_tool_deck(body, settings, vertex);
  deck.pace = app::PressAndHold{press_s, hold_s};
  const double depth = settings.indentation.depth;
  const fem::RelaxingPress ours = fem::press_relaxing(
      body, settings, vertex, {{0, 0}, {press_s, depth}, {press_s + hold_s, depth}});
  if (!ours.complete) throw std::runtime_error(ours.reason);
  const auto theirs = run_febio(febio, deck);
  double peak = 0, apart = 0, pressed = 0;
  for (const TimedForce& step : theirs) {
    peak = std::max(peak, step.force);
    apart = std::max(apart, std::abs(step.force - force_at(ours, step.time_s)));
    if (step.time_s <= press_s * (1 + 1e-9)) pressed = step.force;
  }
  const double end = press_s + hold_s;
  std::printf("| %.1f mm | %g s | %.6f N | %.6f N | %.6f N | %.6f N | %.2f %% |\n", 1e3 * fine,
              press_s, force_at(ours, press_s), pressed, force_at(ours, end), theirs.back().force,
              100 * apart / peak);
  std::fflush(stdout);
}

void compare_elastic(const std::string& febio, double fine) {
  compare_patch(febio, fine);
  for (const int increments : {2, 10})
    compare_tool(febio, fine, "sphere of 5 mm", {fem::ToolShape::Sphere, 0.005, 0, 0}, increments);
  compare_tool(febio, fine, "disc of 5 mm, edge of 1 mm", {fem::ToolShape::Disc, 0.005, 0.001, 0},
               2);
  compare_tool(febio, fine, "cylinder of 3 mm, 8 mm long",
               {fem::ToolShape::Cylinder, 0.003, 0, 0.008}, 2);
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  if (count < 2) {
    std::fprintf(stderr, "usage: bench_febio FEBIO [--relaxing] [SIZE...]\n");
    return 2;
  }
  const std::string febio = arguments[1];
  bool relaxing = false;
  std::vector<double> sizes;
  for (int i = 2; i < count; ++i) {
    if (std::string(arguments[i]) == "--relaxing")
      relaxing = true;
    else
      sizes.push_back(1e-3 * std::atof(arguments[i]));
  }
  if (sizes.empty()) sizes = {3e-3};
  std::printf(
      relaxing
          ? "| elements under the tool | press | palpate, pressed | FEBio, pressed | "
            "palpate, held | FEBio, held | largest difference |\n|---|---|---|---|---|---|---|\n"
          : "| elements under the tool | pressed 2 mm | increments | palpate | FEBio | "
            "difference |\n|---|---|---|---|---|---|\n");
  for (const double fine : sizes) {
    if (!relaxing) palpate::compare_elastic(febio, fine);
    for (const double press_s : {0.02, 2.0})
      if (relaxing) palpate::compare_relaxing(febio, fine, press_s, 2);
  }
  return 0;
}
