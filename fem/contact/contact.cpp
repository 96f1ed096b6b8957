// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

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

std::array<double, 6> facet_shape(double L0, double L1, bool linear) {
  const double L2 = 1 - L0 - L1;
  if (linear) return {L0, L1, L2, 0, 0, 0};
  return {L0 * (2 * L0 - 1), L1 * (2 * L1 - 1), L2 * (2 * L2 - 1),
          4 * L0 * L1,       4 * L1 * L2,       4 * L2 * L0};
}

}  // namespace

namespace {

/// c of a tie, chosen so that the lateral stiffness of a half-space under a sphere is that of
/// Mindlin in the mean over positions of the sphere (test_no_slip_contact).
constexpr double kTie = 5;
/// Added to 1 - phi so that k stays finite: at phi = 1 the tie is a thousand times as stiff as the
/// elements.
constexpr double kRigidTie = 1e-3;

}  // namespace

ToolContact::ToolContact(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
                         const ContactStiffness& stiffness)
    : mesh_(&mesh), eps_(stiffness.contact), young_(stiffness.young) {
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
      point.N = facet_shape(q.L0, q.L1, mesh.linear);
      point.area = q.weight * area;
      point.fraction = q.weight;
      points_.push_back(point);
    }
    facets_.push_back(facet);
  }
}

void ToolContact::move_to(const Tool& tool) {
  tool_ = tool;
}

Eigen::Vector3d ToolContact::position(const Point& point, const Displacement& u) const {
  const Facet& facet = facets_[to_index(point.facet)];
  const auto& X = mesh_->X;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < 6; ++a) x += point.N[a] * (X.col(facet[a]) + u.col(facet[a]));
  return x;
}

double ToolContact::gap(const Point& point, const Eigen::Vector3d& x) const {
  if (!tool_.has_sharp_edge()) return tool_.distance(x);
  return point.beneath ? tool_.beyond_end(x) : std::numeric_limits<double>::infinity();
}

Gap ToolContact::gap_derivatives(const Eigen::Vector3d& x) const {
  if (!tool_.has_sharp_edge()) return tool_.gap(x);
  return {tool_.beyond_end(x), tool_.inward, Eigen::Matrix3d::Zero()};
}

double ToolContact::energy_at(const Point& point, const Eigen::Vector3d& x) const {
  const double overlap = std::min(0.0, gap(point, x));
  return 0.5 * eps_ * overlap * overlap;
}

Eigen::Vector3d ToolContact::gradient_at(const Point& point, const Eigen::Vector3d& x) const {
  if (gap(point, x) >= 0) return Eigen::Vector3d::Zero();
  const Gap g = gap_derivatives(x);
  return eps_ * g.distance * g.normal;
}

Eigen::Matrix3d ToolContact::hessian_at(const Point& point, const Eigen::Vector3d& x,
                                        bool geometric) const {
  if (gap(point, x) >= 0) return Eigen::Matrix3d::Zero();
  const Gap g = gap_derivatives(x);
  Eigen::Matrix3d H = eps_ * g.normal * g.normal.transpose();
  if (geometric) H += eps_ * g.distance * g.curvature;
  return H;
}

double ToolContact::energy(const Displacement& u) const {
  double sum = 0;
  for (const Point& point : points_) sum += point.area * energy_at(point, position(point, u));
  for (const Tie& tie : ties_) sum += energy_at(tie, position(tie, u));
  return sum;
}

void ToolContact::add_forces(const SolidModel& model, const Displacement& u,
                             Eigen::VectorXd& f) const {
  for (const Point& point : points_) {
    const Eigen::Vector3d g = point.area * gradient_at(point, position(point, u));
    if (g.isZero(0)) continue;
    const Facet& facet = facets_[to_index(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      const int first = model.equation(facet[a]);
      if (first >= 0) f.segment<3>(first) += point.N[a] * g;
    }
  }
  for (const Tie& tie : ties_)
    if (const int first = model.equation(tie.node); first >= 0)
      f.segment<3>(first) += gradient_at(tie, position(tie, u));
}

void ToolContact::add_stiffness(const SolidModel& model, const Displacement& u, bool geometric,
                                std::vector<double>& values) const {
  const SparsePattern& pattern = model.pattern();
  for (const Point& point : points_) {
    const Eigen::Matrix3d H = point.area * hessian_at(point, position(point, u), geometric);
    if (H.isZero(0)) continue;
    const Facet& facet = facets_[to_index(point.facet)];
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        const int row = model.equation(facet[a]), column = model.equation(facet[b]);
        if (row < 0 || column < 0) continue;
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            if (row + i >= column + k)
              values[to_index(pattern.position(row + i, column + k))] +=
                  point.N[a] * point.N[b] * H(i, k);
      }
  }
  for (const Tie& tie : ties_)
    if (const int first = model.equation(tie.node); first >= 0)
      for (int i = first; i < first + 3; ++i)
        values[to_index(pattern.position(i, i))] += tie.stiffness;
}

std::map<int, double> ToolContact::tie_stiffnesses(const Displacement& u, double closeness) const {
  struct Around {
    double area = 0, in_contact = 0;
  };
  std::map<int, Around> around;
  for (const Point& point : points_) {
    const bool in_contact = gap(point, position(point, u)) < closeness;
    const Facet& facet = facets_[to_index(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      if (point.N[a] <= 0) continue;
      const double area = point.area * point.N[a];
      around[facet[a]].area += area;
      if (in_contact) around[facet[a]].in_contact += area;
    }
  }
  std::map<int, double> stiffness;
  for (const auto& [node, surface] : around) {
    const double fraction = surface.in_contact / surface.area;
    if (fraction > 0)
      stiffness[node] =
          kTie * young_ * std::sqrt(surface.area) * fraction / (1 + kRigidTie - fraction);
  }
  return stiffness;
}

void ToolContact::decide_beneath(const Displacement& u) {
  if (!tool_.has_sharp_edge()) return;
  for (Point& point : points_) {
    const Eigen::Vector3d x = position(point, u);
    // A point behind the plane of the end keeps its state: a change would change the energy. Not so
    // at first, when rounding may have put the surface behind that plane.
    if (decided_ && tool_.beyond_end(x) < 0) continue;
    point.beneath = tool_.from_axis(x) < tool_.geometry.radius;
  }
  decided_ = true;
}

void ToolContact::bond(const Displacement& u, double closeness) {
  decide_beneath(u);
  std::map<int, double> tied;
  for (const Tie& tie : ties_) tied[tie.node] += tie.stiffness;
  for (const auto& [node, stiffness] : tie_stiffnesses(u, closeness))
    if (const double more = stiffness - tied[node]; more > 0)
      ties_.push_back({node, more, mesh_->X.col(node) + u.col(node) - tool_.tip});
}

std::map<int, double> ToolContact::touched_at(const IncrementStart& start,
                                              const Displacement& u) const {
  Tool before = tool_;
  before.tip = start.tip;
  std::vector<std::pair<double, const Point*>> touched;  // by their gaps at the start
  double touched_area = 0;
  for (const Point& point : points_) {
    if (gap(point, position(point, u)) >= 0) continue;
    const Eigen::Vector3d x = position(point, start.u);
    const double distance = tool_.has_sharp_edge() ? before.beyond_end(x) : before.gap(x).distance;
    if (distance < 0) continue;
    touched.emplace_back(distance, &point);
    touched_area += point.area;
  }
  std::sort(touched.begin(), touched.end());
  struct Around {
    double area = 0, moment = 0;
  };
  std::map<int, Around> around;
  double sum = 0;
  for (const auto& [distance, point] : touched) {
    const double when = (sum + 0.5 * point->area) / touched_area;
    sum += point->area;
    const Facet& facet = facets_[to_index(point->facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      if (point->N[a] <= 0) continue;
      around[facet[a]].area += point->area * point->N[a];
      around[facet[a]].moment += point->area * point->N[a] * when;
    }
  }
  std::map<int, double> times;
  for (const auto& [node, surface] : around) times[node] = surface.moment / surface.area;
  return times;
}

Eigen::Vector3d ToolContact::motion_since(const IncrementStart& start, const Displacement& u,
                                          int node) const {
  return u.col(node) - start.u.col(node) - (tool_.tip - start.tip);
}

bool ToolContact::bond_since(const IncrementStart& start, const Displacement& u) {
  const std::map<int, double> times = touched_at(start, u);
  const std::size_t before = ties_.size();
  bond(u);
  for (std::size_t i = before; i < ties_.size(); ++i) {
    Tie& tie = ties_[i];
    const auto when = times.find(tie.node);
    if (when == times.end()) continue;
    const Eigen::Vector3d n = gap_derivatives(position(tie, u)).normal;
    const Eigen::Vector3d motion = motion_since(start, u, tie.node);
    tie.arm -= (1 - when->second) * (motion - motion.dot(n) * n);
  }
  return ties_.size() > before;
}

Eigen::Vector3d ToolContact::tool_force(const Displacement& u) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Point& point : points_) force -= point.area * gradient_at(point, position(point, u));
  for (const Tie& tie : ties_) force -= gradient_at(tie, position(tie, u));
  return force;
}

void ToolContact::add_tool_force_gradient(const SolidModel& model, const Displacement& u,
                                          const Eigen::Vector3d& direction,
                                          Eigen::VectorXd& g) const {
  for (const Point& point : points_) {
    const Eigen::Matrix3d H = hessian_at(point, position(point, u), true);
    if (H.isZero(0)) continue;
    const Eigen::Vector3d change = point.area * H * direction;
    const Facet& facet = facets_[to_index(point.facet)];
    for (std::size_t a = 0; a < 6; ++a) {
      const int first = model.equation(facet[a]);
      if (first >= 0) g.segment<3>(first) -= point.N[a] * change;
    }
  }
  for (const Tie& tie : ties_)
    if (const int first = model.equation(tie.node); first >= 0)
      g.segment<3>(first) -= tie.stiffness * direction;
}

void ToolContact::add_bond_gradient(const SolidModel& model, const ToolContact& before,
                                    const Displacement& l, const Eigen::Vector3d& direction,
                                    Eigen::VectorXd& g) const {
  for (std::size_t i = before.ties_.size(); i < ties_.size(); ++i) {
    const Tie& tie = ties_[i];
    if (const int first = model.equation(tie.node); first >= 0)
      g.segment<3>(first) += tie.stiffness * (l.col(tie.node) + direction);
  }
}

void ToolContact::add_bond_gradient(const SolidModel& model, const ToolContact& before,
                                    const IncrementStart& start, const Displacement& u,
                                    const Displacement& l, const Eigen::Vector3d& direction,
                                    Eigen::VectorXd& g, Eigen::VectorXd& g_start) const {
  const std::map<int, double> times = before.touched_at(start, u);
  for (std::size_t i = before.ties_.size(); i < ties_.size(); ++i) {
    const Tie& tie = ties_[i];
    const int first = model.equation(tie.node);
    if (first < 0) continue;
    const Eigen::Vector3d pull = tie.stiffness * (l.col(tie.node) + direction);
    const auto when = times.find(tie.node);
    g.segment<3>(first) += pull;
    if (when == times.end()) continue;
    // With P = I - n n^T and dn = C dx, d(P m) = P dm - ((m . n) C + n (C m)^T) dx.
    const Gap gap = before.gap_derivatives(position(tie, u));
    const Eigen::Vector3d& n = gap.normal;
    const Eigen::Vector3d motion = before.motion_since(start, u, tie.node);
    const double rest = 1 - when->second;
    const Eigen::Vector3d along = rest * (pull - pull.dot(n) * n);
    g_start.segment<3>(first) += along;
    g.segment<3>(first) -= along;
    g.segment<3>(first) += rest * gap.curvature * (motion.dot(n) * pull + n.dot(pull) * motion);
  }
}

double ToolContact::contact_area(const Displacement& u) const {
  double area = 0;
  for (const Point& point : points_)
    if (gap(point, position(point, u)) < 0) area += point.area;
  return area;
}

double ToolContact::facets_in_contact(const Displacement& u) const {
  double facets = 0;
  for (const Point& point : points_)
    if (gap(point, position(point, u)) < 0) facets += point.fraction;
  return facets;
}

double ToolContact::penetration(const Displacement& u) const {
  double deepest = 0;
  for (const Point& point : points_) deepest = std::max(deepest, -gap(point, position(point, u)));
  return deepest;
}

std::optional<Eigen::Vector3d> ToolContact::touch_of_support(const Displacement& u) const {
  const auto fixed = [&](int node) { return mesh_->fixed[to_index(node)]; };
  for (const Point& point : points_) {
    const Facet& facet = facets_[to_index(point.facet)];
    if (!std::all_of(facet.begin(), facet.end(), fixed)) continue;
    if (const Eigen::Vector3d x = position(point, u); gap(point, x) < 0) return x;
  }
  return std::nullopt;
}

std::vector<double> ToolContact::facet_forces(const Displacement& u) const {
  std::vector<double> force(facets_.size(), 0);
  for (const Point& point : points_) {
    const Eigen::Vector3d x = position(point, u);
    force[to_index(point.facet)] -=
        point.area * gradient_at(point, x).dot(gap_derivatives(x).normal);
  }
  std::map<int, std::vector<std::size_t>> facets_of;
  for (const Tie& tie : ties_) facets_of[tie.node];
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (const int node : facets_[f])
      if (const auto found = facets_of.find(node); found != facets_of.end())
        found->second.push_back(f);
  for (const Tie& tie : ties_) {
    const Eigen::Vector3d x = position(tie, u);
    const double push = -tie.stiffness * slip(tie, x).dot(gap_derivatives(x).normal);
    const auto& around = facets_of.at(tie.node);
    for (const std::size_t f : around) force[f] += push / static_cast<double>(around.size());
  }
  return force;
}

double ToolContact::tension(const Displacement& u) const {
  double sum = 0;
  for (const double force : facet_forces(u)) sum += std::max(0.0, -force);
  return sum;
}

double ToolContact::penetration_of(const Tool& tool, const Displacement& u) const {
  double deepest = 0;
  for (const Point& point : points_)
    deepest = std::max(deepest, -tool.distance(position(point, u)));
  return deepest;
}

}  // namespace palpate::fem
