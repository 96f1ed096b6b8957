// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/skin_error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "fitting/measurement/nearest_rank.hpp"
#include "format/error.hpp"
#include "format/friction_cone.hpp"

namespace palpate::fidelity {
namespace {

constexpr double kNearRadii = 3;  ///< "near the tool", in tool radii

/// The errors of one kind of state.
class Errors {
 public:
  explicit Errors(std::string what) : what_(std::move(what)) {}

  void add(double error, std::size_t point) { errors_.emplace_back(error, point); }
  void add_state() { ++states_; }
  bool empty() const { return states_ == 0; }

  SkinErrorRow row() {
    SkinErrorRow row;
    row.what = what_;
    row.states = states_;
    if (errors_.empty()) return row;
    std::sort(errors_.begin(), errors_.end());
    const auto at = [&](double fraction) {
      return errors_[fitting::nearest_rank(errors_.size(), fraction)].first;
    };
    row.median = at(0.5);
    row.p95 = at(0.95);
    row.worst = errors_.back().first;
    row.worst_point = errors_.back().second;
    return row;
  }

 private:
  std::string what_;
  std::size_t states_ = 0;
  std::vector<std::pair<double, std::size_t>> errors_;  ///< with the index of the point
};

/// Those of the vertices near the tool, and of all.
struct NearAndAll {
  explicit NearAndAll(const std::string& what)
      : near(what + ", within 3 tool radii"), all(what + ", whole skin") {}
  Errors near, all;
};

Vec3 direct_at(const std::vector<float>& skin, std::size_t vertex) {
  return {static_cast<double>(skin[3 * vertex]), static_cast<double>(skin[3 * vertex + 1]),
          static_cast<double>(skin[3 * vertex + 2])};
}

/// A state: the deflection, and the direct displacement of the skin there.
struct State {
  RenderedBody::Deflection deflection;
  std::vector<float> direct;
};

std::vector<State> presses(const SiteFields& fields) {
  std::vector<State> states;
  for (const NormalField& field : fields.normal)
    states.push_back({{field.depth, 0, {}}, field.skin});
  return states;
}

/// The force at a state of a lateral path.
Vec3 force_at(const SiteCurves& curves, const LateralField& field) {
  for (const CurvePath& path : curves.paths) {
    if (path.kind != PathKind::Lateral || path.lateral_depth != field.depth ||
        path.direction != field.direction)
      continue;
    for (const CurveSample& sample : path.samples)
      if (sample.displacement == field.travel) return sample.force;
  }
  refuse("direct fields", "have a state without a force", "remove them and compare again");
}

/// A lateral field is relative to the press at its start.
std::vector<State> deflections(const SiteFields& fields,
                               const std::function<bool(const LateralField&)>& chosen) {
  std::vector<State> states;
  for (const LateralField& field : fields.lateral) {
    if (!chosen(field)) continue;
    const auto start =
        std::find_if(fields.normal.begin(), fields.normal.end(), [&](const NormalField& press) {
          return std::abs(press.depth - field.depth) < 1e-6 * field.depth;
        });
    if (start == fields.normal.end()) continue;
    State state{{field.depth, field.travel, field.direction}, start->skin};
    for (std::size_t i = 0; i < field.skin.size(); ++i) state.direct[i] += field.skin[i];
    states.push_back(std::move(state));
  }
  return states;
}

class SkinMeasure {
 public:
  SkinMeasure(const RenderedBody& body, const RenderedSkin& skin, double tool_radius)
      : body_(body), skin_(skin), near_(kNearRadii * tool_radius) {}

  void compare(const HoldOutPoint& p, std::size_t point, const std::vector<State>& states,
               NearAndAll& errors) const {
    std::vector<RenderedBody::Deflection> path;
    for (const State& state : states) path.push_back(state.deflection);
    const auto rendered = body_.displace(skin_, p.position, p.inward, path);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const RenderedBody::Deflection& d = states[i].deflection;
      errors.near.add_state();
      errors.all.add_state();
      if (states[i].direct.size() != 3 * rendered[i].size())
        refuse("direct fields", "are of another body", "remove them and compare again");
      for (std::size_t w = 0; w < rendered[i].size(); ++w) {
        const double error =
            norm(rendered[i][w] - direct_at(states[i].direct, w)) / std::hypot(d.depth, d.lateral);
        errors.all.add(error, point);
        if (norm(skin_.at_rest()[w] - p.position) <= near_) errors.near.add(error, point);
      }
    }
  }

 private:
  const RenderedBody& body_;
  const RenderedSkin& skin_;
  double near_;
};

}  // namespace

std::vector<SkinErrorRow> measure_skin(const RenderedBody& body, const RenderedSkin& skin,
                                       const std::vector<HoldOutPoint>& points,
                                       const Curves& direct,
                                       const std::function<SiteFields(const SiteCurves&)>& fields,
                                       double friction) {
  const SkinMeasure measure(body, skin, direct.tool.radius);
  NearAndAll press("press"), held("lateral within friction"), beyond("lateral beyond friction");
  for (const SiteCurves& site : direct.sites) {
    const auto point = static_cast<std::size_t>(site.vertex);
    if (site.status == SiteStatus::Failed || point >= points.size()) continue;
    const HoldOutPoint& p = points[point];
    const SiteFields of_site = fields(site);
    const auto is_held = [&](const LateralField& field) {
      return within_friction(force_at(site, field), p.inward, friction);
    };
    measure.compare(p, point, presses(of_site), press);
    measure.compare(p, point, deflections(of_site, is_held), held);
    measure.compare(p, point, deflections(of_site, std::not_fn(is_held)), beyond);
  }
  std::vector<SkinErrorRow> rows;
  for (NearAndAll* errors : {&press, &held, &beyond}) {
    if (errors->all.empty()) continue;
    rows.push_back(errors->near.row());
    rows.push_back(errors->all.row());
  }
  return rows;
}

}  // namespace palpate::fidelity
