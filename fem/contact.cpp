// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate::fem {

namespace {

struct TrianglePoint {
  double L0, L1, weight;
};

/// The 12-point rule of degree 6 with positive weights [Dunavant 1985].
std::vector<TrianglePoint> triangle_rule() {
  std::vector<TrianglePoint> rule;
  const auto add_three = [&](double a, double b, double weight) {
    rule.push_back({a, b, weight});
    rule.push_back({b, a, weight});
    rule.push_back({b, b, weight});
  };
  add_three(0.501426509658179, 0.249286745170910, 0.116786275726379);
  add_three(0.873821971016996, 0.063089014491502, 0.050844906370207);
  const double c[3] = {0.053145049844817, 0.310352451033784, 0.636502499121399};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j) rule.push_back({c[i], c[j], 0.082851075618374});
  return rule;
}

std::array<double, 6> facet_shape(double L0, double L1) {
  const double L2 = 1 - L0 - L1;
  return {L0 * (2 * L0 - 1), L1 * (2 * L1 - 1), L2 * (2 * L2 - 1),
          4 * L0 * L1,       4 * L1 * L2,       4 * L2 * L0};
}

}  // namespace

namespace {

/// The tractions at the rim of a stuck patch are singular: their share of the energy, which falls
/// as 1/eps_s, is about 0.1 % of the stored energy with this where a coarse facet sticks in part.
constexpr double kStuckOverUnilateral = 300000;

}  // namespace

ToolContact::ToolContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
                         double stiffness)
    : mesh_(&mesh), eps_(stiffness), stuck_eps_(kStuckOverUnilateral * stiffness) {
  const auto& X = mesh.X;
  const auto rule = triangle_rule();
  for (const Facet& facet : mesh.facets) {
    const bool near = std::any_of(facet.begin(), facet.end(), [&](int node) {
      return (X.col(node) - site).squaredNorm() <= reach * reach;
    });
    if (!near) continue;
    const Eigen::Vector3d a = X.col(facet[1]) - X.col(facet[0]),
                          b = X.col(facet[2]) - X.col(facet[0]);
    const double area = 0.5 * a.cross(b).norm();
    for (const auto& q : rule) {
      Point point;
      point.facet = static_cast<int>(facets_.size());
      point.N = facet_shape(q.L0, q.L1);
      point.area = q.weight * area;
      point.traction.setZero();
      point.arm.setZero();
      points_.push_back(point);
    }
    facets_.push_back(facet);
  }
}

void ToolContact::move_to(const Tool& tool) {
  tool_ = tool;
}

Eigen::Vector3d ToolContact::position(const Point& point, const Displacement& u) const {
  const Facet& facet = facets_[at(point.facet)];
  const auto& X = mesh_->X;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < 6; ++a) x += point.N[a] * (X.col(facet[a]) + u.col(facet[a]));
  return x;
}

Eigen::Vector3d ToolContact::gradient(const Point& point, const Eigen::Vector3d& x) const {
  if (point.stuck) return point.traction + stuck_eps_ * (x - tool_.tip - point.arm);
  if (tool_.distance(x) >= 0) return Eigen::Vector3d::Zero();
  const Gap gap = tool_.gap(x);
  return eps_ * gap.distance * gap.normal;
}

Eigen::Matrix3d ToolContact::hessian(const Point& point, const Eigen::Vector3d& x,
                                     bool geometric) const {
  if (point.stuck) return stuck_eps_ * Eigen::Matrix3d::Identity();
  if (tool_.distance(x) >= 0) return Eigen::Matrix3d::Zero();
  const Gap gap = tool_.gap(x);
  Eigen::Matrix3d H = eps_ * gap.normal * gap.normal.transpose();
  if (geometric) H += eps_ * gap.distance * gap.curvature;
  return H;
}

double ToolContact::energy(const Point& point, const Eigen::Vector3d& x) const {
  if (!point.stuck) {
    const double overlap = std::min(0.0, tool_.distance(x));
    return 0.5 * eps_ * point.area * overlap * overlap;
  }
  const Eigen::Vector3d slip = x - tool_.tip - point.arm;
  return point.area * (point.traction.squaredNorm() / (2 * eps_) + point.traction.dot(slip) +
                       0.5 * stuck_eps_ * slip.squaredNorm());
}

double ToolContact::energy(const Displacement& u) const {
  double sum = 0;
  for (const Point& point : points_) sum += energy(point, position(point, u));
  return sum;
}

void ToolContact::add_forces(const SolidModel& model, const Displacement& u,
                             Eigen::VectorXd& f) const {
  for (const Point& point : points_) {
    const Eigen::Vector3d g = point.area * gradient(point, position(point, u));
    if (g.isZero(0)) continue;
    const Facet& facet = facets_[at(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      const int first = model.equation(facet[a]);
      if (first >= 0) f.segment<3>(first) += point.N[a] * g;
    }
  }
}

void ToolContact::add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
                                std::vector<double>& values) const {
  const SparsePattern& pattern = model.pattern();
  for (const Point& point : points_) {
    const Eigen::Matrix3d H = point.area * hessian(point, position(point, u), geometric);
    if (H.isZero(0)) continue;
    const Facet& facet = facets_[at(point.facet)];
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        const int row = model.equation(facet[a]), column = model.equation(facet[b]);
        if (row < 0 || column < 0) continue;
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            if (row + i >= column + k)
              values[at(pattern.position(row + i, column + k))] +=
                  point.N[a] * point.N[b] * H(i, k);
      }
  }
}

void ToolContact::bond(const Displacement& u, double closeness) {
  for (Point& point : points_) {
    const Eigen::Vector3d x = position(point, u);
    if (point.stuck || tool_.distance(x) >= closeness) continue;
    point.traction = gradient(point, x);
    point.arm = x - tool_.tip;
    point.stuck = true;
  }
}

Eigen::Vector3d ToolContact::tool_force(const Displacement& u) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Point& point : points_) force -= point.area * gradient(point, position(point, u));
  return force;
}

void ToolContact::add_tool_force_gradient(const SolidModel& model, const Displacement& u,
                                          const Eigen::Vector3d& direction,
                                          Eigen::VectorXd& g) const {
  for (const Point& point : points_) {
    const Eigen::Matrix3d H = hessian(point, position(point, u), true);
    if (H.isZero(0)) continue;
    const Eigen::Vector3d pull = point.area * H * direction;
    const Facet& facet = facets_[at(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      const int first = model.equation(facet[a]);
      if (first >= 0) g.segment<3>(first) -= point.N[a] * pull;
    }
  }
}

double ToolContact::contact_area(const Displacement& u) const {
  double area = 0;
  for (const Point& point : points_)
    if (point.stuck || !gradient(point, position(point, u)).isZero(0)) area += point.area;
  return area;
}

double ToolContact::penetration(const Displacement& u) const {
  double deepest = 0;
  for (const Point& point : points_)
    deepest = std::max(deepest, -tool_.distance(position(point, u)));
  return deepest;
}

double ToolContact::tension(const Displacement& u) const {
  double sum = 0;
  for (const Point& point : points_) {
    if (!point.stuck) continue;
    const Eigen::Vector3d x = position(point, u);
    sum += point.area * std::max(0.0, gradient(point, x).dot(tool_.gap(x).normal));
  }
  return sum;
}

double ToolContact::rest_penetration(const Tool& tool) const {
  double deepest = 0;
  const Displacement rest = Displacement::Zero(3, mesh_->nodes());
  for (const Point& point : points_)
    deepest = std::max(deepest, -tool.distance(position(point, rest)));
  return deepest;
}

}  // namespace palpate::fem
