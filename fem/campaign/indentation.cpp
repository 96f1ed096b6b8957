// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/indentation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <map>
#include <optional>

#include "fem/campaign/region_laws.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/contact/self_contact.hpp"
#include "fem/mesh/in_words.hpp"
#include "fem/solve/preload.hpp"
#include "fem/solve/shared_factor_solver.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr int kMaxHalvings = 5;
constexpr int kHalvingsBeforeDirect = 2;
constexpr double kLargestPenetration =
    0.01;  ///< over the tool radius; a free surface stays far below
/// A stuck tool holds at its first touch what is nearer than this, over its radius.
constexpr double kTouching = 1e-6;
/// Where the body is watched for contact with itself, over the extent of the tool.
constexpr double kWatched = 4;
/// An element whose volume has shrunk to less than this is about to invert.
constexpr double kNearInversion = 0.25;
constexpr double kLargestStep = 0.25;  ///< of one increment, over the tool radius
/// Residual at which the shared-factor solver stops, over the wanted error of the force. The force
/// is off by up to twice that residual on a lateral path (bench_precompute errors).
constexpr double kSharedTolerance = 0.5;
/// Of that, on a normal path that sticks: the surface sticks where it is met, so that errors add
/// up.
constexpr double kStickingShare = 0.5;

Eigen::Vector3d to_eigen(const Vec3& v) {
  return Eigen::Vector3d(v.data());
}
Vec3 to_vec3(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

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

/// Converged states of a path, for the predictor.
class History {
 public:
  void add(double s, const Displacement& u) {
    if (states_.size() == 4) states_.erase(states_.begin());
    states_.push_back({s, u});
  }

  /// Polynomial extrapolation to `s` through the last `count` states.
  Displacement extrapolate(double s, std::size_t count) const {
    const auto first = states_.size() - count;
    Displacement u = Displacement::Zero(3, states_.back().u.cols());
    for (auto i = first; i < states_.size(); ++i) {
      double weight = 1;
      for (auto j = first; j < states_.size(); ++j)
        if (j != i) weight *= (s - states_[j].s) / (states_[i].s - states_[j].s);
      u += weight * states_[i].u;
    }
    return u;
  }

  std::size_t size() const { return states_.size(); }
  const Displacement& last() const { return states_.back().u; }

 private:
  struct State {
    double s;
    Displacement u;
  };
  std::vector<State> states_;
};

/// Highest-order extrapolation that keeps every element well away from inversion.
Displacement predict(const SolidModel& model, const History& history, double s) {
  for (std::size_t count = history.size(); count > 1; --count) {
    Displacement u = history.extrapolate(s, count);
    if (model.energy(u).min_J > 0.3) return u;
  }
  return history.last();
}

}  // namespace

std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d first = normal.cross(Eigen::Vector3d::Unit(axis)).normalized();
  return {first, normal.cross(first)};
}

std::vector<double> running_integral(const std::vector<double>& x, const std::vector<double>& y) {
  // Integral over [x1, x2] of the parabola through three samples that include x1 and x2.
  const auto piece = [&](std::size_t a, std::size_t b, std::size_t other) {
    const double h = x[b] - x[a];
    const double curvature =
        ((y[other] - y[a]) / (x[other] - x[a]) - (y[b] - y[a]) / h) / (x[other] - x[b]);
    return 0.5 * h * (y[a] + y[b]) - curvature * h * h * h / 6;
  };
  std::vector<double> sum(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) {
    double step = 0.5 * (x[i] - x[i - 1]) * (y[i] + y[i - 1]);
    const bool before = i >= 2, after = i + 1 < x.size();
    if (before && after)
      step = 0.5 * (piece(i - 1, i, i - 2) + piece(i - 1, i, i + 1));
    else if (before)
      step = piece(i - 1, i, i - 2);
    else if (after)
      step = piece(i - 1, i, i + 1);
    sum[i] = sum[i - 1] + step;
  }
  return sum;
}

namespace {

/// The facets that the tool may meet at a place.
ToolContact contact_at(const CampaignContext& context, const QuadraticMesh& mesh,
                       const Eigen::Vector3d& X) {
  const IndentationSettings& settings = context.indentation;
  const double reach = settings.tool.extent() + settings.tool.radius + settings.lateral_travel;
  return {mesh, X, reach, context.contact_stiffness};
}

/// The tool with its tip where a place of the surface is before it is touched.
Tool tool_over(const CampaignContext& context, const PressPoint& place) {
  const IndentationSettings& settings = context.indentation;
  const Eigen::Vector3d inward = to_eigen(place.inward);
  const auto [first, second] = tangents(inward);
  return {settings.tool, context.rest_position(place.position), inward,
          std::cos(settings.tool_azimuth) * first + std::sin(settings.tool_azimuth) * second};
}

/// On a concave surface the tool meets the body before its tip does: back off to first touch.
Tool drawn_back(const ToolContact& contact, const Displacement& rest, Tool tool) {
  for (int i = 0; i < 60; ++i) {
    const double depth = contact.penetration_of(tool, rest);
    if (depth <= 1e-7 * tool.geometry.radius) break;
    tool.tip -= depth * tool.inward;
  }
  return tool;
}

}  // namespace

FirstTouch first_touch(const CampaignContext& context, std::int32_t vertex) {
  const PressPoint place = context.place(vertex);
  const ToolContact contact = contact_at(context, context.model.mesh(), to_eigen(place.position));
  return {drawn_back(contact, context.rest, tool_over(context, place)), contact.facets()};
}

namespace {

std::size_t pairs_needed(const CampaignContext& context, const SolidModel& model) {
  const bool sticks = context.indentation.friction == ToolFriction::NoSlip;
  return sticks || !model.mesh().sprung.empty() ? SharedFactorSolver::kMostPairs
                                                : SharedFactorSolver::kFewPairs;
}

/// The solvers of one site: the shared factor first, the whole body by Newton where that fails.
/// There is no factor of a body whose elements are divided: it has the first alone.
class SiteEquilibrium {
 public:
  SiteEquilibrium(const CampaignContext& context, const SiteBody& body, SolveBatch::Member* batch)
      : context_(context), direct_possible_(body.prolongation() == nullptr) {
    if (context.engine == Engine::Direct) return;
    shared_ = std::make_unique<SharedFactorSolver>(
        body.whole(), body.window(),
        [batch](const Eigen::VectorXd& b, Eigen::VectorXd& x) { batch->solve(b, x); },
        pairs_needed(context, body.whole()), body.prolongation());
  }

  /// The whole body is factorized only where `direct_allowed`, for it costs a hundred times more.
  NewtonResult solve(const ToolContact& contact, bool direct_allowed, Displacement& u) {
    NewtonResult result;
    if (shared_) {
      result = solve_shared(contact, u);
      if (result.converged || !direct_allowed || !direct_possible_) return result;
    }
    const int before = result.iterations;
    result = shared_ ? solve_direct_alone(contact, u) : solve_direct(contact, u);
    result.iterations += before;
    return result;
  }

  /// As NewtonSolver::work_between.
  std::optional<double> work_between(const ToolContact& contact, const Eigen::Vector3d& from,
                                     const Displacement& before, const Displacement& after) {
    if (shared_) return shared_->work_between(contact, from, before, after);
    return direct_ ? direct_->work_between(contact, from, before, after) : std::nullopt;
  }

  void restart() {
    if (shared_) shared_->restart();
  }

 private:
  NewtonResult solve_shared(const ToolContact& contact, Displacement& u) {
    NewtonOptions options;
    options.tolerance = kSharedTolerance * context_.indentation.force_tolerance;
    if (context_.indentation.friction == ToolFriction::NoSlip) options.tolerance *= kStickingShare;
    Displacement trial = u;
    NewtonResult result = shared_->solve(contact, options, trial);
    if (result.converged)
      u.swap(trial);
    else
      shared_->restart();
    return result;
  }

  NewtonResult solve_direct(const ToolContact& contact, Displacement& u) {
    NewtonOptions options;
    options.tolerance = context_.indentation.force_tolerance;
    if (!direct_) direct_ = std::make_unique<NewtonSolver>(context_.model, &context_.permutation);
    return direct_->solve(contact, options, u);
  }

  /// One site at a time, and nothing is kept: factors of the body by the dozen would fill the
  /// memory.
  NewtonResult solve_direct_alone(const ToolContact& contact, Displacement& u) {
    const std::lock_guard lock(context_.direct_solve);
    NewtonResult result = solve_direct(contact, u);
    direct_.reset();
    return result;
  }

  const CampaignContext& context_;
  bool direct_possible_;
  std::unique_ptr<SharedFactorSolver> shared_;
  std::unique_ptr<NewtonSolver> direct_;
};

}  // namespace

struct SiteSolver::Site {
  Site(const CampaignContext& context, const PressPoint& place, SolveBatch::Member* batch)
      : X(to_eigen(place.position)),
        inward(to_eigen(place.inward)),
        body(context, X),
        contact(contact_at(context, body.mesh(), X)),
        touching(drawn_back(contact, body.rest(), tool_over(context, place))),
        equilibrium(context, body, batch),
        watch(body.mesh(), X, kWatched * context.indentation.tool.extent()) {}

  /// The tool at a depth below first touch, moved sideways by `aside`.
  Tool tool_at(double depth, const Eigen::Vector3d& aside = Eigen::Vector3d::Zero()) const {
    Tool tool = touching;
    tool.tip += depth * inward + aside;
    return tool;
  }

  /// State at a held depth.
  struct Held {
    Displacement u;
    ToolContact contact;
    double work;
  };

  Eigen::Vector3d X, inward;
  SiteBody body;
  ToolContact contact;
  Tool touching;
  SiteEquilibrium equilibrium;
  SelfContact watch;
  std::map<double, Held> held;
};

namespace {

/// Drives one path: increments with predictor and cut-back.
class PathDriver {
 public:
  /// `follows_work`: where the contact grows, the work of the tool is followed within increments.
  PathDriver(const CampaignContext& context, const SolidModel& model, ToolContact& contact,
             SiteEquilibrium& equilibrium, const SelfContact& watch, bool follows_work,
             std::function<Tool(double)> tool_at)
      : context_(context),
        model_(model),
        contact_(contact),
        equilibrium_(equilibrium),
        watch_(watch),
        follows_work_(follows_work),
        tool_at_(std::move(tool_at)) {
    equilibrium_.restart();
  }

  /// From the present end of `history` at `from` to `to`. On success u is the equilibrium and
  /// `sample` is filled but for the work.
  bool advance(double from, double to, History& history, Displacement& u, CurveSample& sample,
               std::string& reason) {
    work_ = follows_work_ ? std::optional(0.0) : std::nullopt;
    // A tool that is moved by a large part of its size at once could pass the surface unnoticed.
    double at = from, step = std::min(to - from, kLargestStep * context_.indentation.tool.radius);
    int halvings = 0;
    sample.iterations = 0;
    std::string failure;  // of the last attempt: no news when a cut-back overcomes it
    while (at < to) {
      const double next = to - at <= 1.001 * step ? to : at + step;
      Displacement trial = predict(model_, history, next);
      const Outcome outcome = equilibrate(next, halvings, trial, sample, failure);
      if (outcome == Outcome::Found) {
        add_work(at, history.last(), trial);
        u = trial;
        history.add(next, u);
        at = next;
        continue;
      }
      if (outcome == Outcome::Meaningless || ++halvings > kMaxHalvings) {
        reason = "at " + in_millimetres(next) + ": " + failure;
        if (outcome == Outcome::NotFound) reason += about_inversion(history.last());
        return false;
      }
      step *= 0.5;
    }
    return true;
  }

  /// J, of the tool in the last advance(); nothing where it was not followed all the way.
  std::optional<double> work() const { return work_; }

 private:
  void add_work(double from, const Displacement& before, const Displacement& after) {
    if (!work_) return;
    const auto more = equilibrium_.work_between(contact_, tool_at_(from).tip, before, after);
    work_ = more ? std::optional(*work_ + *more) : std::nullopt;
  }

  enum class Outcome {
    Found,
    NotFound,    ///< a smaller step may help
    Meaningless  ///< found, but no indentation: smaller steps lead to the same
  };

  Outcome equilibrate(double s, int halvings, Displacement& u, CurveSample& sample,
                      std::string& reason) {
    contact_.move_to(tool_at_(s));
    const NewtonResult result = equilibrium_.solve(contact_, halvings >= kHalvingsBeforeDirect, u);
    sample.iterations += result.iterations;
    reason = result.reason;
    if (!result.converged) return Outcome::NotFound;
    record(s, u, sample);
    if (sample.penetration > kLargestPenetration * context_.indentation.tool.radius) {
      reason = "the tool cuts into a part of the surface that cannot yield (is it held there?)";
      return Outcome::Meaningless;
    }
    if (s > kLargestStep * context_.indentation.tool.radius && sample.contact_area == 0) {
      reason = "the tool has lost the surface";
      return Outcome::Meaningless;
    }
    const int entering = watch_.entering_node(u);
    if (entering >= 0) {
      reason = "the surface meets itself at " +
               point_in_millimetres(model_.mesh().X.col(entering)) + ", which is not modelled";
      return Outcome::Meaningless;
    }
    if (const auto loss = model_.ellipticity_loss(u)) {
      reason = loss->reason();
      return Outcome::Meaningless;
    }
    return Outcome::Found;
  }

  /// What the last equilibrium before a failure says about its cause; empty when nothing.
  std::string about_inversion(const Displacement& u) const {
    const auto [J, X] = model_.most_compressed(u);
    if (J > kNearInversion) return {};
    char text[96];
    std::snprintf(text, sizeof text, " (an element at %s is about to invert: det F = %.2f)",
                  point_in_millimetres(X).c_str(), J);
    return text;
  }

  void record(double s, const Displacement& u, CurveSample& sample) const {
    const SolidModel::State state = model_.energy(u);
    sample.displacement = s;
    sample.force = to_vec3(contact_.tool_force(u));
    sample.strain_energy = state.energy - context_.at_rest.energy;
    sample.min_jacobian = state.min_J;
    sample.penetration = contact_.penetration(u);
    sample.contact_area = contact_.contact_area(u);
    sample.contact_energy = contact_.energy(u);
    sample.tension = contact_.tension(u);
  }

  const CampaignContext& context_;
  const SolidModel& model_;
  ToolContact& contact_;
  SiteEquilibrium& equilibrium_;
  const SelfContact& watch_;
  bool follows_work_;
  std::function<Tool(double)> tool_at_;
  std::optional<double> work_;
};

/// A path of the site stopped early; every path that did leaves its reason.
void stop_early(SiteCurves& curves, const std::string& reason) {
  curves.status = SiteStatus::Partial;
  curves.reason += (curves.reason.empty() ? "" : "; ") + reason;
}

/// Integral from 0 to s1 of the power law through (s1, f1) and (s2, f2): a contact that grows from
/// a point starts like one (Hertz: 3/2), and no parabola follows it there. The parabolas'
/// `otherwise` where the samples suggest no such law.
double first_work(const std::vector<double>& s, const std::vector<double>& f, double otherwise) {
  if (s.size() < 3 || !(f[1] > 0 && f[2] > f[1])) return otherwise;
  const double exponent = std::log(f[2] / f[1]) / std::log(s[2] / s[1]);
  return exponent < 1 || exponent > 2.5 ? otherwise : f[1] * s[1] / (1 + exponent);
}

/// Fill tool_work, on top of `start`: of each increment what the solver found, one for each sample
/// but the first, or else the integral of force . direction through the samples.
void fill_work(CurvePath& path, double start, const std::vector<std::optional<double>>& found) {
  std::vector<double> s, f;
  for (const auto& sample : path.samples) {
    s.push_back(sample.displacement);
    f.push_back(dot(sample.force, path.direction));
  }
  const auto through = running_integral(s, f);
  path.samples.front().tool_work = start;
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const auto known = i <= found.size() ? found[i - 1] : std::nullopt;
    double between = through[i] - through[i - 1];
    if (path.kind == PathKind::Normal && i == 1) between = first_work(s, f, between);
    path.samples[i].tool_work = path.samples[i - 1].tool_work + known.value_or(between);
  }
}

}  // namespace

void SiteSolver::run_normal_path(Site& site, const std::vector<double>& stops, SiteCurves& curves) {
  const bool stuck = context_.indentation.friction == ToolFriction::NoSlip;
  PathDriver driver(context_, site.body.whole(), site.contact, site.equilibrium, site.watch, true,
                    [&](double depth) { return site.tool_at(depth); });
  CurvePath path;
  path.kind = PathKind::Normal;
  path.direction = to_vec3(site.inward);
  path.samples.emplace_back();
  path.samples.back().contact_energy = path.samples.back().tension = 0;
  path.samples.back().min_jacobian = context_.at_rest.min_J;

  Displacement u = site.body.rest();
  History history;
  history.add(0, u);
  double from = 0;
  if (stuck) {
    site.contact.move_to(site.tool_at(0));
    site.contact.bond(u, kTouching * context_.indentation.tool.radius);
  }
  std::vector<std::optional<double>> work;
  for (const double depth : normal_increments(context_.indentation, stops)) {
    CurveSample sample;
    std::string reason;
    if (!driver.advance(from, depth, history, u, sample, reason)) {
      stop_early(curves, "normal path " + reason);
      break;
    }
    path.samples.push_back(sample);
    work.push_back(driver.work());
    if (observer_) observer_(site.contact, u, sample);
    if (stuck) site.contact.bond(u);
    for (const double held : stops)
      if (std::abs(held - depth) < 1e-9 * depth)
        site.held.emplace(held, Site::Held{u, site.contact, 0.0});
    from = depth;
  }
  pressed_ = u.leftCols(context_.model.mesh().nodes());
  fill_work(path, 0, work);
  for (auto& [depth, held] : site.held)
    for (const auto& sample : path.samples)
      if (std::abs(sample.displacement - depth) < 1e-9 * depth) held.work = sample.tool_work;
  curves.paths.push_back(std::move(path));
}

void SiteSolver::run_lateral_path(Site& site, const LateralPlan& plan, SiteCurves& curves) {
  const double lateral_depth = plan.lateral_depth;
  const auto found = site.held.find(lateral_depth);
  if (found == site.held.end()) return;  // the normal path ended before: already recorded
  const Site::Held& held = found->second;
  const Eigen::Vector3d direction = to_eigen(plan.direction);
  ToolContact contact = held.contact;
  Displacement u = held.u;
  contact.bond(u);
  PathDriver driver(context_, site.body.whole(), contact, site.equilibrium, site.watch, false,
                    [&](double s) { return site.tool_at(lateral_depth, s * direction); });
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.lateral_depth = lateral_depth;
  path.direction = plan.direction;
  History history;
  history.add(0, u);
  path.samples.push_back(curves.paths.front().samples.front());
  for (const auto& pressed : curves.paths.front().samples)
    if (std::abs(pressed.displacement - lateral_depth) < 1e-9 * lateral_depth)
      path.samples.back() = pressed;
  path.samples.back().displacement = 0;
  double from = 0;
  for (const double s : plan.travels) {
    CurveSample sample;
    std::string reason;
    if (!driver.advance(from, s, history, u, sample, reason)) {
      stop_early(curves, "lateral path at depth " + in_millimetres(lateral_depth) + " " + reason);
      break;
    }
    path.samples.push_back(sample);
    if (lateral_observer_) lateral_observer_(plan, contact, u, sample);
    from = s;
  }
  fill_work(path, held.work, {});
  curves.paths.push_back(std::move(path));
}

SitePlan SiteSolver::plan_of_settings(const Vec3& inward) const {
  const IndentationSettings& settings = context_.indentation;
  SitePlan plan{settings.lateral_depths, {}};
  std::vector<double> travels;
  for (int i = 1; i <= settings.lateral_increments; ++i)
    travels.push_back(settings.lateral_travel * i / settings.lateral_increments);
  const auto [first, second] = tangents(to_eigen(inward));
  for (const double lateral_depth : settings.lateral_depths)
    for (const double azimuth : settings.azimuths)
      plan.lateral.push_back({lateral_depth,
                              to_vec3(std::cos(azimuth) * first + std::sin(azimuth) * second),
                              travels});
  return plan;
}

SiteCurves SiteSolver::solve(std::int32_t vertex) {
  return solve(vertex, plan_of_settings(context_.place(vertex).inward));
}

SiteCurves SiteSolver::solve(std::int32_t vertex, const SitePlan& plan) {
  const double start = thread_cpu_seconds();
  SiteCurves curves;
  curves.vertex = vertex;
  curves.status = SiteStatus::Complete;
  Site site(context_, context_.place(vertex), batch_);
  run_normal_path(site, plan.stops, curves);
  for (const LateralPlan& lateral : plan.lateral) run_lateral_path(site, lateral, curves);
  if (curves.paths.front().samples.size() < 2) curves.status = SiteStatus::Failed;
  curves.cpu_seconds = thread_cpu_seconds() - start;
  return curves;
}

SiteCurves solve_site(const CampaignContext& context, std::int32_t vertex, Displacement* pressed) {
  std::optional<SolveBatch> batch;
  std::optional<SolveBatch::Member> member;
  if (context.rest_factor) {
    batch.emplace(*context.rest_factor, 1);
    member.emplace(*batch);
  }
  SiteSolver solver(context, member ? &*member : nullptr);
  SiteCurves curves = solver.solve(vertex);
  if (pressed) *pressed = solver.pressed_state();
  return curves;
}

}  // namespace palpate::fem
