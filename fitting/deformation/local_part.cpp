// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/local_part.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace palpate::fitting {
namespace {

/// Weight of the squared second differences of a profile against its squared errors, per knot.
constexpr double kSmoothness = 0.1;

Vec3 displacement(const Eigen::Ref<Eigen::VectorXf>& field, std::size_t vertex) {
  const auto row = static_cast<Eigen::Index>(3 * vertex);
  return {static_cast<double>(field[row]), static_cast<double>(field[row + 1]),
          static_cast<double>(field[row + 2])};
}

void subtract(Eigen::Ref<Eigen::VectorXf> field, std::size_t vertex, const Vec3& u) {
  const auto row = static_cast<Eigen::Index>(3 * vertex);
  for (std::size_t i = 0; i < 3; ++i)
    field[row + static_cast<Eigen::Index>(i)] -= static_cast<float>(u[i]);
}

void append(std::vector<float>& all, const Eigen::VectorXd& more) {
  for (const double x : more) all.push_back(static_cast<float>(x));
}

}  // namespace

LocalPart::LocalPart(const std::vector<Vec3>& skin, const std::vector<Vec3>& normals,
                     const std::vector<double>& knots, const SiteFrame& frame)
    : knots_(knots),
      inward_(frame.inward),
      first_(frame.tangent),
      second_(cross(frame.inward, frame.tangent)) {
  for (std::size_t w = 0; w < skin.size(); ++w) {
    const runtime::FromContact from(frame.position, inward_, skin[w], normals[w]);
    if (from.distance < knots.back() && from.facing > 0)
      near_.push_back({w, from, runtime::knot_weights(knots, from.distance)});
  }
}

/// Least squares over the values at the knots, the first of which is given.
Eigen::VectorXd LocalPart::profile(const std::vector<double>& samples, double at_contact) const {
  const auto count = static_cast<Eigen::Index>(knots_.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count);
  double weight = 0;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const auto below = static_cast<Eigen::Index>(near_[i].knot.below);
    const Eigen::Vector2d share(1 - near_[i].knot.above_weight, near_[i].knot.above_weight);
    const double w = near_[i].from.facing;
    a.block<2, 2>(below, below) += w * share * share.transpose();
    b.segment<2>(below) += w * samples[i] * share;
    weight += w;
  }
  const double penalty = kSmoothness * (1 + weight / static_cast<double>(count));
  const Eigen::Vector3d bend(1, -2, 1);
  for (Eigen::Index k = 0; k + 2 < count; ++k)
    a.block<3, 3>(k, k) += penalty * bend * bend.transpose();
  const Eigen::Index rest = count - 1;
  b.tail(rest) -= a.col(0).tail(rest) * at_contact;
  Eigen::VectorXd p(count);
  p[0] = at_contact;
  p.tail(rest) = a.bottomRightCorner(rest, rest).ldlt().solve(b.tail(rest));
  return p;
}

/// Subtracts value (s/R_c)^power.
void LocalPart::end_at_reach(Eigen::VectorXd& profile, double value, int power) const {
  for (Eigen::Index k = 0; k < profile.size(); ++k)
    profile[k] -= value * std::pow(knots_[static_cast<std::size_t>(k)] / knots_.back(), power);
}

double LocalPart::value(const Eigen::VectorXd& profile, const Near& near) const {
  const auto below = static_cast<Eigen::Index>(near.knot.below);
  return (1 - near.knot.above_weight) * profile[below] +
         near.knot.above_weight * profile[below + 1];
}

// The fields are views that are written to.
// NOLINTBEGIN(performance-unnecessary-value-param)
std::vector<float> LocalPart::take_press(Eigen::Ref<Eigen::VectorXf> field, double depth) const {
  std::vector<double> along, outward;
  for (const Near& near : near_) {
    const Vec3 u = displacement(field, near.vertex);
    along.push_back(dot(u, inward_));
    outward.push_back(dot(u, near.from.radial));
  }
  const Eigen::Index last = static_cast<Eigen::Index>(knots_.size()) - 1;
  Eigen::VectorXd normal = profile(along, depth), radial = profile(outward, 0);
  end_at_reach(normal, normal[last], 0);
  end_at_reach(radial, radial[last], 1);
  for (const Near& near : near_)
    subtract(field, near.vertex,
             near.from.press(inward_, value(normal, near), value(radial, near)));
  std::vector<float> profiles;
  append(profiles, normal);
  append(profiles, radial);
  return profiles;
}

std::vector<float> LocalPart::take_lateral(Eigen::Ref<Eigen::VectorXf> first,
                                           Eigen::Ref<Eigen::VectorXf> second) const {
  std::vector<double> radial, around, along;
  for (const Near& near : near_) {
    const Vec3 u = displacement(first, near.vertex), v = displacement(second, near.vertex);
    const Vec3 &e = near.from.radial, &f = near.from.around;
    radial.push_back(dot(e, first_) * dot(e, u) + dot(e, second_) * dot(e, v));
    around.push_back(dot(f, first_) * dot(f, u) + dot(f, second_) * dot(f, v));
    along.push_back(dot(e, first_) * dot(inward_, u) + dot(e, second_) * dot(inward_, v));
  }
  const Eigen::Index last = static_cast<Eigen::Index>(knots_.size()) - 1;
  Eigen::VectorXd a = profile(radial, 1), b = profile(around, 1), c = profile(along, 0);
  const double translation = (a[last] + b[last]) / 2, shear = (a[last] - b[last]) / 2;
  end_at_reach(a, translation, 0);
  end_at_reach(b, translation, 0);
  end_at_reach(a, shear, 2);
  end_at_reach(b, -shear, 2);
  end_at_reach(c, c[last], 1);
  for (const Near& near : near_) {
    const double ra = value(a, near), rb = value(b, near), rc = value(c, near);
    subtract(first, near.vertex, near.from.lateral(inward_, first_, ra, rb, rc));
    subtract(second, near.vertex, near.from.lateral(inward_, second_, ra, rb, rc));
  }
  std::vector<float> profiles;
  append(profiles, a);
  append(profiles, b);
  append(profiles, c);
  return profiles;
}
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace palpate::fitting
