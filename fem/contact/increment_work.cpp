// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/increment_work.hpp"

namespace palpate::fem {

namespace {

ToolContact with_tip_at(const ToolContact& contact, const Eigen::Vector3d& tip) {
  ToolContact moved = contact;
  Tool tool = contact.tool();
  tool.tip = tip;
  moved.move_to(tool);
  return moved;
}

/// N, of the tool on the unknowns of the model.
Eigen::VectorXd forces(const ToolContact& contact, const SolidModel& model, const Displacement& u) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(model.pattern().n);
  contact.add_forces(model, u, gradient);
  return -gradient;
}

/// v . (to - from)
double product(const SolidModel& model, const Eigen::VectorXd& v, const Displacement& from,
               const Displacement& to) {
  double sum = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (const int first = model.equation(node); first >= 0)
      sum += v.segment<3>(first).dot(to.col(node) - from.col(node));
  return sum;
}

}  // namespace

std::optional<double> work_between(const ToolContact& contact, const SolidModel& model,
                                   const Eigen::Vector3d& from, const Displacement& before,
                                   const Displacement& after) {
  const ToolContact start = with_tip_at(contact, from);
  const Eigen::VectorXd first = forces(start, model, before), last = forces(contact, model, after);
  const double on_solid = 0.5 * product(model, first + last, before, after);
  if (!(product(model, last - first, before, after) > 0)) return std::nullopt;
  return on_solid + contact.energy(after) - start.energy(before);
}

}  // namespace palpate::fem
