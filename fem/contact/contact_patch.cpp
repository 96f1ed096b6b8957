// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/contact_patch.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace palpate::fem {

namespace {

/// In place of an unknown that a restricted contact does not have.
constexpr int kLost = -2;

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

void ContactPatch::start_from(const ToolContact& contact, const Displacement& u) {
  for (Point& point : points_) point.x = contact.position(contact.points()[point.index], u);
  ties_.clear();
  for (std::size_t i = 0; i < contact.ties().size(); ++i) {
    const ToolContact::Tie& tie = contact.ties()[i];
    ties_.push_back({i, first_of_.at(tie.node), contact.position(tie, u)});
  }
}

Eigen::Vector3d PatchContact::position(const ToolContact& contact, const Point& point,
                                       const Eigen::VectorXd& d) const {
  const auto& N = contact.points()[point.index].N;
  Eigen::Vector3d x = point.x;
  for (std::size_t a = 0; a < 6; ++a)
    if (point.first[a] >= 0) x += N[a] * d.segment<3>(point.first[a]);
  return x;
}

Eigen::Vector3d PatchContact::position(const Tie& tie, const Eigen::VectorXd& d) {
  Eigen::Vector3d x = tie.x;
  if (tie.first >= 0) x += d.segment<3>(tie.first);
  return x;
}

double PatchContact::energy(const ToolContact& contact, const Eigen::VectorXd& d) const {
  double sum = 0;
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    sum += source.area * contact.energy_at(source, position(contact, point, d));
  }
  for (const Tie& tie : ties_)
    sum += contact.energy_at(contact.ties()[tie.index], position(tie, d));
  return sum;
}

double PatchContact::gradient(const ToolContact& contact, const Eigen::VectorXd& d,
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

template <class Number>
void PatchContact::add_hessian(const ToolContact& contact, const Eigen::VectorXd& d, bool geometric,
                               Eigen::MatrixX<Number>& H) const {
  for (const Point& point : points_) {
    const auto& source = contact.points()[point.index];
    const Eigen::Vector3d x = position(contact, point, d);
    if (contact.gradient_at(source, x).isZero(0)) continue;
    const Eigen::Matrix3d h = source.area * contact.hessian_at(source, x, geometric);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        if (point.first[b] < 0 || point.first[a] < point.first[b]) continue;
        H.template block<3, 3>(point.first[a], point.first[b]) +=
            (source.N[a] * source.N[b] * h).template cast<Number>();
      }
  }
  for (const Tie& tie : ties_)
    if (tie.first >= 0)
      H.diagonal().template segment<3>(tie.first).array() +=
          static_cast<Number>(contact.ties()[tie.index].stiffness);
}

template void PatchContact::add_hessian(const ToolContact&, const Eigen::VectorXd&, bool,
                                        Eigen::MatrixXf&) const;
template void PatchContact::add_hessian(const ToolContact&, const Eigen::VectorXd&, bool,
                                        Eigen::MatrixXd&) const;

void PatchContact::mark_touched(const ToolContact& contact, const Eigen::VectorXd& d,
                                std::vector<char>& marks) const {
  const auto mark = [&](int first) {
    if (first >= 0) std::fill_n(marks.begin() + first, 3, char{1});
  };
  for (const Point& point : points_)
    if (contact.gap(contact.points()[point.index], position(contact, point, d)) < 0)
      std::for_each(point.first.begin(), point.first.end(), mark);
  for (const Tie& tie : ties_) mark(tie.first);
}

PatchContact PatchContact::restricted_to(const std::vector<int>& renumbered) const {
  PatchContact some;
  const auto lost = [](int first) { return first == kLost; };
  const auto renumber = [&](int& first) {
    if (first < 0) return;
    first = renumbered[to_index(first)];
    if (first < 0) first = kLost;
  };
  for (Point point : points_) {
    std::for_each(point.first.begin(), point.first.end(), renumber);
    if (std::none_of(point.first.begin(), point.first.end(), lost)) some.points_.push_back(point);
  }
  for (Tie tie : ties_) {
    renumber(tie.first);
    if (!lost(tie.first)) some.ties_.push_back(tie);
  }
  return some;
}

}  // namespace palpate::fem
