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
constexpr double kDifference = 1e-6;  ///< of the stretch, for the tangent of the path
constexpr int kSectors = 12;          ///< of a cylinder
/// Cells at the edges, over the smallest half width or length; they grow to the middle.
constexpr int kBarCells = 2, kCylinderCells = 5;
constexpr double kGrowth = 1.5;

/// From the middle, 0, to an edge at `end`, with the smallest cells at the edge: there the clamp
/// ends, and stresses are singular.
std::vector<double> cells_to_edge(double end, double smallest, double cell) {
  std::vector<double> at = graded_cells(end, smallest, cell, kGrowth);
  std::reverse(at.begin(), at.end());
  for (double& x : at) x = end - x;
  at.front() = 0;
  return at;
}

/// The part of the specimen from its middle, z = 0, to the clamp, which is fixed: its displacement
/// is prescribed.
Body half(const ClampedSpecimen& s, double stiffness) {
  const double end = 0.5 * s.length;
  const double smallest = s.diameter > 0 ? 0.5 * s.diameter : 0.5 * std::min(s.width, s.thickness);
  const double least = std::min(smallest, end),
               cell = least / (s.diameter > 0 ? kCylinderCells : kBarCells);
  const auto across = [&](double size) { return cells_to_edge(size, least, cell); };
  Body body;
  if (s.diameter > 0) {
    const double angle = 2 * std::numbers::pi / kSectors;
    // The polygon has the area of the circle.
    const double radius = 0.5 * s.diameter * std::sqrt(angle / std::sin(angle));
    body = grid_body({across(radius), {0, angle}, across(end)}, [](const Vec3& x) {
      return Vec3{x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]};
    });
    slide_where(
        body,
        [=](const Vec3& x) {
          return std::abs(x[0] * std::sin(angle) - x[1] * std::cos(angle)) < 1e-9 * radius;
        },
        stiffness);
  } else {
    body = grid_body({across(0.5 * s.width), across(0.5 * s.thickness), across(end)},
                     [](const Vec3& x) { return x; });
    slide_where(
        body, [](const Vec3& x) { return x[0] == 0; }, stiffness);
  }
  slide_where(
      body, [](const Vec3& x) { return x[1] == 0; }, stiffness);
  slide_where(
      body, [](const Vec3& x) { return x[2] == 0; }, stiffness);
  return body;
}

/// Equilibria of the specimen at displacements of its clamp. Near nu = 1/2 the elements have
/// multipliers, which step with every step of Newton's method.
class ClampedPath {
 public:
  ClampedPath(const Body& loose, const Body& clamped, const LawConstants& law)
      : model_(clamped, {make_law(law, "specimen")}),
        loose_(loose, {make_law(law, "specimen")}),
        factor_(model_.pattern()),
        multipliers_(model_.multipliers()),
        u_(Displacement::Zero(3, model_.mesh().nodes())) {}

  /// From the present state to this stretch, in steps that shrink where one fails.
  void stretch_to(double stretch) {
    double step = kLargestStep;
    while (stretch_ != stretch) {
      const double change = std::clamp(stretch - stretch_, -step, step);
      Displacement u = u_;
      DilatationMultipliers multipliers = multipliers_;
      if (predict(change, u) && equilibrate(u, multipliers)) {
        u_ = u;
        multipliers_ = multipliers;
        stretch_ = std::abs(stretch_ + change - stretch) < 1e-12 ? stretch : stretch_ + change;
        continue;
      }
      step = 0.5 * std::abs(change);
      if (step < kSmallestStep)
        refuse("specimen between clamps",
               "it has no stable equilibrium beyond a stretch of " + number_text(stretch_),
               "use a smaller range of the record, or a law that stays stable there");
    }
  }

  /// N, along z on the part of the clamp that the model has.
  double force() const {
    Eigen::VectorXd f;
    loose_.forces(u_, f, &multipliers_);
    double sum = 0;
    for (int node = 0; node < loose_.mesh().nodes(); ++node)
      if (model_.mesh().fixed[to_index(node)]) sum += f[loose_.equation(node) + 2];
    return sum;
  }

 private:
  /// Along the tangent of the path: a start that keeps the volume to first order. A stretch of
  /// every plane alike would not, and its pressures would be those of the bulk modulus.
  bool predict(double change, Displacement& u) {
    Displacement moved = u;
    moved.row(2) += kDifference * model_.mesh().X.row(2);
    Eigen::VectorXd at, near;
    model_.forces(u, at, &multipliers_);
    if (!(model_.forces(moved, near, &multipliers_).min_J > 0)) return false;
    Eigen::VectorXd d((near - at) / kDifference);
    if (!solve(u, multipliers_, d)) return false;
    u.row(2) += change * model_.mesh().X.row(2);
    add_step(model_, -change, d, u);
    return true;
  }

  /// Newton's method with steps that halve until the residual does not grow.
  bool equilibrate(Displacement& u, DilatationMultipliers& multipliers) {
    Eigen::VectorXd r;
    for (int i = 0; i < kMostIterations; ++i) {
      if (!(model_.forces(u, r, &multipliers).min_J > 0)) return false;
      if (r.norm() <= kTolerance * force_scale(u, multipliers)) return true;
      Eigen::VectorXd d = r;
      if (!solve(u, multipliers, d)) return false;
      if (!step(-d, r.norm(), u, multipliers)) return false;
      model_.update(u, multipliers);
    }
    return false;
  }

  bool step(const Eigen::VectorXd& d, double residual, Displacement& u,
            const DilatationMultipliers& multipliers) const {
    Eigen::VectorXd next;
    double length = 1;
    for (int halving = 0; halving <= kMostHalvings; ++halving, length *= 0.5) {
      Displacement trial = u;
      add_step(model_, length, d, trial);
      if (!(model_.forces(trial, next, &multipliers).min_J > 0) || next.norm() > residual) continue;
      u = trial;
      return true;
    }
    return false;
  }

  /// d <- K^-1 d. @return whether K is positive definite.
  bool solve(const Displacement& u, const DilatationMultipliers& multipliers, Eigen::VectorXd& d) {
    model_.stiffness(u, values_, &multipliers);
    if (!factor_.factorize(values_)) return false;
    factor_.solve(d.data(), d.data(), workspace_);
    return true;
  }

  /// The forces on the clamp, all together.
  double force_scale(const Displacement& u, const DilatationMultipliers& multipliers) const {
    Eigen::VectorXd f;
    loose_.forces(u, f, &multipliers);
    return f.norm();
  }

  SolidModel model_, loose_;
  Cholesky factor_;
  SolveWorkspace workspace_;
  std::vector<double> values_;  ///< of the stiffness
  DilatationMultipliers multipliers_;
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
  use_one_thread_per_site();  // the fronts are small: more threads wait for each other
  const double end = 0.5 * specimen.length;
  const Body loose = half(specimen, kPlanes * rest_moduli(specimen.law).mu() / end);
  Body clamped = loose;
  fix_where(clamped, [&](const Vec3& x) { return x[2] > end * (1 - 1e-9); });
  ClampedPath path(loose, clamped, specimen.law);
  // Of a bar the model has a quarter of the section, of a cylinder a sector.
  const double part = specimen.area() / (specimen.diameter > 0 ? kSectors : 4);
  std::vector<double> stress;
  for (const double stretch : stretches) {
    path.stretch_to(stretch);
    stress.push_back(path.force() / part);
  }
  return stress;
}

}  // namespace palpate::fem
