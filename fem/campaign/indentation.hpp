// SPDX-License-Identifier: AGPL-3.0-or-later
// One site: the tool is pressed along the press direction, and from chosen depths moved along
// tangents at constant depth without slip.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "fem/campaign/campaign_context.hpp"
#include "fem/contact/contact.hpp"
#include "fem/factor/rest_factor.hpp"

namespace palpate::fem {

class PathDriver;
class Predictor;

/// A lateral path: the tool moves along a tangent at a constant depth, without slip.
struct LateralPlan {
  double lateral_depth = 0;     ///< m
  Vec3 direction{};             ///< unit, normal to inward
  std::vector<double> travels;  ///< m, ascending, without the 0 of the start
};

/// Whether two depths of a path are one but for rounding.
inline bool same_depth(double a, double b) {
  return std::abs(a - b) < 1e-9 * b;
}

/// The paths of one site.
struct SitePlan {
  std::vector<double> stops;  ///< m, depths that the normal path passes, among them lateral depths
  std::vector<LateralPlan> lateral;
};

/// Solves sites one after another on one thread.
class SiteSolver {
 public:
  /// `member`: this thread's membership of the pool of sites; may be null for Engine::Direct.
  SiteSolver(const CampaignContext& context, SolvePool::Member* member)
      : context_(context), member_(member) {}

  /// All paths of a site, those of the settings or of a plan. A failure is recorded in the result,
  /// never thrown.
  SiteCurves solve(std::int32_t vertex);
  SiteCurves solve(std::int32_t vertex, const SitePlan& plan);

  /// Called with every equilibrium of the normal path, after what it touches is bonded to a tool
  /// without slip. With refined elements the displacement has their nodes too.
  using Observer = std::function<void(const ToolContact&, const Displacement&, const CurveSample&)>;
  void observe(Observer observer) { observer_ = std::move(observer); }

  /// Called with every equilibrium of a no-slip normal path before what has touched since the start
  /// of the increment is bonded to the tool.
  using BondObserver =
      std::function<void(const ToolContact&, const Displacement&, const IncrementStart&)>;
  void observe_bonds(BondObserver observer) { bond_observer_ = std::move(observer); }

  /// Called with every equilibrium of the lateral paths but their starts.
  using LateralObserver = std::function<void(const LateralPlan&, const ToolContact&,
                                             const Displacement&, const CurveSample&)>;
  void observe_lateral(LateralObserver observer) { lateral_observer_ = std::move(observer); }

  /// Every lateral path that is the only one at its depth is then followed by one across it, for
  /// its observer alone: the curves do not have it. The skin would be known in one direction.
  void also_across(bool wanted) { also_across_ = wanted; }

  /// Called after every increment with the fraction of the site's increments that are done, and the
  /// processor time of the site, s.
  using IncrementObserver = std::function<void(double fraction, double seconds)>;
  void on_increment(IncrementObserver call) { on_increment_ = std::move(call); }

  /// The end of the normal path of the site last solved, on the nodes of the body.
  const Displacement& pressed_state() const { return pressed_; }
  /// The displacement before the touch, on the nodes of the body: of the site last solved, or of
  /// the present one to an observer.
  const Displacement& state_at_rest() const { return rest_; }

 private:
  struct Site;  ///< geometry and solvers of one site
  struct Increment;

  SitePlan plan_of_settings(const Vec3& inward) const;
  static std::vector<LateralPlan> within_reach(const SitePlan& plan, const Site& site);
  /// Follows an increment of the normal path as PathDriver::advance does, and bonds what it touches
  /// to a tool without slip.
  bool press_to(Site& site, PathDriver& driver, const Increment& increment, Predictor& states,
                Displacement& u, CurveSample& sample, std::string& reason);
  /// The same with the tolerance of the settings before bonding too.
  bool press_accurately_to(Site& site, PathDriver& driver, const Increment& increment,
                           const IncrementStart& start, Predictor& states, Displacement& u,
                           CurveSample& sample, std::string& reason);
  CurvePath path_at_rest(const Site& site) const;
  void run_normal_path(Site& site, const std::vector<double>& stops, SiteCurves& curves);
  void run_lateral_path(Site& site, const LateralPlan& plan, SiteCurves& curves);
  void run_across(Site& site, const LateralPlan& plan, const SiteCurves& curves);
  bool needs_across(const LateralPlan& path, const std::vector<LateralPlan>& all) const;
  std::size_t count_increments(const SitePlan& plan) const;
  void increment_done();

  const CampaignContext& context_;
  SolvePool::Member* member_;
  Displacement pressed_, rest_;
  Observer observer_;
  BondObserver bond_observer_;
  LateralObserver lateral_observer_;
  bool also_across_ = false;
  IncrementObserver on_increment_;
  std::size_t increments_ = 0, increments_done_ = 0;  ///< of the site being solved
  double start_ = 0;                                  ///< s, of its processor time
};

/// Solves one site alone. `pressed`, `rest`: the displacement at the end of its normal path and
/// before the touch; may be null.
SiteCurves solve_site(const CampaignContext& context, std::int32_t vertex, Displacement* pressed,
                      Displacement* rest = nullptr);

/// An upper bound of the memory that a running site needs, bytes.
double bytes_of_site(const CampaignContext& context, std::int32_t vertex);

}  // namespace palpate::fem
