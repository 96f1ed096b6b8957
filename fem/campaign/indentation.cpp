// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/indentation.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>

#include "fem/campaign/first_touch.hpp"
#include "fem/campaign/path_driver.hpp"
#include "fem/campaign/path_work.hpp"
#include "fem/campaign/site_equilibrium.hpp"
#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "format/number_text.hpp"

namespace palpate::fem {

namespace {

/// Error of the force before what a no-slip tool met is bonded to it, over the wanted one: where it
/// was met is known well enough, and another equilibrium follows. Where either is not found, the
/// increment begins again with the wanted error.
constexpr double kBeforeBonding = 10;
/// Radius around the site within which self-contact is detected, over the extent of the tool.
constexpr double kWatched = 4;
/// Increments of the path across the azimuth: with two, what is proportional to the force of a drag
/// is told from what is proportional to its square.
constexpr std::size_t kAcrossIncrements = 2;
/// A path across a lateral one for its observer: its travel over that of the lateral path, and the
/// error of its tool force. Only the picture of the skin comes from it, linear in the travel.
constexpr double kAcrossTravel = 0.5;
constexpr double kAcrossTolerance = 5e-3;

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Depths of the increments: evenly spaced, with the stops among them.
std::vector<double> normal_increments(const IndentationSettings& settings,
                                      std::vector<double> depths) {
  for (int i = 1; i <= settings.increments; ++i)
    depths.push_back(settings.depth * i / settings.increments);
  std::sort(depths.begin(), depths.end());
  const auto close = [&](double a, double b) { return b - a < 1e-9 * settings.depth; };
  depths.erase(std::unique(depths.begin(), depths.end(), close), depths.end());
  return depths;
}

SiteMesh mesh_of_site(const CampaignContext& context) {
  if (context.engine == Engine::Direct) return SiteMesh::WholeBody;
  return context.indentation.refines() ? SiteMesh::RefinedWindow : SiteMesh::Window;
}

/// A path of the site ended early; every path that did adds its reason.
void stop_early(SiteCurves& curves, const std::string& reason) {
  curves.status = SiteStatus::Partial;
  curves.reason += (curves.reason.empty() ? "" : "; ") + reason;
}

CurveSample sample_at_rest(const CampaignContext& context, const SiteAtRest& rest) {
  CurveSample sample;
  sample.contact_energy = sample.tension = sample.volume_change = 0;
  sample.min_jacobian = rest.state.min_J;
  if (!context.relaxation.empty())
    sample.isochoric_energy.assign(context.relaxation.fractions.size(), 0.0);
  return sample;
}

}  // namespace

/// An increment of a normal path, by its depths.
struct SiteSolver::Increment {
  double from, to;  ///< m
};

struct SiteSolver::Site {
  Site(const CampaignContext& context, const PressPoint& point, SolvePool::Member* member)
      : X(context.reference_position(point.position)),
        inward(to_eigen(point.inward)),
        body(site_body_at(context, point, mesh_of_site(context))),
        contact(contact_at(context, body.mesh(), X)),
        equilibrium(context, body, member),
        rest(site_at_rest(context, body, contact, equilibrium, point)),
        touching(tool_at_first_touch(context, contact, rest.u, point, rest.point)),
        self_contact(body.mesh(), X, kWatched * context.indentation.tool.extent()) {}

  /// The tool at a depth below first touch, moved sideways by `aside`.
  Tool tool_at(double depth, const Eigen::Vector3d& aside = Eigen::Vector3d::Zero()) const {
    Tool tool = touching;
    tool.tip += depth * inward + aside;
    return tool;
  }

  /// The equilibrium from which lateral paths of a depth start.
  struct LateralStart {
    Displacement u;
    ToolContact contact;
    double work;  ///< J, of the tool so far
  };

  Eigen::Vector3d X, inward;
  SiteBody body;
  ToolContact contact;
  SiteEquilibrium equilibrium;
  SiteAtRest rest;
  Tool touching;
  SelfContact self_contact;
  std::map<double, LateralStart> lateral_starts;  ///< by depth
};

bool SiteSolver::press_to(Site& site, PathDriver& driver, const Increment& increment,
                          Predictor& states, Displacement& u, CurveSample& sample,
                          std::string& reason) {
  if (context_.indentation.friction != ToolFriction::NoSlip)
    return driver.advance(increment.from, increment.to, states, u, sample, reason);
  const IncrementStart start{u, site.tool_at(increment.from).tip};
  // An observer differentiates the equilibrium before bonding too.
  if (!bond_observer_) {
    const Predictor states_before = states;
    const ToolContact contact_before = site.contact;
    const double tolerance = context_.indentation.force_tolerance;
    site.equilibrium.allow_error(kBeforeBonding * tolerance);
    const bool arrived = driver.advance(increment.from, increment.to, states, u, sample, reason);
    site.equilibrium.allow_error(tolerance);
    if (arrived) {
      site.contact.bond_since(start, u);
      if (driver.settle(increment.to, states, u, sample, reason)) return true;
    }
    u = start.u;
    states = states_before;
    site.contact = contact_before;
    site.equilibrium.start_path(site.tool_at(increment.from), u);
  }
  return press_accurately_to(site, driver, increment, start, states, u, sample, reason);
}

bool SiteSolver::press_accurately_to(Site& site, PathDriver& driver, const Increment& increment,
                                     const IncrementStart& start, Predictor& states,
                                     Displacement& u, CurveSample& sample, std::string& reason) {
  if (!driver.advance(increment.from, increment.to, states, u, sample, reason)) return false;
  const ToolContact before = site.contact;
  if (bond_observer_) bond_observer_(before, u, start);
  if (!site.contact.bond_since(start, u)) return true;
  if (driver.settle(increment.to, states, u, sample, reason)) return true;
  site.contact = before;
  return false;
}

/// A normal path that has not begun.
CurvePath SiteSolver::path_at_rest(const Site& site) const {
  CurvePath path;
  path.kind = PathKind::Normal;
  path.direction = to_vec3(site.inward);
  path.samples.push_back(sample_at_rest(context_, site.rest));
  return path;
}

void SiteSolver::run_normal_path(Site& site, const std::vector<double>& stops, SiteCurves& curves) {
  const double tool_radius = context_.indentation.tool.radius;
  const bool no_slip = context_.indentation.friction == ToolFriction::NoSlip;
  PathDriver driver({.model = site.body.whole(),
                     .contact = site.contact,
                     .equilibrium = site.equilibrium,
                     .self_contact = site.self_contact,
                     .tool_radius = tool_radius,
                     .energy_at_rest = site.rest.state.energy,
                     .volume_at_rest = site.rest.state.volume,
                     .follows_work = true,
                     .relaxes = !context_.relaxation.empty(),
                     .tool_at = [&](double depth) { return site.tool_at(depth); }},
                    site.rest.u);
  CurvePath path = path_at_rest(site);

  Displacement u = site.rest.u;
  Predictor states;
  states.add(0, u);
  double from = 0;
  if (no_slip) {
    site.contact.move_to(site.tool_at(0));
    site.contact.bond(u, kTouching * tool_radius);
  }
  std::vector<std::optional<double>> work;
  for (const double depth : normal_increments(context_.indentation, stops)) {
    CurveSample sample;
    std::string reason;
    const bool found = press_to(site, driver, {from, depth}, states, u, sample, reason);
    if (!found) stop_early(curves, "normal path " + reason);
    if (!found && !(driver.reached() > from)) break;
    path.samples.push_back(sample);
    work.push_back(driver.work());
    if (observer_) observer_(site.contact, u, sample);
    increment_done();
    from = driver.reached();
    for (const double stop : stops)
      if (same_depth(stop, from))
        site.lateral_starts.emplace(stop, Site::LateralStart{u, site.contact, 0.0});
    if (!found) break;
  }
  // A site that ended above every lateral depth has its lateral response where it ended.
  if (site.lateral_starts.empty() && !stops.empty() && from > 0)
    site.lateral_starts.emplace(from, Site::LateralStart{u, site.contact, 0.0});
  pressed_ = u.leftCols(context_.model.mesh().nodes());
  fill_work(path, 0, work);
  for (auto& [depth, start] : site.lateral_starts)
    for (const auto& sample : path.samples)
      if (same_depth(sample.displacement, depth)) start.work = sample.tool_work;
  curves.paths.push_back(std::move(path));
}

void SiteSolver::run_lateral_path(Site& site, const LateralPlan& plan, SiteCurves& curves) {
  const double lateral_depth = plan.lateral_depth;
  const auto found = site.lateral_starts.find(lateral_depth);
  if (found == site.lateral_starts.end()) return;  // the normal path ended before: recorded there
  const Site::LateralStart& start = found->second;
  const Eigen::Vector3d direction = to_eigen(plan.direction);
  ToolContact contact = start.contact;
  Displacement u = start.u;
  contact.bond(u);
  PathDriver driver(
      {.model = site.body.whole(),
       .contact = contact,
       .equilibrium = site.equilibrium,
       .self_contact = site.self_contact,
       .tool_radius = context_.indentation.tool.radius,
       .energy_at_rest = site.rest.state.energy,
       .volume_at_rest = site.rest.state.volume,
       .follows_work = false,
       .relaxes = !context_.relaxation.empty(),
       .tool_at = [&](double s) { return site.tool_at(lateral_depth, s * direction); }},
      u);
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.lateral_depth = lateral_depth;
  path.direction = plan.direction;
  Predictor states;
  states.add(0, u);
  path.samples.push_back(curves.paths.front().samples.front());
  for (const auto& pressed : curves.paths.front().samples)
    if (same_depth(pressed.displacement, lateral_depth)) path.samples.back() = pressed;
  path.samples.back().displacement = 0;
  double from = 0;
  for (const double s : plan.travels) {
    CurveSample sample;
    std::string reason;
    const bool arrived = driver.advance(from, s, states, u, sample, reason);
    if (!arrived)
      stop_early(curves, "lateral path at depth " + length_text(lateral_depth) + " " + reason);
    if (!arrived && !(driver.reached() > from)) break;
    path.samples.push_back(sample);
    if (lateral_observer_) lateral_observer_(plan, contact, u, sample);
    increment_done();
    if (!arrived) break;
    from = s;
  }
  fill_work(path, start.work, {});
  curves.paths.push_back(std::move(path));
}

std::size_t SiteSolver::count_increments(const SitePlan& plan) const {
  std::size_t count = normal_increments(context_.indentation, plan.stops).size();
  for (const LateralPlan& lateral : plan.lateral)
    count += lateral.travels.size() + (needs_across(lateral, plan.lateral) ? 1 : 0);
  return count;
}

void SiteSolver::increment_done() {
  ++increments_done_;
  if (on_increment_)
    on_increment_(static_cast<double>(increments_done_) / static_cast<double>(increments_),
                  thread_cpu_seconds() - start_);
}

/// Does the skin need a path across this one? No other direction is dragged at its depth.
bool SiteSolver::needs_across(const LateralPlan& path, const std::vector<LateralPlan>& all) const {
  const auto there = std::count_if(all.begin(), all.end(), [&](const LateralPlan& other) {
    return other.lateral_depth == path.lateral_depth;
  });
  return also_across_ && there == 1;
}

/// No force is read from this path.
void SiteSolver::run_across(Site& site, const LateralPlan& plan, const SiteCurves& curves) {
  const Eigen::Vector3d across = site.inward.cross(to_eigen(plan.direction));
  SiteCurves aside;
  aside.paths.push_back(curves.paths.front());
  site.equilibrium.allow_error(std::max(kAcrossTolerance, context_.indentation.force_tolerance));
  run_lateral_path(
      site, {plan.lateral_depth, to_vec3(across), {kAcrossTravel * plan.travels.back()}}, aside);
}

SitePlan SiteSolver::plan_of_settings(const Vec3& inward) const {
  const IndentationSettings& settings = context_.indentation;
  SitePlan plan{settings.lateral_depths, {}};
  std::vector<double> travels;
  for (int i = 1; i <= settings.lateral_increments; ++i)
    travels.push_back(settings.lateral_travel * i / settings.lateral_increments);
  const auto [first, second] = tangent_frame(to_eigen(inward));
  for (const double lateral_depth : settings.lateral_depths)
    for (const double azimuth : settings.azimuths)
      plan.lateral.push_back({lateral_depth,
                              to_vec3(std::cos(azimuth) * first + std::sin(azimuth) * second),
                              travels});
  if (settings.drag_across && settings.azimuths.size() == 1 && !plan.lateral.empty()) {
    LateralPlan across = plan.lateral[plan.lateral.size() / 2];
    across.direction = to_vec3(to_eigen(inward).cross(to_eigen(across.direction)));
    across.travels.resize(std::min(across.travels.size(), kAcrossIncrements));
    plan.lateral.push_back(std::move(across));
  }
  return plan;
}

/// The lateral paths of the plan that can start. Where the press ended above all of them, those of
/// the least depth, moved to where it ended.
std::vector<LateralPlan> SiteSolver::within_reach(const SitePlan& plan, const Site& site) {
  std::vector<LateralPlan> paths;
  for (const LateralPlan& lateral : plan.lateral)
    if (site.lateral_starts.count(lateral.lateral_depth) > 0) paths.push_back(lateral);
  if (!paths.empty() || site.lateral_starts.empty() || plan.lateral.empty()) return paths;
  const auto shallowest = std::min_element(
      plan.lateral.begin(), plan.lateral.end(),
      [](const auto& a, const auto& b) { return a.lateral_depth < b.lateral_depth; });
  for (LateralPlan lateral : plan.lateral) {
    if (lateral.lateral_depth != shallowest->lateral_depth) continue;
    lateral.lateral_depth = site.lateral_starts.begin()->first;
    paths.push_back(lateral);
  }
  return paths;
}

SiteCurves SiteSolver::solve(std::int32_t vertex) {
  return solve(vertex, plan_of_settings(context_.press_point(vertex).inward));
}

SiteCurves SiteSolver::solve(std::int32_t vertex, const SitePlan& plan) {
  start_ = thread_cpu_seconds();
  SiteCurves curves;
  curves.vertex = vertex;
  curves.status = SiteStatus::Complete;
  increments_ = count_increments(plan);
  increments_done_ = 0;
  Site site(context_, context_.press_point(vertex), member_);
  rest_ = site.rest.u.leftCols(context_.model.mesh().nodes());
  if (site.rest.failure.empty()) {
    run_normal_path(site, plan.stops, curves);
  } else {
    stop_early(curves, "under its weight, before the touch: " + site.rest.failure);
    curves.paths.push_back(path_at_rest(site));
  }
  const std::vector<LateralPlan> paths = within_reach(plan, site);
  for (const LateralPlan& lateral : paths) run_lateral_path(site, lateral, curves);
  for (const LateralPlan& lateral : paths)
    if (needs_across(lateral, paths)) run_across(site, lateral, curves);
  if (curves.paths.front().samples.size() < 2) curves.status = SiteStatus::Failed;
  curves.cpu_seconds = thread_cpu_seconds() - start_;
  return curves;
}

SiteCurves solve_site(const CampaignContext& context, std::int32_t vertex, Displacement* pressed,
                      Displacement* rest) {
  std::optional<SolvePool> pool;
  std::optional<SolvePool::Member> member;
  if (context.rest_factor) {
    pool.emplace(*context.rest_factor, 1);
    member.emplace(*pool);
  }
  SiteSolver solver(context, member ? &*member : nullptr);
  SiteCurves curves = solver.solve(vertex);
  if (pressed != nullptr) *pressed = solver.pressed_state();
  if (rest != nullptr) *rest = solver.state_at_rest();
  return curves;
}

double bytes_of_site(const CampaignContext& context, std::int32_t vertex) {
  // Counted here and in the solvers: predictor, trials and line searches of a path; residuals and
  // directions; the factor of a window over its stiffness.
  constexpr double kDisplacements = 12, kVectors = 8, kWindowFill = 8;
  constexpr double kPairs = 2.0 * SharedFactorSolver::kMostPairs * sizeof(float);
  const double nodes = context.model.mesh().nodes(), unknowns = context.model.pattern().n;
  const double starts = static_cast<double>(context.indentation.lateral_depths.size());
  const double numbers = 3 * nodes * (kDisplacements + starts) + unknowns * kVectors;
  const SiteBody site = site_body_at(context, context.press_point(vertex), mesh_of_site(context));
  return sizeof(double) * (numbers + kWindowFill * site.window().pattern().nonzeros()) +
         unknowns * kPairs + site.bytes();
}

}  // namespace palpate::fem
