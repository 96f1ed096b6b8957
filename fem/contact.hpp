// SPDX-License-Identifier: AGPL-3.0-or-later
// Contact of the boundary with a rigid tool, enforced by a penalty at quadrature points of the
// quadratic facets.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/solid_model.hpp"
#include "fem/tool.hpp"

namespace palpate::fem {

/// Frictionless unilateral contact before bond(), then stuck: the points that were in contact
/// follow the tool in all directions, the others stay unilateral.
///   unilateral: p = max(0, -eps g), g the signed distance to the tool, n its normal at x; force on
///               the body p n
///   stuck:      t = t0 + eps_s (x - x_tool), force on the body -t, t0 = -p n where it was bonded
/// Each point carries the reference area w of its share of the facet; the energy is
///   sum w p^2/(2 eps)   and   sum w (t0^2/(2 eps) + t0 . s + eps_s/2 s^2), s = x - x_tool,
/// so that bonding changes neither force nor energy.
/// Stuck facets can follow the tool exactly, so a far larger eps_s constrains nothing too much.
class ToolContact {
 public:
  /// Candidates: the boundary facets with a node within `reach` of `site` in the rest state.
  /// `stiffness`: eps, N/m^3.
  ToolContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
              double stiffness);

  void move_to(const Tool& tool);

  double energy(const Displacement& u) const;
  /// Adds d(energy)/du to the unknowns of `model`, any model of the same mesh.
  void add_forces(const SolidModel& model, const Displacement& u, Eigen::VectorXd& f) const;
  /// Adds d2(energy)/du2 to the values of the pattern of `model`. The geometric term -p d2g/dx2 is
  /// negative: it is left out when `geometric` is false.
  void add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
                     std::vector<double>& values) const;

  /// Hold the points now in contact to the tool, with their present tractions; also those that are
  /// nearer than `closeness`, m, without any.
  void bond(const Displacement& u, double closeness = 0);

  Eigen::Vector3d tool_force(const Displacement& u) const;  ///< of the tool ON the body, N
  /// Adds d(tool_force . direction)/du to the unknowns of `model`.
  void add_tool_force_gradient(const SolidModel& model, const Displacement& u,
                               const Eigen::Vector3d& direction, Eigen::VectorXd& g) const;
  double contact_area(const Displacement& u) const;  ///< m^2, reference
  double penetration(const Displacement& u) const;   ///< m, deepest
  /// N, the pulls of stuck points on the body, added up: a surface that is not glued would let go.
  double tension(const Displacement& u) const;
  /// Largest depth of a candidate point of the rest surface inside `tool`.
  double rest_penetration(const Tool& tool) const;

 private:
  friend class ContactPatch;

  struct Point {
    int facet;                ///< index into facets_
    std::array<double, 6> N;  ///< shape functions of the facet at the point
    double area;              ///< weight times reference area
    bool stuck = false;
    Eigen::Vector3d traction;  ///< Pa, stuck: t0
    Eigen::Vector3d arm;       ///< stuck: position relative to the tip of the tool
  };

  Eigen::Vector3d position(const Point& point, const Displacement& u) const;
  double gap(const Eigen::Vector3d& x) const { return tool_.distance(x); }
  double energy(const Point& point, const Eigen::Vector3d& x) const;
  /// Derivative of the energy of a point by its position, per unit area.
  Eigen::Vector3d gradient(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Matrix3d hessian(const Point& point, const Eigen::Vector3d& x, bool geometric) const;

  const QuadraticMesh* mesh_;
  double eps_, stuck_eps_;
  Tool tool_;
  std::vector<Facet> facets_;
  std::vector<Point> points_;
};

}  // namespace palpate::fem
