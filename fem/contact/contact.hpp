// SPDX-License-Identifier: AGPL-3.0-or-later
// Contact of the boundary with a rigid tool, enforced by a penalty at quadrature points of the
// quadratic facets.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// What is nearer than this to a no-slip tool at first touch is bonded to it, over its radius.
inline constexpr double kTouching = 1e-6;

/// Scales of the contact penalty and of the ties.
struct ContactStiffness {
  double contact;  ///< eps, N/m^3, of the surface against the tool
  double young;    ///< E, Pa, of the solid at the surface
};

/// An equilibrium from which an increment starts.
struct IncrementStart {
  Displacement u;
  Eigen::Vector3d tip;  ///< m, of the tool
};

/// Frictionless unilateral contact; after bond() the surface in contact also follows the tool.
///   contact: p = max(0, -eps g), g the signed distance to the tool, n its normal at x; force p n
///            on the body, at quadrature points of reference area w
///   tie:     force -k s on a node, s = x - x_tool less its value when the tie was made
/// with the energy sum w p^2/(2 eps) + sum k s^2/2. Of the area A around a node (the integral of
/// the positive part of its shape function) a fraction phi is in contact when the tie is made:
///   k = c E sqrt(A) phi/(1.001 - phi).
/// Where phi = 1 the tie is a thousand times as stiff as the elements behind it, elsewhere about as
/// stiff as they are, the scale of Nitsche's method: a rigid tie would bond whole facets, and the
/// bonded patch would be half a facet too large all around. A tie is slack when it is made, so that
/// bonding changes neither force nor energy.
class ToolContact {
 public:
  /// Candidates: the boundary facets with a node within `reach` of `site` in the rest state.
  ToolContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
              const ContactStiffness& stiffness);

  void move_to(const Tool& tool);
  const Tool& tool() const { return tool_; }

  const std::vector<Facet>& facets() const { return facets_; }

  /// A quadrature point of a facet.
  struct Point {
    int facet;                ///< index into facets()
    std::array<double, 6> N;  ///< shape functions of the facet at the point
    double area;              ///< m^2, reference
    double fraction;          ///< of the facet
    bool beneath = true;      ///< sharp disc: whether the point is beneath its end
  };
  /// A spring between a node and the tool.
  struct Tie {
    int node;
    double stiffness;     ///< k, N/m
    Eigen::Vector3d arm;  ///< position relative to the tip of the tool when it was made
  };
  const std::vector<Point>& points() const { return points_; }
  const std::vector<Tie>& ties() const { return ties_; }

  // Kernels: energies of one point or tie and their derivatives by its position x. Those of a point
  // are per unit area.
  Eigen::Vector3d position(const Point& point, const Displacement& u) const;
  Eigen::Vector3d position(const Tie& tie, const Displacement& u) const {
    return mesh_->X.col(tie.node) + u.col(tie.node);
  }
  /// The distance to a sharp disc jumps at its edge. Which points are beneath its end is decided
  /// when the surface is bonded; until then they meet the plane of the end.
  double gap(const Point& point, const Eigen::Vector3d& x) const;
  double energy_at(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Vector3d gradient_at(const Point& point, const Eigen::Vector3d& x) const;
  Eigen::Matrix3d hessian_at(const Point& point, const Eigen::Vector3d& x, bool geometric) const;
  double energy_at(const Tie& tie, const Eigen::Vector3d& x) const {
    return 0.5 * tie.stiffness * slip(tie, x).squaredNorm();
  }
  Eigen::Vector3d gradient_at(const Tie& tie, const Eigen::Vector3d& x) const {
    return tie.stiffness * slip(tie, x);
  }

  double energy(const Displacement& u) const;
  /// Adds d(energy)/du to the unknowns of `model`, any model of the same mesh.
  void add_forces(const SolidModel& model, const Displacement& u, Eigen::VectorXd& f) const;
  /// Adds d2(energy)/du2 to the values of the pattern of `model`. The geometric term -p d2g/dx2 is
  /// negative: it is left out when `geometric` is false.
  void add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
                     std::vector<double>& values) const;

  /// Ties the surface in contact, or nearer than `closeness`, m, to the tool. Nodes with ties get
  /// further ones where their fraction in contact has grown.
  void bond(const Displacement& u, double closeness = 0);
  /// The same at the end of an increment of a press: what has touched within it has stuck since,
  /// so that a tie is slack not at the present position x, but where its node touched. Points touch
  /// in the order of their gaps at the start, and the area in contact grows in proportion to the
  /// travel, as that of a sphere does [Hertz 1882]. Along the tool, across its normal n, nothing
  /// has held a node: of its motion m relative to the tool it has made 1 - beta since it touched
  /// at the fraction beta of the increment:
  ///   arm = x - tip - (1 - beta) (I - n n^T) m,   m = (x - tip) - (x - tip at the start).
  /// @return whether there are new ties: what they pull at is not in equilibrium yet
  bool bond_since(const IncrementStart& start, const Displacement& u);

  Eigen::Vector3d tool_force(const Displacement& u) const;  ///< of the tool ON the body, N
  /// Adds d(tool_force . direction)/du to the unknowns of `model`.
  void add_tool_force_gradient(const SolidModel& model, const Displacement& u,
                               const Eigen::Vector3d& direction, Eigen::VectorXd& g) const;
  /// Adds the effect of the arms of the ties that bond() has made since `before`: with E the energy
  /// and F = tool_force . direction at the present state, the derivative of -l . dE/du + F by the
  /// displacement at which the ties were made, on the unknowns of `model`. `l`: of all nodes.
  void add_bond_gradient(const SolidModel& model, const ToolContact& before, const Displacement& l,
                         const Eigen::Vector3d& direction, Eigen::VectorXd& g) const;
  /// The same for ties of bond_since(start, u) of `before`. Their arms depend on u and on start.u:
  /// the derivatives by both are added to `g` and `g_start`.
  void add_bond_gradient(const SolidModel& model, const ToolContact& before,
                         const IncrementStart& start, const Displacement& u, const Displacement& l,
                         const Eigen::Vector3d& direction, Eigen::VectorXd& g,
                         Eigen::VectorXd& g_start) const;
  double contact_area(const Displacement& u) const;  ///< m^2, reference
  /// How many facets are in contact, each by the fraction of it that is.
  double facets_in_contact(const Displacement& u) const;
  double penetration(const Displacement& u) const;  ///< m, deepest
  /// N, sum of the tensile forces of the ties on facets: without adhesion the surface would
  /// separate there.
  double tension(const Displacement& u) const;
  /// Where the tool touches a facet that a support fixes, m; nothing where it touches none.
  std::optional<Eigen::Vector3d> touch_of_support(const Displacement& u) const;
  /// Largest depth of a candidate point of the surface at `u` inside `tool`.
  double penetration_of(const Tool& tool, const Displacement& u) const;

 private:
  Eigen::Vector3d slip(const Tie& tie, const Eigen::Vector3d& x) const {
    return x - tool_.tip - tie.arm;
  }
  void decide_beneath(const Displacement& u);
  Gap gap_derivatives(const Eigen::Vector3d& x) const;
  /// The stiffness of a tie to each node in contact, or nearer than `closeness`.
  std::map<int, double> tie_stiffnesses(const Displacement& u, double closeness) const;
  /// Motion of a node relative to the tool since the start, m.
  Eigen::Vector3d motion_since(const IncrementStart& start, const Displacement& u, int node) const;
  /// When the area around each node came into contact in an increment, in the mean over that which
  /// did: 0 at its start, 1 at its end. Nodes around which none did are left out.
  std::map<int, double> touched_at(const IncrementStart& start, const Displacement& u) const;
  /// N, force of the tool on each facet along its normal, compression positive.
  std::vector<double> facet_forces(const Displacement& u) const;

  const QuadraticMesh* mesh_;
  double eps_, young_;
  Tool tool_;
  bool decided_ = false;  ///< whether decide_beneath() has been called
  std::vector<Facet> facets_;
  std::vector<Point> points_;
  std::vector<Tie> ties_;
};

}  // namespace palpate::fem
