// SPDX-License-Identifier: AGPL-3.0-or-later
// The effect of curved facets: a sphere is pressed onto many points of a ball, whose stiffness does
// not depend on the position, on flat or curved facets, with and without refinement under the tool,
// against the force on a mesh that is refined at the pole and has curved facets.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/blas_kernel.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/support/round_cap.hpp"

namespace {

using namespace palpate;

constexpr double kNear = 0.0075;  // m

/// Steps of h up to `core`, then ever larger ones to the end.
std::vector<double> graded(double h, double core, double growth, double end) {
  std::vector<double> at{0};
  for (double step = h; at.back() < end - 1e-12;) {
    if (at.back() > core - 1e-12) step *= growth;
    at.push_back(end - at.back() < 1.5 * step ? end : at.back() + step);
  }
  return at;
}

/// Elements of size h around the pole.
Body refined_cap(const test::RoundCap& cap, double h) {
  std::vector<double> angles = graded(h, 0.0035, 1.4, cap.radius * cap.half_angle);
  angles.erase(angles.begin());
  for (double& angle : angles) angle /= cap.radius;
  std::vector<double> depths = graded(h, h, 1.5, cap.thickness);
  std::reverse(depths.begin(), depths.end());
  return test::cap_of(cap, angles, static_cast<int>(std::lround(0.0035 / h)), depths);
}

void print_row(double h, const char* what, const std::vector<test::Spread>& found,
               const std::vector<test::Spread>& reference) {
  std::printf("| %.1f mm | %s |", 1e3 * h, what);
  for (std::size_t i = 0; i < found.size(); ++i)
    std::printf(" %.1f mN, %+.1f +- %.1f %% |", 1e3 * found[i].mean,
                100 * (found[i].mean / reference[i].mean - 1),
                100 * found[i].deviation * found[i].mean / reference[i].mean);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

/// Mean force over the positions, its error and the standard deviation over the positions, both
/// over the force of the finest mesh, whose own error the next coarser mesh shows.
int main(int, char** arguments) {
  palpate::app::ensure_blas_kernel(arguments);
  const test::RoundCap cap;
  fem::IndentationSettings press;
  press.tool.radius = 0.005;
  press.depth = 0.002;
  press.increments = 4;
  std::printf("| elements | facets |");
  for (int i = 1; i <= press.increments; ++i)
    std::printf(" %.1f mm |", 1e3 * press.depth * i / press.increments);
  std::printf("\n|---|---|---|---|---|---|\n");
  std::vector<test::Spread> reference;
  for (const double h : {0.0010, 0.0014}) {
    Body body = refined_cap(cap, h);
    test::curve_onto_sphere(cap.radius, body);
    const auto found = test::spread_of_force(cap, body, press, h);
    if (reference.empty()) reference = found;
    print_row(h, "curved, at the pole only", found, reference);
  }
  for (const double h : {0.006, 0.004})
    for (const bool refined : {false, true})
      for (const bool curved : {false, true}) {
        Body body = test::even_cap(cap, h);
        if (curved) test::curve_onto_sphere(cap.radius, body);
        press.refine_under_tool = refined ? 1 : 0;
        const char* what =
            refined ? (curved ? "curved, refined" : "flat, refined") : (curved ? "curved" : "flat");
        print_row(h, what, test::spread_of_force(cap, body, press, kNear), reference);
      }
}
