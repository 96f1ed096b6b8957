// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/clamped.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "fem/factor/cholesky.hpp"
#include "fem/laws/law.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/specimen/grid_body.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr double kPlanes = 1e5;      ///< of the planes of symmetry, over modulus and length
constexpr double kTolerance = 1e-6;  ///< of the residual, over the force of the clamps
constexpr int kMostIterations = 40, kMostHalvings = 8;
constexpr double kLargestStep = 0.1;  ///< of the stretch
constexpr double kSmallestStep = 1e-3;
constexpr int kSectors = 12;  ///< of a cylinder

/// Cells across a length that has `size` from its middle to its surface.
std::vector<double> cells(double size, int count) {
  std::vector<double> at;
  for (int i = 0; i <= count; ++i) at.push_back(size * i / count);
  return at;
}

int cell_count(double size, double cell, int least, int most) {
  return std::clamp(static_cast<int>(std::lround(size / cell)), least, most);
}

/// The part of the specimen from its middle, z = 0, to the clamp, which is fixed: its displacement
/// is prescribed.
Body half(const ClampedSpecimen& s, double stiffness) {
  const double end = 0.5 * s.length;
  const double smallest = s.diameter > 0 ? 0.5 * s.diameter : 0.5 * std::min(s.width, s.thickness);
  const double cell = std::min(smallest, end) / 2;
  const auto axial = cells(end, cell_count(end, cell, 4, 8));
  Body body;
  if (s.diameter > 0) {
    const double radius = 0.5 * s.diameter, angle = 2 * std::numbers::pi / kSectors;
    body = grid_body({cells(radius, cell_count(radius, cell, 3, 12)), {0, angle}, axial},
                     [](const Vec3& x) {
                       return Vec3{x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]};
                     });
    slide_where(
        body,
        [=](const Vec3& x) {
          return std::abs(x[0] * std::sin(angle) - x[1] * std::cos(angle)) < 1e-9 * radius;
        },
        stiffness);
  } else {
    const auto across = [&](double width) {
      return cells(0.5 * width, cell_count(0.5 * width, cell, 2, 8));
    };
    body =
        grid_body({across(s.width), across(s.thickness), axial}, [](const Vec3& x) { return x; });
    slide_where(
        body, [](const Vec3& x) { return x[0] == 0; }, stiffness);
  }
  slide_where(
      body, [](const Vec3& x) { return x[1] == 0; }, stiffness);
  slide_where(
      body, [](const Vec3& x) { return x[2] == 0; }, stiffness);
  return body;
}

/// Equilibria of the specimen at displacements of its clamp.
class ClampedPath {
 public:
  ClampedPath(const Body& loose, const Body& clamped, const LawConstants& law)
      : model_(clamped, {make_law(law, "specimen")}),
        loose_(loose, {make_law(law, "specimen")}),
        factor_(model_.pattern()),
        u_(Displacement::Zero(3, model_.mesh().nodes())) {}

  /// From the present state to this stretch, in steps that shrink where one fails.
  void stretch_to(double stretch) {
    double step = kLargestStep;
    while (stretch_ != stretch) {
      const double next = stretch_ + std::clamp(stretch - stretch_, -step, step);
      Displacement trial = u_;
      trial.row(2) += (next - stretch_) * model_.mesh().X.row(2);
      if (equilibrate(trial)) {
        u_ = trial;
        stretch_ = std::abs(next - stretch) < 1e-12 ? stretch : next;
        continue;
      }
      step *= 0.5;
      if (step < kSmallestStep)
        refuse("specimen between clamps",
               "it has no stable equilibrium beyond a stretch of " + number_text(stretch_),
               "use a smaller range of the record, or a law that stays stable there");
    }
  }

  /// N, along z on the part of the clamp that the model has.
  double force() const {
    Eigen::VectorXd f;
    loose_.forces(u_, f);
    double sum = 0;
    for (int node = 0; node < loose_.mesh().nodes(); ++node)
      if (model_.mesh().fixed[to_index(node)]) sum += f[loose_.equation(node) + 2];
    return sum;
  }

 private:
  /// Newton's method with steps that halve until the residual does not grow.
  bool equilibrate(Displacement& u) {
    Eigen::VectorXd r, next;
    if (!(model_.forces(u, r).min_J > 0)) return false;
    std::vector<double> K;
    for (int i = 0; i < kMostIterations; ++i) {
      if (r.norm() <= kTolerance * clamp_force(u)) return true;
      model_.stiffness(u, K);
      if (!factor_.factorize(K)) return false;
      Eigen::VectorXd d(r.size());
      factor_.solve(r.data(), d.data(), workspace_);
      double length = 1;
      for (int halving = 0;; ++halving, length *= 0.5) {
        if (halving > kMostHalvings) return false;
        Displacement trial = u;
        add_step(model_, -length, d, trial);
        if (!(model_.forces(trial, next).min_J > 0)) continue;
        // The first steps from a stretched start may raise it.
        if (i > 0 && next.norm() > r.norm()) continue;
        u = trial;
        break;
      }
      r = next;
    }
    return false;
  }

  /// A scale of the forces of the specimen.
  double clamp_force(const Displacement& u) const {
    Eigen::VectorXd f;
    loose_.forces(u, f);
    return f.norm();
  }

  SolidModel model_, loose_;
  Cholesky factor_;
  SolveWorkspace workspace_;
  Displacement u_;
  double stretch_ = 1;
};

void check(const ClampedSpecimen& s, const std::vector<double>& stretches) {
  const bool round = s.diameter > 0;
  if (!(s.length > 0) || !(round || (s.width > 0 && s.thickness > 0)))
    refuse("specimen between clamps", "its size is not given",
           "give its length, and width and thickness or a diameter");
  for (const double stretch : stretches)
    if (!(stretch > 0))
      refuse("specimen between clamps", "a stretch of " + number_text(stretch) + " is not positive",
             "give stretches, not strains");
}

}  // namespace

double ClampedSpecimen::area() const {
  return diameter > 0 ? std::numbers::pi * diameter * diameter / 4 : width * thickness;
}

std::vector<double> clamped_stress(const ClampedSpecimen& specimen,
                                   const std::vector<double>& stretches) {
  check(specimen, stretches);
  check_law(specimen.law, "law of the specimen");
  const double end = 0.5 * specimen.length;
  const Body loose = half(specimen, kPlanes * rest_moduli(specimen.law).mu() / end);
  Body clamped = loose;
  fix_where(clamped, [&](const Vec3& x) { return x[2] > end * (1 - 1e-9); });
  ClampedPath path(loose, clamped, specimen.law);
  // Of a bar the model is a quarter of the section, of a cylinder a polygonal sector.
  double part = 0.25 * specimen.area();
  if (specimen.diameter > 0) {
    const double angle = 2 * std::numbers::pi / kSectors;
    part = 0.125 * specimen.diameter * specimen.diameter * std::sin(angle);
  }
  std::vector<double> stress;
  for (const double stretch : stretches) {
    path.stretch_to(stretch);
    stress.push_back(path.force() / part);
  }
  return stress;
}

}  // namespace palpate::fem
