// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/contact_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "fem/factor/dense_cholesky.hpp"

namespace palpate::fem {

namespace {

/// A facet that comes into contact or leaves it costs about one iteration.
constexpr int kPatchIterations = 50;
constexpr int kPatchHalvings = 10;
/// Fractions of the stiffening to try where the model of the patch is not convex; with all of it
/// the model is convex.
constexpr std::array<double, 5> kStiffeningFractions{0, 0.003, 0.03, 0.3, 1};

}  // namespace

ContactPatch::ContactPatch(const ToolContact& contact, const SolidModel& model,
                           const Displacement& u)
    : near_(contact.facets().size(), 0) {
  std::set<int> touched;  // nodes of the facets in contact
  double nearest = std::numeric_limits<double>::infinity();
  int nearest_facet = -1;
  for (const auto& point : contact.points()) {
    const Eigen::Vector3d x = contact.position(point, u);
    const double gap = contact.gap(point, x);
    if (gap < nearest) {
      nearest = gap;
      nearest_facet = point.facet;
    }
    if (gap < 0)
      touched.insert(contact.facets()[to_index(point.facet)].begin(),
                     contact.facets()[to_index(point.facet)].end());
  }
  for (const auto& tie : contact.ties()) touched.insert(tie.node);
  if (touched.empty() && nearest_facet >= 0)
    touched.insert(contact.facets()[to_index(nearest_facet)].begin(),
                   contact.facets()[to_index(nearest_facet)].end());
  for (std::size_t f = 0; f < near_.size(); ++f) {
    const Facet& facet = contact.facets()[f];
    if (std::none_of(facet.begin(), facet.end(), [&](int n) { return touched.contains(n); }))
      continue;
    near_[f] = 1;
    for (const int node : facet) first_of_[node] = -1;
  }
  std::map<int, int> free;  // first unknown to node
  for (const auto& entry : first_of_)
    if (const int node = entry.first; model.equation(node) >= 0) free[model.equation(node)] = node;
  for (const auto& [first, node] : free) {
    first_of_[node] = static_cast<int>(unknowns_.size());
    for (int i = 0; i < 3; ++i) unknowns_.push_back(first + i);
  }
  for (std::size_t i = 0; i < contact.points().size(); ++i) {
    const auto& point = contact.points()[i];
    if (near_[to_index(point.facet)] == 0) continue;
    Point mine{i, {}, Eigen::Vector3d::Zero()};
    for (std::size_t a = 0; a < 6; ++a)
      mine.first[a] = first_of_.at(contact.facets()[to_index(point.facet)][a]);
    points_.push_back(mine);
  }
}

bool ContactPatch::covers(const ToolContact& contact, const Displacement& u) const {
  const auto inside = [&](const auto& point) {
    return near_[to_index(point.facet)] != 0 || contact.gap(point, contact.position(point, u)) >= 0;
  };
  const auto known = [&](const auto& tie) { return first_of_.contains(tie.node); };
  return std::all_of(contact.points().begin(), contact.points().end(), inside) &&
         std::all_of(contact.ties().begin(), contact.ties().end(), known);
}

Eigen::VectorXd ContactPatch::difference(const Displacement& from, const Displacement& to) const {
  Eigen::VectorXd d(size());
  for (const auto& [node, first] : first_of_)
    if (first >= 0) d.segment<3>(first) = to.col(node) - from.col(node);
  return d;
}

void ContactPatch::start_from(const ToolContact& contact, const Displacement& u) {
  for (Point& point : points_) point.x = contact.position(contact.points()[point.index], u);
  ties_.clear();
  for (std::size_t i = 0; i < contact.ties().size(); ++i) {
    const ToolContact::Tie& tie = contact.ties()[i];
    ties_.push_back({i, first_of_.at(tie.node), contact.position(tie, u)});
  }
}

Eigen::Vector3d ContactPatch::position(const ToolContact& contact, const Point& point,
                                       const Eigen::VectorXd& d) const {
  const auto& N = contact.points()[point.index].N;
  Eigen::Vector3d x = point.x;
  for (std::size_t a = 0; a < 6; ++a)
    if (point.first[a] >= 0) x += N[a] * d.segment<3>(point.first[a]);
  return x;
}

Eigen::Vector3d ContactPatch::position(const Tie& tie, const Eigen::VectorXd& d) {
  Eigen::Vector3d x = tie.x;
  if (tie.first >= 0) x += d.segment<3>(tie.first);
  return x;
}

double ContactPatch::energy(const ToolContact& contact, const Eigen::VectorXd& d) const {
  double sum = 0;
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    sum += source.area * contact.energy_at(source, position(contact, point, d));
  }
  for (const Tie& tie : ties_)
    sum += contact.energy_at(contact.ties()[tie.index], position(tie, d));
  return sum;
}

double ContactPatch::gradient(const ToolContact& contact, const Eigen::VectorXd& d,
                              Eigen::VectorXd& g) const {
  double sum = 0;
  g.setZero(d.size());
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    const Eigen::Vector3d x = position(contact, point, d);
    const Eigen::Vector3d force = source.area * contact.gradient_at(source, x);
    if (force.isZero(0)) continue;
    sum += source.area * contact.energy_at(source, x);
    for (std::size_t a = 0; a < 6; ++a)
      if (point.first[a] >= 0) g.segment<3>(point.first[a]) += source.N[a] * force;
  }
  for (const Tie& tie : ties_) {
    const auto& source = contact.ties()[tie.index];
    const Eigen::Vector3d x = position(tie, d);
    sum += contact.energy_at(source, x);
    if (tie.first >= 0) g.segment<3>(tie.first) += contact.gradient_at(source, x);
  }
  return sum;
}

void ContactPatch::add_hessian(const ToolContact& contact, const Eigen::VectorXd& d, bool geometric,
                               Eigen::MatrixXd& H) const {
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    const Eigen::Vector3d x = position(contact, point, d);
    if (contact.gradient_at(source, x).isZero(0)) continue;
    const Eigen::Matrix3d h = source.area * contact.hessian_at(source, x, geometric);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        if (point.first[b] < 0 || point.first[a] < point.first[b]) continue;
        H.block<3, 3>(point.first[a], point.first[b]) += source.N[a] * source.N[b] * h;
      }
  }
  for (const Tie& tie : ties_)
    if (tie.first >= 0)
      H.diagonal().segment<3>(tie.first).array() += contact.ties()[tie.index].stiffness;
}

Eigen::Vector3d ContactPatch::tool_force(const ToolContact& contact,
                                         const Eigen::VectorXd& d) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    force -= source.area * contact.gradient_at(source, position(contact, point, d));
  }
  for (const Tie& tie : ties_)
    force -= contact.gradient_at(contact.ties()[tie.index], position(tie, d));
  return force;
}

namespace {

/// Factorizes S and the Hessian of the contact into H; without the geometric term of the contact,
/// which can be negative, where that fails. False when both fail.
bool factorize_patch(const ContactPatch& patch, const ToolContact& contact,
                     const Eigen::MatrixXd& S, const Eigen::VectorXd& d, Eigen::MatrixXd& H) {
  for (const bool geometric : {true, false}) {
    H = S;
    patch.add_hessian(contact, d, geometric, H);
    if (factorize_in_place(H)) return true;
  }
  return false;
}

}  // namespace

Eigen::VectorXd patch_minimum(const ContactPatch& patch, const ToolContact& contact,
                              const PatchStiffness& stiffness, const Eigen::VectorXd& load,
                              Eigen::VectorXd d, double tolerance, Eigen::MatrixXd& scratch) {
  // A copy only where the diagonal must be raised: S is most of the memory of a large patch.
  Eigen::MatrixXd raised;
  const Eigen::MatrixXd* S = &stiffness.S;
  Eigen::VectorXd contact_force;
  std::size_t fraction = 0;
  for (int iteration = 0; iteration < kPatchIterations; ++iteration) {
    const double contact_energy = patch.gradient(contact, d, contact_force);
    const Eigen::VectorXd Sd = *S * d, g = Sd - load + contact_force;
    if (g.norm() <= tolerance) break;
    if (!factorize_patch(patch, contact, *S, d, scratch)) {
      if (++fraction == kStiffeningFractions.size()) break;
      raised = stiffness.S;
      S = &raised;
      raised.diagonal() += kStiffeningFractions[fraction] * stiffness.stiffening;
      continue;
    }
    const double energy = 0.5 * d.dot(Sd) - load.dot(d) + contact_energy;
    const Eigen::VectorXd step = -solve_factorized(scratch, g);
    const double slope = g.dot(step);
    double length = 1;
    Eigen::VectorXd trial;
    for (int halvings = 0; halvings < kPatchHalvings; ++halvings, length *= 0.5) {
      trial = d + length * step;
      const double next =
          0.5 * trial.dot(*S * trial) - load.dot(trial) + patch.energy(contact, trial);
      if (next <= energy + 1e-4 * length * slope + kEnergyNoise * std::abs(energy)) break;
    }
    d = trial;
  }
  return d;
}

}  // namespace palpate::fem
