// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/increment_work.hpp"

#include <array>

namespace palpate::fem {

namespace {

/// Gauss's rule on 0 .. 1.
struct Node {
  double at, weight;
};
constexpr std::array<Node, 5> kGauss{{{0.046910077030668, 0.118463442528095},
                                      {0.230765344947158, 0.239314335249683},
                                      {0.5, 0.284444444444444},
                                      {0.769234655052842, 0.239314335249683},
                                      {0.953089922969332, 0.118463442528095}}};

/// Residual at a Gauss point that the solve aims at, and the largest that is accepted, over the
/// forces at the end.
constexpr double kTarget = 1e-3, kAllowed = 1e-2;

ToolContact with_tip_at(const ToolContact& contact, const Eigen::Vector3d& tip) {
  ToolContact moved = contact;
  Tool tool = contact.tool();
  tool.tip = tip;
  moved.move_to(tool);
  return moved;
}

/// N, of the contact on the patch.
Eigen::VectorXd forces(ContactPatch& patch, const ToolContact& contact, const Displacement& u) {
  Eigen::VectorXd f;
  patch.start_from(contact, u);
  patch.gradient(contact, Eigen::VectorXd::Zero(patch.size()), f);
  return f;
}

double residual_norm(const ContactPatch& patch, const ToolContact& contact,
                     const Eigen::MatrixXd& S, const Eigen::VectorXd& load,
                     const Eigen::VectorXd& d) {
  Eigen::VectorXd contact_force;
  patch.gradient(contact, d, contact_force);
  return (S * d - load + contact_force).norm();
}

/// S updated so that S step = y.
std::optional<PatchStiffness> with_secant(const PatchStiffness& stiffness,
                                          const Eigen::VectorXd& step, const Eigen::VectorXd& y) {
  const Eigen::VectorXd Ss = stiffness.S * step;
  if (!(y.dot(step) > 0 && Ss.dot(step) > 0)) return std::nullopt;
  return PatchStiffness{
      stiffness.S + y * y.transpose() / y.dot(step) - Ss * Ss.transpose() / Ss.dot(step),
      stiffness.stiffening};
}

}  // namespace

std::optional<double> work_between(ContactPatch& patch, const PatchStiffness& stiffness,
                                   const ToolContact& contact, const Eigen::Vector3d& from,
                                   const Displacement& before, const Displacement& after) {
  ToolContact moved = with_tip_at(contact, from);
  if (patch.size() == 0 || !patch.covers(contact, after) || !patch.covers(moved, before))
    return std::nullopt;
  const Eigen::VectorXd step = patch.difference(before, after);
  const Eigen::VectorXd last = forces(patch, contact, after), first = forces(patch, moved, before);
  const auto secant = with_secant(stiffness, step, first - last);
  if (!secant) return std::nullopt;
  const Eigen::Vector3d travel = contact.tool().tip - from;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(patch.size());
  PatchSolver solver;
  solver.use(*secant);
  solver.expect(patch, contact, step);
  double work = 0, at = 0;
  for (const Node& node : kGauss) {
    moved = with_tip_at(contact, from + node.at * travel);
    // The minimum at the end is known: start on the way to it.
    d += (node.at - at) / (1 - at) * (step - d);
    at = node.at;
    const auto found = solver.minimum(patch, moved, first, d, kTarget * last.norm());
    if (!found || residual_norm(patch, moved, secant->S, first, *found) > kAllowed * last.norm())
      return std::nullopt;
    d = *found;
    work += node.weight * patch.tool_force(moved, d).dot(travel);
  }
  return work;
}

}  // namespace palpate::fem
