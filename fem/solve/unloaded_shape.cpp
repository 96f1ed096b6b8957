// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/unloaded_shape.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "fem/mesh/point_text.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/anderson.hpp"
#include "fem/solve/partial_weight.hpp"
#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::fem {

namespace {

constexpr double kShapeTolerance = 1e-6;  ///< distance over the largest displacement
constexpr double kRounding = 1e-12;       ///< distance over the extent of the body
constexpr int kShapeIterations = 60;
constexpr int kMostEquilibria = 200;               ///< of all parts
constexpr double kDivergence = 4;                  ///< distance over the smallest so far
constexpr double kSmallestPartOfShape = 1.0 / 64;  ///< of the weight, applied at once
constexpr double kSmallestVolume = 0.05;           ///< of an element over its given volume
constexpr int kShapeHalvings = 6;                  ///< of a change of the shape

/// Edges of an element from its first corner.
Eigen::Matrix3d edges_at(const Eigen::Matrix3Xd& X, const Tetrahedron& t) {
  Eigen::Matrix3d D;
  for (int c = 0; c < 3; ++c) D.col(c) = X.col(t[to_index(c + 1)]) - X.col(t[0]);
  return D;
}

class UnloadedShape {
 public:
  UnloadedShape(const Body& given, const std::vector<Law>& laws, Dilatation dilatation,
                const Gravity& gravity, const std::vector<int>& permutation,
                const PreloadOptions& options)
      : given_(given),
        laws_(laws),
        dilatation_(dilatation),
        gravity_(gravity),
        permutation_(permutation),
        resources_(options.resources),
        counter_(options.progress),
        mesh_(make_quadratic_mesh(given, is_linear(dilatation))),
        x_(mesh_.X.leftCols(mesh_.corners())),
        X_(x_),
        u_(Displacement::Zero(3, mesh_.nodes())) {}

  UnloadedBody find() {
    double carried = 0, part = 1;
    while (carried < 1) {
      const Eigen::Matrix3Xd X = X_;
      const Displacement u = u_;
      const double next = std::min(1.0, carried + part);
      if (iterate(next)) {
        carried = next;
        counter_.carry(carried);
        continue;
      }
      X_ = X;
      u_ = u;
      part *= 0.5;
      if (part < kSmallestPartOfShape || counter_.now().shapes > kMostEquilibria)
        refuse_shape(carried);
    }
    Body body = moved_body();
    for (const Edge& ends : edges_of(body.boundary)) add_curved_edge(ends, body);
    SolidModel model = model_of(body);
    return {std::move(body), std::move(model), std::move(u_), distance_, counter_.now().shapes};
  }

 private:
  /// Moves X_ and u_ to the shape without weight where the given one carries `part` of it.
  bool iterate(double part) {
    Anderson anderson;
    double nearest = std::numeric_limits<double>::infinity();
    const double extent = (x_.rowwise().maxCoeff() - x_.rowwise().minCoeff()).norm();
    for (int i = 0; i < kShapeIterations; ++i) {
      counter_.count_shape();
      const SolidModel model = model_of(moved_body());
      if (!equilibrate(model, part))
        return failed("the body finds no equilibrium on the way to it");
      const Eigen::Matrix3Xd gap = x_ - X_ - u_.leftCols(x_.cols());
      distance_ = gap.colwise().norm().maxCoeff();
      const double sag = u_.colwise().norm().maxCoeff();
      if (distance_ <= std::max(kShapeTolerance * sag, kRounding * extent)) return true;
      if (distance_ > kDivergence * nearest) return failed("the iteration diverges");
      nearest = std::min(nearest, distance_);
      if (!change_shape(anderson.step(X_, gap))) return false;
    }
    return failed("it is still off by " + length_text(nearest) + " after " +
                  std::to_string(kShapeIterations) + " iterations");
  }

  /// From the last displacement; where that is no good start from none, in parts.
  bool equilibrate(const SolidModel& model, double part) {
    PartialWeight weight(model, permutation_, resources_, &counter_);
    if (weight.equilibrate(part, u_) == PartialWeight::Outcome::Found) return true;
    u_.setZero();
    double carried = 0, step = part;
    while (carried < part) {
      Displacement u = u_;
      const double next = std::min(part, carried + step);
      if (weight.equilibrate(next, u) == PartialWeight::Outcome::Found) {
        u_.swap(u);
        carried = next;
      } else if ((step *= 0.5) < kSmallestPartOfShape * part) {
        return false;
      }
    }
    return true;
  }

  /// Moves X_ by d, or a part of it, so that no element is inverted; the deformed body moves to the
  /// given shape.
  bool change_shape(Eigen::Matrix3Xd d) {
    std::size_t worst = 0;
    for (int halvings = 0; halvings < kShapeHalvings; ++halvings, d *= 0.5) {
      if (smallest_volume(X_ + d, worst) < kSmallestVolume) continue;
      X_ += d;
      const Eigen::Matrix3Xd gap = x_ - X_ - u_.leftCols(x_.cols());
      u_.leftCols(x_.cols()) += gap;
      for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
        u_.col(x_.cols() + static_cast<Eigen::Index>(e)) +=
            0.5 * (gap.col(mesh_.edges[e][0]) + gap.col(mesh_.edges[e][1]));
      for (int node = 0; node < mesh_.nodes(); ++node)
        if (mesh_.fixed[to_index(node)]) u_.col(node).setZero();
      return true;
    }
    const Tetrahedron& t = given_.tetrahedra[worst];
    return failed("its element at " + point_text(x_(Eigen::all, t).rowwise().mean()) +
                  " would be inverted without weight");
  }

  double smallest_volume(const Eigen::Matrix3Xd& X, std::size_t& worst) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < given_.tetrahedra.size(); ++e) {
      const Tetrahedron& t = given_.tetrahedra[e];
      const double ratio = edges_at(X, t).determinant() / edges_at(x_, t).determinant();
      if (ratio >= smallest) continue;
      smallest = ratio;
      worst = e;
    }
    return smallest;
  }

  Body moved_body() const {
    Body body = given_;
    for (std::size_t i = 0; i < body.nodes.size(); ++i)
      body.nodes[i] = to_vec3(X_.col(static_cast<Eigen::Index>(i)));
    body.curved_edges.clear();
    return body;
  }

  SolidModel model_of(const Body& body) const {
    return {body, laws_, dilatation_, gravity_, pulled_back_fibres()};
  }

  std::vector<std::array<Vec3, 2>> pulled_back_fibres() const {
    std::vector<std::array<Vec3, 2>> fibres;
    for (std::size_t e = 0; e < given_.tetrahedra.size(); ++e) {
      const Tetrahedron& t = given_.tetrahedra[e];
      const Eigen::Vector3d centroid = x_(Eigen::all, t).rowwise().mean();
      fibres.push_back(laws_[to_index(given_.tetrahedron_region[e])].fibres_at(to_vec3(centroid)));
      const Eigen::Matrix3d inverse_F = edges_at(X_, t) * edges_at(x_, t).inverse();
      for (Vec3& a : fibres.back())
        if (norm(a) > 0) a = to_vec3((inverse_F * to_eigen(a)).normalized());
    }
    return fibres;
  }

  void add_curved_edge(const Edge& ends, Body& body) const {
    const auto found = edge_node_.find(ends);
    body.curved_edges.push_back(
        {ends, to_vec3(mesh_.X.col(found->second) - u_.col(found->second))});
  }

  bool failed(std::string reason) {
    reason_ = std::move(reason);
    return false;
  }

  [[noreturn]] void refuse_shape(double carried) const {
    char beyond[32];
    std::snprintf(beyond, sizeof beyond, "%.3g", 100 * carried);
    refuse_geometry("gravity on " + given_.name,
                    "no shape without weight is found beyond " + std::string(beyond) +
                        " % of the weight: " + reason_,
                    "check the direction and the unit of gravity.acceleration, the density, the "
                    "stiffness and the supports, or give the shape without weight with "
                    "gravity.shape = \"unloaded\"");
  }

  static std::map<Edge, int> nodes_of_edges(const QuadraticMesh& mesh) {
    std::map<Edge, int> node;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      node.emplace(edge_between(mesh.edges[e][0], mesh.edges[e][1]),
                   mesh.corners() + static_cast<int>(e));
    return node;
  }

  const Body& given_;
  const std::vector<Law>& laws_;
  Dilatation dilatation_;
  const Gravity& gravity_;
  const std::vector<int>& permutation_;
  FactorResources resources_;
  PreloadCounter counter_;
  QuadraticMesh mesh_;  ///< of the given shape
  std::map<Edge, int> edge_node_ = nodes_of_edges(mesh_);
  Eigen::Matrix3Xd x_, X_;  ///< corner nodes: as given, without weight
  Displacement u_;
  double distance_ = 0;
  std::string reason_;
};

}  // namespace

UnloadedBody find_unloaded_body(const Body& given, const std::vector<Law>& laws,
                                Dilatation dilatation, const Gravity& gravity,
                                const std::vector<int>& permutation,
                                const PreloadOptions& options) {
  return UnloadedShape(given, laws, dilatation, gravity, permutation, options).find();
}

}  // namespace palpate::fem
