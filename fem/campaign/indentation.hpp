// SPDX-License-Identifier: AGPL-3.0-or-later
// One site: the tool is pressed along the inward direction, then, held at chosen depths, moved
// sideways with the contact stuck.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "fem/campaign/campaign_context.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fem/solve/newton.hpp"

namespace palpate::fem {

/// Where a normal path begins: the tool as it first touches the body, and the facets it may meet.
struct FirstTouch {
  Tool tool;
  std::vector<Facet> facets;
};
FirstTouch first_touch(const CampaignContext& context, std::int32_t vertex);

/// The tool held at a depth and moved sideways, the contact stuck.
struct LateralPlan {
  double lateral_depth = 0;     ///< m
  Vec3 direction{};             ///< unit, across inward
  std::vector<double> travels;  ///< m, ascending, without the 0 of the start
};

/// What is done at one site.
struct SitePlan {
  std::vector<double> stops;  ///< m, depths that the normal path passes; where lateral ones start
  std::vector<LateralPlan> lateral;
};

/// Solves sites one after another on one thread.
class SiteSolver {
 public:
  /// `batch`: this thread's place among those that share block solves; may be null for Direct.
  SiteSolver(const CampaignContext& context, SolveBatch::Member* batch)
      : context_(context), batch_(batch) {}

  /// All paths of a site, those of the settings or of a plan. A failure is recorded in the result,
  /// never thrown.
  SiteCurves solve(std::int32_t vertex);
  SiteCurves solve(std::int32_t vertex, const SitePlan& plan);

  /// Called with every equilibrium of the normal path, the tool in its place, before the surface is
  /// tied to it; with elements divided under the tool the displacement has their nodes too.
  using Observer = std::function<void(const ToolContact&, const Displacement&, const CurveSample&)>;
  void observe(Observer observer) { observer_ = std::move(observer); }

  /// Called with every equilibrium of the lateral paths but their starts.
  using LateralObserver = std::function<void(const LateralPlan&, const ToolContact&,
                                             const Displacement&, const CurveSample&)>;
  void observe_lateral(LateralObserver observer) { lateral_observer_ = std::move(observer); }

  /// The end of the normal path of the site last solved, on the nodes of the body.
  const Displacement& pressed_state() const { return pressed_; }

 private:
  struct Site;  ///< geometry and solvers of one site

  SitePlan plan_of_settings(const Vec3& inward) const;
  void run_normal_path(Site& site, const std::vector<double>& stops, SiteCurves& curves);
  void run_lateral_path(Site& site, const LateralPlan& plan, SiteCurves& curves);

  const CampaignContext& context_;
  SolveBatch::Member* batch_;
  Displacement pressed_;
  Observer observer_;
  LateralObserver lateral_observer_;
};

/// Solve one site alone.
SiteCurves solve_site(const CampaignContext& context, std::int32_t vertex, Displacement* pressed);

/// Two unit vectors that complete `normal` to a right-handed orthonormal frame; azimuth 0 points
/// along the first. The frame is a function of the normal alone.
std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal);

/// Integral of y over x by parabolas through neighbouring samples, third-order accurate for uneven
/// steps; running value at each sample.
std::vector<double> running_integral(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace palpate::fem
