// SPDX-License-Identifier: AGPL-3.0-or-later
// A pressure that is linear in each element and continuous within a region, with quadratic
// displacements [Taylor & Hood 1973], its mass matrix lumped, so that it can be condensed node by
// node:
//   Pi_n = sum_n V_n U(Jbar_n),   Jbar_n = (1/V_n) sum_e sum_q w_q L_n(q) J_q,   V_n = sum w_q
//   L_n(q)
// over the corner nodes n, at an interface once for each region. The stiffness stays symmetric and
// positive definite; each node adds a matrix of rank one on all nodes of the elements around it.
// With linear displacements it is the node-averaged dilatation of Bonet & Burton 1998.
#pragma once

#include <vector>

#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// Which elements share the dilatation around which node. Immutable after construction.
class NodalPressure {
 public:
  struct Point {
    int place = 0;  ///< of its corner node and region, the same in every part of a mesh
    int region = 0;
    double volume = 0;                ///< V_n, m^3
    std::vector<std::int32_t> nodes;  ///< free nodes of the elements around it, ascending
  };

  NodalPressure() = default;
  /// The points around the corners of `elements`. `equation`: of each node, -1 where it is not
  /// free.
  NodalPressure(const QuadraticMesh& mesh, const std::vector<int>& elements,
                const std::vector<int>& equation);

  const std::vector<Point>& points() const { return points_; }
  /// Number of places, of which not all have points.
  std::size_t places() const { return point_at_.size(); }
  /// All elements with a point at a corner: those of the constructor and their neighbours.
  const std::vector<int>& elements() const { return elements_; }
  /// The points at the corners of an element, -1 where there is none.
  std::array<int, 4> points_of(const QuadraticMesh& mesh, int element) const;
  std::size_t bytes() const;

 private:
  std::size_t key(const QuadraticMesh& mesh, int element, std::size_t corner) const;

  int regions_ = 1;
  std::vector<int> point_at_;  ///< by corner node and region, -1: none
  std::vector<Point> points_;
  std::vector<int> elements_;
};

}  // namespace palpate::fem
