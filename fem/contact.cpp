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

SphereContact::SphereContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
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

void SphereContact::move_to(const Sphere& tool) {
  tool_ = tool;
}

Eigen::Vector3d SphereContact::position(const Point& point, const Displacement& u) const {
  const Facet& facet = facets_[at(point.facet)];
  const auto& X = mesh_->X;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < 6; ++a) x += point.N[a] * (X.col(facet[a]) + u.col(facet[a]));
  return x;
}

Eigen::Vector3d SphereContact::gradient(const Point& point, const Eigen::Vector3d& x) const {
  const Eigen::Vector3d r = x - tool_.centre;
  if (point.stuck) return point.traction + stuck_eps_ * (r - point.arm);
  const double distance = r.norm();
  const double p = eps_ * std::max(0.0, tool_.radius - distance);
  return (-p / distance) * r;
}

Eigen::Matrix3d SphereContact::hessian(const Point& point, const Eigen::Vector3d& x,
                                       bool geometric) const {
  if (point.stuck) return stuck_eps_ * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d r = x - tool_.centre;
  const double distance = r.norm();
  const double p = eps_ * (tool_.radius - distance);
  if (p <= 0) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d nn = r * r.transpose() / (distance * distance);
  Eigen::Matrix3d H = eps_ * nn;
  if (geometric) H -= p / distance * (Eigen::Matrix3d::Identity() - nn);
  return H;
}

double SphereContact::energy(const Point& point, const Eigen::Vector3d& x) const {
  if (!point.stuck) {
    const double overlap = std::min(0.0, gap(x));
    return 0.5 * eps_ * point.area * overlap * overlap;
  }
  const Eigen::Vector3d slip = x - tool_.centre - point.arm;
  return point.area * (point.traction.dot(slip) + 0.5 * stuck_eps_ * slip.squaredNorm());
}

double SphereContact::energy(const Displacement& u) const {
  double sum = 0;
  for (const Point& point : points_) sum += energy(point, position(point, u));
  return sum;
}

void SphereContact::add_forces(const SolidModel& model, const Displacement& u,
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

void SphereContact::add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
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

void SphereContact::bond(const Displacement& u) {
  for (Point& point : points_) {
    const Eigen::Vector3d x = position(point, u);
    const Eigen::Vector3d g = gradient(point, x);
    if (point.stuck || g.isZero(0)) continue;
    point.stuck = true;
    point.traction = g;
    point.arm = x - tool_.centre;
  }
}

Eigen::Vector3d SphereContact::tool_force(const Displacement& u) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Point& point : points_) force -= point.area * gradient(point, position(point, u));
  return force;
}

Eigen::Vector3d SphereContact::tool_force_slope(const Displacement& u,
                                                const Displacement& du) const {
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (const Point& point : points_) {
    const Eigen::Matrix3d H = hessian(point, position(point, u), true);
    if (H.isZero(0)) continue;
    const Facet& facet = facets_[at(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) slope -= point.area * point.N[a] * H * du.col(facet[a]);
  }
  return slope;
}

double SphereContact::contact_area(const Displacement& u) const {
  double area = 0;
  for (const Point& point : points_)
    if (point.stuck || !gradient(point, position(point, u)).isZero(0)) area += point.area;
  return area;
}

double SphereContact::penetration(const Displacement& u) const {
  double deepest = 0;
  for (const Point& point : points_)
    deepest = std::max(deepest, tool_.radius - (position(point, u) - tool_.centre).norm());
  return deepest;
}

double SphereContact::rest_penetration(const Sphere& tool) const {
  double deepest = 0;
  const Displacement rest = Displacement::Zero(3, mesh_->nodes());
  for (const Point& point : points_)
    deepest = std::max(deepest, tool.radius - (position(point, rest) - tool.centre).norm());
  return deepest;
}

}  // namespace palpate::fem
