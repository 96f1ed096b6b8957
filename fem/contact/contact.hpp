// SPDX-License-Identifier: AGPL-3.0-or-later
// Contact of the boundary with a rigid tool, enforced by a penalty at quadrature points of the
// quadratic facets.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// How firmly a surface is held to the tool.
struct ContactStiffness {
  double contact;  ///< eps, N/m^3, of the surface against the tool
  double young;    ///< E, Pa, of the solid behind the surface
};

/// Frictionless unilateral contact; after bond() the surface in contact follows the tool as well.
///   contact: p = max(0, -eps g), g the signed distance to the tool, n its normal at x; force on
///   the
///            body p n, at quadrature points with the reference area w of their share of the facet
///   tie:     force on a node -k s, s = (x - x_tool) now minus then
/// with the energy sum w p^2/(2 eps) + sum k s^2/2. Of the surface A around a node (the integral of
/// the positive part of its shape function) a share phi is in contact when it is tied:
///   k = c E sqrt(A) phi/(1 - phi).
/// Where all of it is in contact, the tie is rigid. Where a part is, it is about as stiff as the
/// elements behind, the scale of Nitsche's method: a rigid tie there would hold whole facets, and
/// the stuck patch would be half a facet too large all around. A tie is slack when it is made, so
/// that bonding changes neither force nor energy.
class ToolContact {
 public:
  /// Candidates: the boundary facets with a node within `reach` of `site` in the rest state.
  ToolContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
              const ContactStiffness& stiffness);

  void move_to(const Tool& tool);
  const Tool& tool() const { return tool_; }

  const std::vector<Facet>& facets() const { return facets_; }

  double energy(const Displacement& u) const;
  /// Adds d(energy)/du to the unknowns of `model`, any model of the same mesh.
  void add_forces(const SolidModel& model, const Displacement& u, Eigen::VectorXd& f) const;
  /// Adds d2(energy)/du2 to the values of the pattern of `model`. The geometric term -p d2g/dx2 is
  /// negative: it is left out when `geometric` is false.
  void add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
                     std::vector<double>& values) const;

  /// Tie to the tool the surface in contact, or nearer than `closeness`, m. Nodes that are tied
  /// already are tied further where their share has grown.
  void bond(const Displacement& u, double closeness = 0);

  Eigen::Vector3d tool_force(const Displacement& u) const;  ///< of the tool ON the body, N
  /// Adds d(tool_force . direction)/du to the unknowns of `model`.
  void add_tool_force_gradient(const SolidModel& model, const Displacement& u,
                               const Eigen::Vector3d& direction, Eigen::VectorXd& g) const;
  /// Adds to the unknowns of `model` how the arms of the ties act that bond() has made since
  /// `before`: with E the energy and F = tool_force . direction at the present state, the
  /// derivative of -l . dE/du + F by the displacement at which they were made. `l`: of all nodes.
  void add_bond_gradient(const SolidModel& model, const ToolContact& before, const Displacement& l,
                         const Eigen::Vector3d& direction, Eigen::VectorXd& g) const;
  double contact_area(const Displacement& u) const;  ///< m^2, reference
  double penetration(const Displacement& u) const;   ///< m, deepest
  /// N, the pulls on facets that the ties draw off the body, added up: a surface that is not glued
  /// would let go.
  double tension(const Displacement& u) const;
  /// Largest depth of a candidate point of the surface at `u` inside `tool`.
  double penetration_of(const Tool& tool, const Displacement& u) const;

 private:
  friend class ContactPatch;

  struct Point {
    int facet;                ///< index into facets_
    std::array<double, 6> N;  ///< shape functions of the facet at the point
    double area;              ///< weight times reference area
    bool beneath = true;      ///< the end of a sharp disc: whether it is there
  };
  struct Tie {
    int node;
    double stiffness;     ///< k, N/m
    Eigen::Vector3d arm;  ///< position relative to the tip of the tool when it was made
  };

  Eigen::Vector3d position(const Point& point, const Displacement& u) const;
  Eigen::Vector3d position(int node, const Displacement& u) const {
    return mesh_->X.col(node) + u.col(node);
  }
  Eigen::Vector3d slip(const Tie& tie, const Eigen::Vector3d& x) const {
    return x - tool_.tip - tie.arm;
  }
  /// The distance jumps at the edge of a sharp disc. What is beneath its end is settled when the
  /// surface is tied, and meets the plane of the end until then.
  double gap(const Point& point, const Eigen::Vector3d& x) const;
  void settle_beneath(const Displacement& u);
  Gap gap_derivatives(const Eigen::Vector3d& x) const;
  /// Energy of a point at x per unit area, and its derivatives.
  double energy_at(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Vector3d gradient_at(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Matrix3d hessian_at(const Point& point, const Eigen::Vector3d& x, bool geometric) const;
  /// The stiffness of a tie to each node in contact, or nearer than `closeness`.
  std::map<int, double> tie_stiffnesses(const Displacement& u, double closeness) const;
  /// N, what the tool does to each facet along its normal: pushes, and pulls of the ties.
  std::vector<double> facet_pressures(const Displacement& u) const;

  const QuadraticMesh* mesh_;
  double eps_, young_;
  Tool tool_;
  bool settled_ = false;  ///< what is beneath a sharp disc was told once
  std::vector<Facet> facets_;
  std::vector<Point> points_;
  std::vector<Tie> ties_;
};

}  // namespace palpate::fem
