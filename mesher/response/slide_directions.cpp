// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response/slide_directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

/// Least rate of a slide with a bound: responses that vary over a triangle lower it further.
constexpr double kLeastRate = 0.05;
/// What is aimed at, and how sharply: the cost of a triangle is log(1 + exp((aim - rate)/width)).
constexpr double kAim = 0.15, kWidth = 0.04;
constexpr int kAzimuths = 16, kRings = 2, kSmoothings = 2, kSweeps = 40;
constexpr auto kSteps = std::to_array({0.15, 0.05, 0.015});  // rad
constexpr double kDifference = 1e-3;                         // rad
constexpr double kMostTurn = 0.6;                            // rad, from the direction given

using Three = std::array<Vec3, 3>;

double cost_of(double rate) {
  const double x = (kAim - rate) / kWidth;
  return x > 30 ? x : std::log1p(std::exp(x));
}

/// A facet: unit normal into the body, axes in its plane, gradients of the natural coordinates.
struct Facet {
  Vec3 N, x, y;
  std::array<Vec3, 3> gradient;
};

Facet facet_of(const Three& p) {
  const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
  Facet f;
  f.N = -unit(area);
  f.x = unit(p[1] - p[0]);
  f.y = cross(f.N, f.x);
  const Vec3 out = (1 / dot(area, area)) * area;
  for (std::size_t l = 0; l < 3; ++l) f.gradient[l] = cross(out, p[(l + 2) % 3] - p[(l + 1) % 3]);
  return f;
}

/// r = p - m q at the contact point with these natural coordinates, for a slide along tau; p and q
/// are linear in the depth and in the slip limit, so that the least value is at ends of both.
double rate_along(const Facet& f, const Vec3& tau, const Vec3& U, const Vec3& dU,
                  const SlideDemand& demand) {
  const Vec3 n = unit(U);
  const double n_N = dot(n, f.N), n_tau = dot(n, tau), l = std::hypot(n_N, n_tau);
  if (!(l > 0)) return -std::numeric_limits<double>::infinity();
  const Vec3 t = (1 / l) * (n_N * tau - n_tau * f.N);
  const double kappa_t = dot(t, dU) / norm(U);
  const double m = demand.lift, rho = m * demand.depth;
  return dot(t, tau) - m * n_tau + std::min(0.0, demand.depth * kappa_t) +
         std::min(0.0, m * rho * kappa_t);
}

/// The directions while they turn.
class Turning {
 public:
  Turning(const Surface& response, std::vector<Vec3> inward, const std::vector<bool>& free,
          const SlideDemand& demand, const std::function<bool(std::size_t, const Three&)>& allowed)
      : response_(response),
        given_(inward),
        inward_(std::move(inward)),
        free_(free),
        demand_(demand),
        allowed_(allowed),
        around_(response.points.size()) {
    for (std::size_t t = 0; t < response.triangles.size(); ++t)
      for (const std::int32_t v : response.triangles[t]) around_[to_index(v)].push_back(t);
  }

  std::size_t unbounded() const {
    std::size_t count = 0;
    for (std::size_t t = 0; t < response_.triangles.size(); ++t) count += is_unbounded(t) ? 1 : 0;
    return count;
  }

  void run() {
    const std::vector<std::size_t> some = vertices_to_turn();
    for (int i = 0; i < kSmoothings; ++i) smooth(some);
    for (int i = 0; i < kSweeps; ++i) {
      bool has_turned = false;
      for (const std::size_t v : some) has_turned = turn(v) || has_turned;
      if (!has_turned) return;
    }
  }

  std::vector<Vec3> take() { return std::move(inward_); }

 private:
  Three at(std::size_t t, const std::vector<Vec3>& values) const {
    const Triangle& triangle = response_.triangles[t];
    return {values[to_index(triangle[0])], values[to_index(triangle[1])],
            values[to_index(triangle[2])]};
  }
  double rate(std::size_t t) const {
    return slide_rate(at(t, response_.points), at(t, inward_), demand_);
  }

  bool needs_bound(std::size_t t) const {
    const Triangle& triangle = response_.triangles[t];
    return std::all_of(triangle.begin(), triangle.end(),
                       [this](std::int32_t v) { return free_[to_index(v)]; });
  }
  bool is_unbounded(std::size_t t) const { return needs_bound(t) && rate(t) < kLeastRate; }

  std::vector<std::size_t> vertices_to_turn() const {
    std::set<std::size_t> near;
    for (std::size_t t = 0; t < response_.triangles.size(); ++t)
      if (is_unbounded(t))
        for (const std::int32_t v : response_.triangles[t]) near.insert(to_index(v));
    for (int ring = 0; ring < kRings; ++ring)
      for (const std::size_t v : std::vector<std::size_t>(near.begin(), near.end()))
        for (const std::size_t t : around_[v])
          for (const std::int32_t w : response_.triangles[t]) near.insert(to_index(w));
    std::erase_if(near, [this](std::size_t v) { return !free_[v]; });
    return {near.begin(), near.end()};
  }

  /// Cost of the triangles around a vertex; infinite where one is not allowed, or where the vertex
  /// has turned too far.
  double cost_around(std::size_t v) const {
    if (dot(inward_[v], given_[v]) < std::cos(kMostTurn))
      return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (const std::size_t t : around_[v]) {
      if (!allowed_(t, at(t, inward_))) return std::numeric_limits<double>::infinity();
      if (needs_bound(t)) sum += cost_of(rate(t));
    }
    return sum;
  }

  double cost_with(std::size_t v, const Vec3& direction) {
    const Vec3 before = std::exchange(inward_[v], direction);
    const double cost = cost_around(v);
    inward_[v] = before;
    return cost;
  }

  /// Halfway to the mean of the neighbours, as far as allowed.
  void smooth(const std::vector<std::size_t>& some) {
    std::vector<Vec3> smoothed;
    for (const std::size_t v : some) {
      Vec3 mean{};
      for (const std::size_t t : around_[v])
        for (const std::int32_t w : response_.triangles[t])
          if (to_index(w) != v) mean = mean + inward_[to_index(w)];
      smoothed.push_back(norm(mean) > 1e-6 ? unit(inward_[v] + unit(mean)) : inward_[v]);
    }
    for (std::size_t i = 0; i < some.size(); ++i)
      if (cost_with(some[i], smoothed[i]) < std::numeric_limits<double>::infinity())
        inward_[some[i]] = smoothed[i];
  }

  /// The longest step down the gradient that lowers the cost around a vertex.
  bool turn(std::size_t v) {
    const double before = cost_around(v);
    const Vec3 u = inward_[v];
    const Vec3 axis = std::abs(u[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 a = unit(cross(u, axis)), b = cross(u, a);
    const double by_a = cost_with(v, unit(u + kDifference * a)) - before;
    const double by_b = cost_with(v, unit(u + kDifference * b)) - before;
    const double slope = std::hypot(by_a, by_b);
    if (!std::isfinite(slope) || slope < 1e-9) return false;
    const Vec3 down = (-1 / slope) * (by_a * a + by_b * b);
    for (const double step : kSteps) {
      const Vec3 next = unit(u + step * down);
      if (!(cost_with(v, next) < before * (1 - 1e-3))) continue;
      inward_[v] = next;
      return true;
    }
    return false;
  }

  const Surface& response_;
  const std::vector<Vec3> given_;
  std::vector<Vec3> inward_;
  const std::vector<bool>& free_;
  SlideDemand demand_;
  const std::function<bool(std::size_t, const Three&)>& allowed_;
  std::vector<std::vector<std::size_t>> around_;
};

}  // namespace

double slide_rate(const Three& points, const Three& inward, const SlideDemand& demand) {
  const Facet f = facet_of(points);
  constexpr double third = 1.0 / 3;
  const std::array<Vec3, 7> contact_points{{{1, 0, 0},
                                            {0, 1, 0},
                                            {0, 0, 1},
                                            {0.5, 0.5, 0},
                                            {0.5, 0, 0.5},
                                            {0, 0.5, 0.5},
                                            {third, third, third}}};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kAzimuths; ++k) {
    const double azimuth = 2 * std::numbers::pi * k / kAzimuths;
    const Vec3 tau = std::cos(azimuth) * f.x + std::sin(azimuth) * f.y;
    Vec3 dU{};
    for (std::size_t l = 0; l < 3; ++l) dU = dU + dot(f.gradient[l], tau) * inward[l];
    for (const Vec3& n : contact_points) {
      const Vec3 U = n[0] * inward[0] + n[1] * inward[1] + n[2] * inward[2];
      least = std::min(least, rate_along(f, tau, U, dU, demand));
    }
  }
  return least;
}

SlideDirections slide_directions(const Surface& response, std::vector<Vec3> inward,
                                 const std::vector<bool>& free, const SlideDemand& demand,
                                 const std::function<bool(std::size_t, const Three&)>& allowed) {
  Turning turning(response, std::move(inward), free, demand, allowed);
  SlideDirections result;
  result.unbounded = turning.unbounded();
  if (result.unbounded > 0) turning.run();
  result.still_unbounded = turning.unbounded();
  result.inward = turning.take();
  return result;
}

}  // namespace palpate::mesher
