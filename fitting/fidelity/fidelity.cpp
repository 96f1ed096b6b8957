// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/fidelity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "fitting/measurement/compare/compare.hpp"
#include "fitting/measurement/nearest_rank.hpp"
#include "format/friction_cone.hpp"

namespace palpate::fidelity {
namespace {

constexpr double kSameDepth = 1e-6;  // relative

bool same(double a, double b) {
  return std::abs(a - b) <= kSameDepth * std::max(std::abs(a), std::abs(b));
}

/// An error and the point where it occurs.
struct Sampled {
  double relative = 0;  ///< divided by the scale of its state
  double newton = 0;
  std::size_t point = 0;
};

ErrorRow row_of(std::string what, std::string part, std::vector<Sampled> errors) {
  ErrorRow row{std::move(what), std::move(part), errors.size(), 0, 0, 0, 0, 0};
  if (errors.empty()) return row;
  std::sort(errors.begin(), errors.end(),
            [](const Sampled& a, const Sampled& b) { return a.relative < b.relative; });
  row.median = errors[fitting::nearest_rank(errors.size(), 0.5)].relative;
  row.p95 = errors[fitting::nearest_rank(errors.size(), 0.95)].relative;
  row.worst = errors.back().relative;
  row.worst_newton = errors.back().newton;
  row.worst_point = errors.back().point;
  return row;
}

/// Appends the states of one press after the other.
class Presses {
 public:
  Presses(const RenderedBody& body, const std::vector<HoldOutPoint>& points,
          const FidelitySettings& settings, Fidelity& result)
      : body_(body), points_(points), settings_(settings), result_(result) {}

  void compare(const SiteCurves& site) {
    const HoldOutPoint& point = points_[static_cast<std::size_t>(site.vertex)];
    for (const CurvePath& path : site.paths) compare(site, point, path);
  }

 private:
  void compare(const SiteCurves& site, const HoldOutPoint& point, const CurvePath& path) {
    std::vector<ComparedState> states;
    std::vector<RenderedBody::Deflection> deflections;
    for (const CurveSample& sample : path.samples) {
      if (!(sample.displacement > 0)) continue;
      const bool normal = path.kind == PathKind::Normal;
      ComparedState state;
      state.point = static_cast<std::size_t>(site.vertex);
      state.kind = path.kind;
      state.depth = normal ? sample.displacement : path.lateral_depth;
      state.lateral = normal ? 0 : sample.displacement;
      if (!normal) state.tangent = path.direction;
      state.direct = sample.force;
      state.scale = std::max(norm(sample.force), settings_.floor);
      state.within_friction = within_friction(sample.force, point.inward, settings_.friction);
      states.push_back(state);
      deflections.push_back({state.depth, state.lateral, state.tangent});
    }
    const std::vector<Vec3> rendered = body_.press(point.position, point.inward, deflections);
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i].rendered = rendered[i];
      result_.states.push_back(states[i]);
    }
  }

  const RenderedBody& body_;
  const std::vector<HoldOutPoint>& points_;
  FidelitySettings settings_;
  Fidelity& result_;
};

using Chosen = std::function<bool(const ComparedState&)>;
using StateError = std::function<double(const ComparedState&, const Vec3& normal)>;

double along_normal(const ComparedState& s, const Vec3& n) {
  return dot(s.rendered - s.direct, n);
}
double along_tangent(const ComparedState& s, const Vec3&) {
  return dot(s.rendered - s.direct, s.tangent);
}
/// Component normal to the plane of n and the tangent, where the local model has no force.
double off_plane(const ComparedState& s, const Vec3& n) {
  const Vec3 error = s.rendered - s.direct;
  return norm(error - dot(error, n) * n - dot(error, s.tangent) * s.tangent);
}
double whole(const ComparedState& s, const Vec3&) {
  return norm(s.rendered - s.direct);
}

/// Appends the rows of rendered states.
class Rows {
 public:
  Rows(const std::vector<HoldOutPoint>& points, Fidelity& result)
      : points_(points), result_(result) {}

  void add(const std::string& what, const std::string& part, const Chosen& chosen,
           const StateError& error) {
    std::vector<Sampled> errors;
    for (const ComparedState& s : result_.states) {
      if (!chosen(s)) continue;
      const double newton = std::abs(error(s, points_[s.point].inward));
      errors.push_back({newton / s.scale, newton, s.point});
    }
    if (!errors.empty()) result_.rows.push_back(row_of(what, part, std::move(errors)));
  }

  void add_parts(const std::string& what, const Chosen& chosen, bool oblique) {
    add(what, "total", chosen, whole);
    add(what, "normal", chosen, along_normal);
    if (oblique) add(what, "lateral", chosen, along_tangent);
    add(what, "direction", chosen, off_plane);
  }

 private:
  const std::vector<HoldOutPoint>& points_;
  Fidelity& result_;
};

/// Force of a normal press at a depth: along the press and normal to it.
struct PressForce {
  double along = 0;
  Vec3 across{};
};

/// Sampled force of a vertex; absent beyond its samples.
std::optional<PressForce> sampled_force(const SiteCurves& site, double depth) {
  const auto path = std::find_if(site.paths.begin(), site.paths.end(),
                                 [](const CurvePath& p) { return p.kind == PathKind::Normal; });
  if (path == site.paths.end()) return std::nullopt;
  std::vector<double> x{0}, along{0};
  std::array<std::vector<double>, 3> across{{{0}, {0}, {0}}};
  for (const CurveSample& sample : path->samples) {
    if (!(sample.displacement > 0)) continue;
    x.push_back(sample.displacement);
    along.push_back(dot(sample.force, path->direction));
    const Vec3 rest = sample.force - along.back() * path->direction;
    for (std::size_t i = 0; i < 3; ++i) across[i].push_back(rest[i]);
  }
  if (x.size() < 2 || depth > x.back() * (1 + kSameDepth)) return std::nullopt;
  PressForce force{compare::MonotoneCubic(x, along).value(depth), {}};
  for (std::size_t i = 0; i < 3; ++i)
    force.across[i] = compare::MonotoneCubic(x, across[i]).value(depth);
  return force;
}

/// Force at a point interpolated from the samples of the three vertices; absent where one has none.
std::optional<PressForce> interpolated_force(
    const Library& library, const HoldOutPoint& point, double depth,
    const std::map<std::int32_t, const SiteCurves*>& site_at) {
  const Triangle& triangle = library.triangles[static_cast<std::size_t>(point.triangle)];
  PressForce sum;
  for (std::size_t l = 0; l < 3; ++l) {
    const auto found = site_at.find(triangle[l]);
    if (found == site_at.end()) return std::nullopt;
    const std::optional<PressForce> part = sampled_force(*found->second, depth);
    if (!part) return std::nullopt;
    sum.along += point.natural[l] * part->along;
    sum.across = sum.across + point.natural[l] * part->across;
  }
  sum.across = sum.across - dot(sum.across, point.inward) * point.inward;
  return sum;
}

/// Interpolated samples of the three vertices against the direct force, without a fit. The part
/// normal to the press is the error of a model that would render those components as well.
void add_interpolation_rows(const Library& library, const std::vector<HoldOutPoint>& points,
                            const Curves& sampled, Fidelity& result) {
  std::map<std::int32_t, const SiteCurves*> site_at;
  for (const SiteCurves& site : sampled.sites) site_at[site.vertex] = &site;
  std::vector<Sampled> along, across;
  for (const ComparedState& s : result.states) {
    const HoldOutPoint& point = points[s.point];
    if (s.kind != PathKind::Normal || point.node) continue;
    const std::optional<PressForce> force = interpolated_force(library, point, s.depth, site_at);
    if (!force) continue;
    const double direct = dot(s.direct, point.inward);
    const double newton = std::abs(force->along - direct);
    along.push_back({newton / s.scale, newton, s.point});
    const double aside = norm(force->across - (s.direct - direct * point.inward));
    across.push_back({aside / s.scale, aside, s.point});
  }
  if (along.empty()) return;
  const char* what = "interpolation of the samples, off node";
  result.rows.push_back(row_of(what, "normal", std::move(along)));
  result.rows.push_back(row_of(what, "direction", std::move(across)));
}

std::vector<double> lateral_depths(const Curves& curves) {
  std::vector<double> depths;
  for (const SiteCurves& site : curves.sites) {
    for (const CurvePath& path : site.paths) {
      const auto known = [&](double d) { return same(d, path.lateral_depth); };
      if (path.kind != PathKind::Lateral || std::any_of(depths.begin(), depths.end(), known))
        continue;
      depths.push_back(path.lateral_depth);
    }
  }
  return depths;
}

/// From direct solutions alone: the dependence of the lateral force on depth, and of the normal
/// force on the lateral deflection. The decoupled model (28) has neither.
class Decoupling {
 public:
  Decoupling(const std::vector<HoldOutPoint>& points, const FidelitySettings& settings,
             std::vector<double> references)
      : points_(points), settings_(settings), references_(std::move(references)) {}

  void add(const SiteCurves& site) {
    const Vec3& n = points_[static_cast<std::size_t>(site.vertex)].inward;
    for (const CurvePath& path : site.paths) {
      if (path.kind != PathKind::Lateral) continue;
      for (std::size_t i = 1; i < path.samples.size(); ++i) {
        const Vec3 rise = path.samples[i].force - path.samples.front().force;
        const double scale = std::max(norm(path.samples[i].force), settings_.floor);
        const auto sampled = [&](double newton) {
          return Sampled{std::abs(newton) / scale, std::abs(newton),
                         static_cast<std::size_t>(site.vertex)};
        };
        normal_.push_back(sampled(dot(rise, n)));
        const auto mean = mean_rise(site, path, path.samples[i].displacement);
        if (mean) lateral_.push_back(sampled(dot(rise, path.direction) - *mean));
      }
    }
  }

  void write(Fidelity& result) const {
    if (!lateral_.empty())
      result.rows.push_back(row_of("decoupling of f^r from depth", "lateral", lateral_));
    if (!normal_.empty())
      result.rows.push_back(row_of("decoupling of f^z from lateral", "normal", normal_));
  }

 private:
  /// Mean lateral force over the reference depths at the same point, direction and displacement:
  /// the best value of one f^r for all depths.
  std::optional<double> mean_rise(const SiteCurves& site, const CurvePath& of,
                                  double displacement) const {
    double sum = 0;
    std::size_t count = 0;
    for (const CurvePath& path : site.paths) {
      if (path.kind != PathKind::Lateral || norm(path.direction - of.direction) > 1e-6) continue;
      const auto is_at = [&](double d) { return same(d, path.lateral_depth); };
      if (std::none_of(references_.begin(), references_.end(), is_at)) continue;
      for (const CurveSample& sample : path.samples) {
        if (!same(sample.displacement, displacement)) continue;
        sum += dot(sample.force - path.samples.front().force, path.direction);
        ++count;
      }
    }
    if (count == 0 || count != references_.size()) return std::nullopt;
    return sum / static_cast<double>(count);
  }

  const std::vector<HoldOutPoint>& points_;
  FidelitySettings settings_;
  std::vector<double> references_;
  std::vector<Sampled> lateral_, normal_;
};

}  // namespace

double relative_floor(const Curves& direct, double fraction) {
  std::vector<double> largest;
  for (const SiteCurves& site : direct.sites)
    for (const CurvePath& path : site.paths) {
      if (path.kind != PathKind::Normal || path.samples.size() < 2) continue;
      double most = 0;
      for (const CurveSample& sample : path.samples) most = std::max(most, norm(sample.force));
      largest.push_back(most);
    }
  if (largest.empty()) return 0;
  std::sort(largest.begin(), largest.end());
  return fraction * largest[fitting::nearest_rank(largest.size(), 0.5)];
}

Fidelity measure(const FidelityInput& input, const FidelitySettings& settings) {
  const std::vector<HoldOutPoint>& points = input.points;
  Fidelity result;
  Presses presses(input.rendered, points, settings, result);
  Decoupling decoupling(points, settings, lateral_depths(input.sampled));
  for (const SiteCurves& site : input.direct.sites) {
    if (site.status != SiteStatus::Complete)
      result.left_out.push_back("point " + std::to_string(site.vertex) + ": " + site.reason);
    if (site.status == SiteStatus::Failed) continue;
    presses.compare(site);
    decoupling.add(site);
  }

  const auto is = [&](PathKind kind, bool node) {
    return [&points, kind, node](const ComparedState& s) {
      return s.kind == kind && points[s.point].node == node;
    };
  };
  Rows rows(points, result);
  rows.add(
      "anywhere within friction, off node", "total",
      [&](const ComparedState& s) { return s.within_friction && !points[s.point].node; }, whole);
  rows.add(
      "anywhere, off node", "total", [&](const ComparedState& s) { return !points[s.point].node; },
      whole);
  rows.add_parts(kNormalOffNode, is(PathKind::Normal, false), false);
  rows.add_parts("normal press, at node", is(PathKind::Normal, true), false);
  rows.add_parts("oblique press, off node", is(PathKind::Lateral, false), true);
  rows.add_parts("oblique press, at node", is(PathKind::Lateral, true), true);
  rows.add_parts(
      "oblique within friction, off node",
      [&](const ComparedState& s) {
        return s.kind == PathKind::Lateral && s.within_friction && !points[s.point].node;
      },
      true);
  add_interpolation_rows(input.library, points, input.sampled, result);
  decoupling.write(result);
  return result;
}

}  // namespace palpate::fidelity
