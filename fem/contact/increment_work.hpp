// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool between two equilibria.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fem/contact/patch_solver.hpp"

namespace palpate::fem {

/// As the tool is pressed in, one quadrature point after the other comes into contact. The force is
/// a smooth function of the travel only between these events, so that no polynomial through the
/// ends of the increments approximates it well. It is therefore computed at the points of Gauss's
/// rule, with the actual contact and the solid condensed onto the unknowns of the patch,
///   min over d of r . d + d S' d / 2 + E_c(u + d),   r = -dE_c/du at the first equilibrium u.
/// S' is S, the condensed stiffness of the solid, after one BFGS update [Nocedal & Wright 2006,
/// eq. 6.19] by the second equilibrium: the forces at both ends are those of the solver. For a
/// linear solid with its own S the work is exact but for Gauss's rule, whatever the contact;
/// otherwise the error of an increment h is of third order. Only forces enter, no energies.
/// @param patch  covers the contact at both equilibria; it is set to start from the first
/// @param contact  at the second equilibrium
/// @param from  tip of the tool at the first equilibrium, m; the tool moved in a straight line
/// @return J; nothing where the patch is empty or does not cover the contact, or where the secant
///   stiffness is not positive.
std::optional<double> work_between(ContactPatch& patch, const PatchStiffness& stiffness,
                                   const ToolContact& contact, const Eigen::Vector3d& from,
                                   const Displacement& before, const Displacement& after);

}  // namespace palpate::fem
