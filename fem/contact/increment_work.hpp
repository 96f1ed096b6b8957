// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool between two equilibria.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fem/contact/contact.hpp"

namespace palpate::fem {

/// As the tool is pressed in, one quadrature point after the other comes into contact, so that no
/// polynomial through the forces at the ends of an increment approximates the work well. What the
/// tool does goes into the solid and into the contact. The forces F on the nodes in contact are a
/// smooth function of the motion p of these nodes, whatever the contact does, and the energy E_c of
/// the contact is known:
///   W = (F0 + F1) . p / 2 + E_c(u1) - E_c(u0).
/// On a linear solid this is exact; otherwise the error of an increment h is of third order.
/// No energy of the solid enters.
/// @param contact  at the second equilibrium
/// @param from  tip of the tool at the first equilibrium, m
/// @param before, after  the equilibria u0 and u1
/// @return J; nothing where the solid yields as it is loaded, (F1 - F0) . p <= 0: a part of it has
///   snapped, and has lost energy on the way.
std::optional<double> work_between(const ToolContact& contact, const SolidModel& model,
                                   const Eigen::Vector3d& from, const Displacement& before,
                                   const Displacement& after);

}  // namespace palpate::fem
