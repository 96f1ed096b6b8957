// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool on its way from one equilibrium to the next.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fem/contact/contact_patch.hpp"

namespace palpate::fem {

/// A tool that is pressed in meets one quadrature point of the surface after the other: its force
/// is a smooth function of its travel only between them, and no polynomial through the ends of the
/// increments follows it. So the force is found at the points of Gauss's rule, with the contact as
/// it is and the solid condensed onto the unknowns of the patch,
///   min over d of r . d + d S' d / 2 + E_c(u + d),   r = -dE_c/du at the first equilibrium u,
/// S' being S, the stiffness of the solid as the patch feels it, after one BFGS update [Nocedal &
/// Wright 2006, eq. 6.19] by the second equilibrium: the forces at both ends are those of the
/// solver. Of a linear solid the work is exact but for Gauss's rule whatever the contact, if S is
/// its own; otherwise the error of an increment h is of third order. Forces alone enter, no energy.
/// @param patch  of the contact at both equilibria; it is made to start from the first
/// @param contact  at the second equilibrium; `from`: where the tip of the tool was at the first,
///   from where it moved in a straight line, m
/// @return J; nothing where the patch does not cover the contact, is empty, or where the forces
///   fell while the surface was moved (no stiffness has both ends).
std::optional<double> work_between(ContactPatch& patch, const PatchStiffness& stiffness,
                                   const ToolContact& contact, const Eigen::Vector3d& from,
                                   const Displacement& before, const Displacement& after);

}  // namespace palpate::fem
