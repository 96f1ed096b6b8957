// SPDX-License-Identifier: AGPL-3.0-or-later
// Contact of the boundary with a rigid sphere, enforced at quadrature points of the quadratic
// facets by an augmented Lagrangian [Simo & Laursen 1992].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/solid_model.hpp"

namespace palpate::fem {

struct Sphere {
  Eigen::Vector3d centre;
  double radius;
};

/// Frictionless unilateral contact before bond(), then stuck: the points that were in contact
/// follow the tool in all directions, the others stay unilateral.
///   unilateral: p = max(0, lambda - eps g), g = |x - centre| - radius, force on the body p n
///   stuck:      t = lambda + eps (x - x_tool), force on the body -t
/// Each point carries the reference area w of its share of the facet; the energy is
///   sum w (p^2 - lambda^2)/(2 eps)   and   sum w (lambda . s + eps/2 s^2), s = x - x_tool.
class SphereContact {
 public:
  /// Candidates: the boundary facets with a node within `reach` of `site` in the rest state.
  /// `stiffness`: eps, N/m^3.
  SphereContact(const SolidModel& model, const Eigen::Vector3d& site, double reach,
                double stiffness);

  void move_to(const Sphere& tool);

  double energy(const Displacement& u) const;
  void add_forces(const Displacement& u, Eigen::VectorXd& f) const;  ///< adds d(energy)/du
  /// Adds d2(energy)/du2 to the values of the stiffness pattern. The geometric term -p/|x-c| (I -
  /// nn^T) is negative: it is left out when `geometric` is false.
  void add_stiffness(const Displacement& u, bool geometric, std::vector<double>& values) const;

  /// Multiplier update lambda <- p at the present state. Returns the largest gap error, m:
  /// penetration of active points, and the distance between stuck points and the tool.
  double augment(const Displacement& u);

  /// Hold the points now in contact to the tool, with their present tractions.
  void bond(const Displacement& u);

  Eigen::Vector3d tool_force(const Displacement& u) const;  ///< of the tool ON the body, N
  double contact_area(const Displacement& u) const;         ///< m^2, reference
  double penetration(const Displacement& u) const;          ///< m, deepest
  /// Largest depth of a candidate point of the rest surface inside `tool`.
  double rest_penetration(const Sphere& tool) const;

 private:
  struct Point {
    int facet;                ///< index into facets_
    std::array<double, 6> N;  ///< shape functions of the facet at the point
    double area;              ///< weight times reference area
    bool stuck = false;
    double lambda = 0;         ///< Pa, unilateral multiplier
    Eigen::Vector3d traction;  ///< Pa, stuck multiplier
    Eigen::Vector3d arm;       ///< stuck: position relative to the centre of the tool
  };

  Eigen::Vector3d position(const Point& point, const Displacement& u) const;
  /// Derivative of the energy of a point by its position, per unit area.
  Eigen::Vector3d gradient(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Matrix3d hessian(const Point& point, const Eigen::Vector3d& x, bool geometric) const;

  const SolidModel* model_;
  double eps_;
  Sphere tool_{Eigen::Vector3d::Zero(), 0};
  std::vector<Facet> facets_;
  std::vector<Point> points_;
};

}  // namespace palpate::fem
