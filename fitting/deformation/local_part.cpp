// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/local_part.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

namespace palpate::fitting {
namespace {

/// Weight of the squared second differences of a profile against its squared errors, per knot.
constexpr double kSmoothness = 0.1;
/// Weight of the squares of a profile of what differs between directions: where the skin does not
/// tell, nothing does.
constexpr double kNoDifference = 0.01;

Vec3 displacement(const Eigen::Ref<const Eigen::VectorXf>& field, std::size_t vertex) {
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

/// Least squares over the values at the knots of the terms of a Fourier series of the azimuth from
/// t. Each is 0 at the contact. @return (knots, terms).
Eigen::MatrixXd LocalPart::series(const std::vector<double>& samples, const Vec3& t,
                                  std::size_t terms) const {
  const auto count = static_cast<Eigen::Index>(knots_.size());
  const auto columns = static_cast<Eigen::Index>(terms);
  // Knot by knot, so that the matrix is a band.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count * columns, count * columns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count * columns);
  double weight = 0;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const Near& near = near_[i];
    const auto harmonics = near.from.harmonics(t);
    const auto h = Eigen::Map<const Eigen::VectorXd>(harmonics.data(), columns);
    Eigen::VectorXd row(2 * columns);
    row << (1 - near.knot.above_weight) * h, near.knot.above_weight * h;
    const Eigen::Index begin = static_cast<Eigen::Index>(near.knot.below) * columns;
    a.block(begin, begin, 2 * columns, 2 * columns) += near.from.facing * row * row.transpose();
    b.segment(begin, 2 * columns) += near.from.facing * samples[i] * row;
    weight += near.from.facing;
  }
  const double scale = 1 + weight / static_cast<double>(count);
  a.diagonal().array() += kNoDifference * scale;
  const Eigen::Vector3d bend(1, -2, 1);
  for (Eigen::Index k = 0; k + 2 < count; ++k)
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < 3; ++j)
        a.block((k + i) * columns, (k + j) * columns, columns, columns).diagonal().array() +=
            kSmoothness * scale * bend[i] * bend[j];
  const Eigen::Index rest = (count - 1) * columns;
  Eigen::MatrixXd profiles = Eigen::MatrixXd::Zero(columns, count);
  profiles.reshaped().tail(rest) = a.bottomRightCorner(rest, rest).ldlt().solve(b.tail(rest));
  return profiles.transpose();
}

/// What differs between directions, of the field of a lateral deflection along t less its symmetric
/// part: (knots, components).
Eigen::MatrixXd LocalPart::anisotropic(const Eigen::Ref<const Eigen::VectorXf>& field,
                                       const Vec3& t) const {
  const Vec3 across = cross(inward_, t);
  std::array<std::vector<double>, 3> samples;
  for (const Near& near : near_) {
    const Vec3 u = displacement(field, near.vertex);
    samples[0].push_back(dot(u, t));
    samples[1].push_back(dot(u, across));
    samples[2].push_back(dot(u, inward_));
  }
  Eigen::MatrixXd profiles(knots_.size(), kAnisotropicComponents);
  profiles << series(samples[0], t, kHarmonics), series(samples[1], t, kHarmonics),
      series(samples[2], t, kNormalHarmonics);
  return profiles;
}

/// Subtracts value (s/R_c)^power.
void LocalPart::end_at_reach(Eigen::Ref<Eigen::VectorXd> profile, double value, int power) const {
  for (Eigen::Index k = 0; k < profile.size(); ++k)
    profile[k] -= value * std::pow(knots_[static_cast<std::size_t>(k)] / knots_.back(), power);
}

double LocalPart::value(const Eigen::Ref<const Eigen::VectorXd>& profile, const Near& near) {
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

LocalPart::Lateral LocalPart::take_lateral(Eigen::Ref<Eigen::VectorXf> first,
                                           Eigen::Ref<Eigen::VectorXf> second) const {
  std::vector<double> radial, around, along;
  for (const Near& near : near_) {
    const Vec3 u = displacement(first, near.vertex), v = displacement(second, near.vertex);
    const Vec3 &e = near.from.radial, &f = near.from.around;
    radial.push_back(dot(e, first_) * dot(e, u) + dot(e, second_) * dot(e, v));
    around.push_back(dot(f, first_) * dot(f, u) + dot(f, second_) * dot(f, v));
    along.push_back(dot(e, first_) * dot(inward_, u) + dot(e, second_) * dot(inward_, v));
  }
  Eigen::MatrixXd symmetric(knots_.size(), kLateralComponents);
  symmetric << profile(radial, 1), profile(around, 1), profile(along, 0);
  Eigen::VectorXf rest_of_first = first, rest_of_second = second;
  subtract_symmetric(rest_of_first, first_, symmetric);
  subtract_symmetric(rest_of_second, second_, symmetric);

  const Eigen::Index last = symmetric.rows() - 1;
  const double a = symmetric(last, 0), b = symmetric(last, 1);
  const double translation = (a + b) / 2, shear = (a - b) / 2;
  end_at_reach(symmetric.col(0), translation, 0);
  end_at_reach(symmetric.col(1), translation, 0);
  end_at_reach(symmetric.col(0), shear, 2);
  end_at_reach(symmetric.col(1), -shear, 2);
  end_at_reach(symmetric.col(2), symmetric(last, 2), 1);
  subtract_symmetric(first, first_, symmetric);
  subtract_symmetric(second, second_, symmetric);

  Lateral profiles;
  append(profiles.symmetric, symmetric.reshaped());
  profiles.anisotropic = take_anisotropic(first, first_, anisotropic(rest_of_first, first_));
  const auto more = take_anisotropic(second, second_, anisotropic(rest_of_second, second_));
  profiles.anisotropic.insert(profiles.anisotropic.end(), more.begin(), more.end());
  return profiles;
}

void LocalPart::subtract_symmetric(Eigen::Ref<Eigen::VectorXf> field, const Vec3& t,
                                   const Eigen::MatrixXd& profiles) const {
  for (const Near& near : near_) {
    const auto at = [&](Eigen::Index c) { return value(profiles.col(c), near); };
    subtract(field, near.vertex, near.from.lateral(inward_, t, at(0), at(1), at(2)));
  }
}

/// Subtracts what differs between directions, less what has the same value at the reach.
std::vector<float> LocalPart::take_anisotropic(Eigen::Ref<Eigen::VectorXf> field, const Vec3& t,
                                               Eigen::MatrixXd profiles) const {
  constexpr std::array<int, kHarmonics> kOrder{0, 1, 1, 2, 2};
  for (Eigen::Index c = 0; c < profiles.cols(); ++c)
    end_at_reach(profiles.col(c), profiles(profiles.rows() - 1, c),
                 kOrder[static_cast<std::size_t>(c) % kHarmonics]);
  for (const Near& near : near_) {
    std::array<double, kAnisotropicComponents> p{};
    for (std::size_t c = 0; c < p.size(); ++c)
      p[c] = value(profiles.col(static_cast<Eigen::Index>(c)), near);
    subtract(field, near.vertex, near.from.anisotropic(inward_, t, p));
  }
  std::vector<float> all;
  append(all, profiles.reshaped());
  return all;
}
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace palpate::fitting
