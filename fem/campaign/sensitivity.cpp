// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "fem/campaign/indentation.hpp"
#include "fem/campaign/parallel_sites.hpp"
#include "fem/campaign/region_laws.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/laws/law.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/tangent_solver.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {
namespace {

/// The body with a slightly larger and a slightly smaller value of one constant. The laws are
/// smooth in their constants: central differences over 1e-5 are exact to about 1e-9.
struct Varied {
  SolidModel more, less;
  double width;    ///< difference of the two values
  double penalty;  ///< d(ln eps)/d(constant)

  /// d(internal forces)/d(constant).
  Eigen::VectorXd slope(const Displacement& u) const {
    Eigen::VectorXd high, low;
    more.forces(u, high);
    less.forces(u, low);
    return (high - low) / width;
  }
};

/// With gravity the point of first touch would depend on the constants.
void refuse_unsupported(const CampaignSettings& settings) {
  if (!settings.gravity.acts()) return;
  throw Error(ErrorKind::Configuration, "gravity",
              "gradients are not computed for a body under its weight",
              "calibrate without [gravity]");
}

double& value_of(CampaignSettings& settings, const RegionConstant& constant) {
  for (RegionMaterial& material : settings.materials)
    if (material.region == constant.region) return material.law.at(constant.name);
  throw Error(ErrorKind::Configuration, "region '" + constant.region + "'", "it has no material",
              "vary a constant of a region that the case describes");
}

std::vector<Law> unchecked_laws(const Body& body, const CampaignSettings& settings) {
  std::vector<Law> laws;
  for (const std::string& region : body.region_names)
    for (const RegionMaterial& material : settings.materials)
      if (material.region == region)
        laws.push_back(
            unchecked_law(placed_on(body, static_cast<std::int32_t>(laws.size()), material.law)));
  return laws;
}

Varied varied(const Body& body, const CampaignSettings& settings, const RegionConstant& constant) {
  constexpr double kStep = 1e-5;
  CampaignSettings more = settings, less = settings;
  const double value = value_of(more, constant);
  // The bulk modulus goes as 1/(1 - 2 nu).
  const double step = constant.name == "poisson" ? kStep * (0.5 - value)
                      : value != 0               ? kStep * std::abs(value)
                                                 : kStep;
  value_of(more, constant) = value + step;
  value_of(less, constant) = value - step;
  Varied v{SolidModel(body, unchecked_laws(body, more), settings.dilatation),
           SolidModel(body, unchecked_laws(body, less), settings.dilatation), 2 * step, 0};
  v.penalty = std::log(contact_stiffness(body, more, v.more).contact /
                       contact_stiffness(body, less, v.less).contact) /
              v.width;
  return v;
}

/// Differentiates at the equilibria of one site, by the adjoint of its tangent.
class Differentiator {
 public:
  Differentiator(const CampaignContext& context, const std::vector<Varied>& constants,
                 SolvePool::Member& member, const PressPoint& point)
      : context_(context),
        constants_(constants),
        window_(window_at(context.model, to_eigen(point.position), context.indentation.tool)),
        solver_(context.model, window_,
                [&member](const Eigen::VectorXd& b, Eigen::VectorXd& x) { member.solve(b, x); }) {}

  /// Derivatives of the force along `direction`. False when the stiffness is not positive definite:
  /// the equilibrium is at a limit point. `adjoint`: K^-1 dF/du.
  bool differentiate(const ToolContact& contact, const Displacement& u,
                     const Eigen::Vector3d& direction, std::vector<double>& slope,
                     Eigen::VectorXd& adjoint) {
    slope.assign(constants_.size(), 0.0);
    if (constants_.empty()) return true;
    Eigen::VectorXd by_u = Eigen::VectorXd::Zero(context_.model.pattern().n);
    contact.add_tool_force_gradient(context_.model, u, direction, by_u);
    if (!solve(contact, u, by_u, adjoint)) return false;
    const double force = contact.tool_force(u).dot(direction);
    const auto residuals = residual_slopes(contact, u);
    for (std::size_t i = 0; i < constants_.size(); ++i)
      slope[i] = constants_[i].penalty * force - adjoint.dot(residuals[i]);
    return true;
  }

  /// Records a state at which the surface is tied afterwards, in the order of the path; `since`:
  /// what has touched since the state recorded before, or since first touch.
  void record(const ToolContact& contact, const Displacement& u,
              std::optional<IncrementStart> since = {}) {
    if (constants_.empty()) return;
    bonded_.push_back({contact, u, residual_slopes(contact, u), std::move(since)});
  }
  std::size_t recorded() const { return bonded_.size(); }

  /// The same for a state whose ties were made at the first `count` recorded states.
  bool differentiate_tied(const ToolContact& contact, const Displacement& u, std::size_t count,
                          const Eigen::Vector3d& direction, std::vector<double>& slope) {
    Eigen::VectorXd adjoint;
    if (!differentiate(contact, u, direction, slope, adjoint)) return false;
    if (constants_.empty()) return true;
    Displacement multiplier = Displacement::Zero(3, u.cols());
    add_step(context_.model, 1, adjoint, multiplier);
    const ToolContact* after = &contact;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(context_.model.pattern().n);
    Eigen::VectorXd by_start = none, m;  // by the state before, of ties made later
    for (std::size_t i = count; i-- > 0; after = &bonded_[i].contact) {
      const Bonded& bonded = bonded_[i];
      Eigen::VectorXd by_bond = by_start;
      by_start = none;
      add_bond_gradient(*after, bonded, multiplier, direction, by_bond, by_start);
      if (by_bond.isZero(0)) continue;  // nothing was tied there
      if (!solve(bonded.contact, bonded.u, by_bond, m)) return false;
      for (std::size_t c = 0; c < constants_.size(); ++c) slope[c] -= m.dot(bonded.residuals[c]);
      add_step(context_.model, 1, m, multiplier);
    }
    return true;
  }

 private:
  /// An equilibrium, before the surface that is in contact there is tied to the tool.
  struct Bonded {
    ToolContact contact;
    Displacement u;
    std::vector<Eigen::VectorXd> residuals;
    std::optional<IncrementStart> since;
  };

  void add_bond_gradient(const ToolContact& after, const Bonded& bonded, const Displacement& l,
                         const Eigen::Vector3d& direction, Eigen::VectorXd& by_bond,
                         Eigen::VectorXd& by_start) const {
    if (bonded.since)
      after.add_bond_gradient(context_.model, bonded.contact, *bonded.since, bonded.u, l, direction,
                              by_bond, by_start);
    else
      after.add_bond_gradient(context_.model, bonded.contact, l, direction, by_bond);
  }

  /// dR/dc at fixed displacement, of each constant.
  std::vector<Eigen::VectorXd> residual_slopes(const ToolContact& contact, const Displacement& u) {
    Eigen::VectorXd contact_forces = Eigen::VectorXd::Zero(context_.model.pattern().n);
    contact.add_forces(context_.model, u, contact_forces);
    std::vector<Eigen::VectorXd> slopes;
    for (const Varied& constant : constants_)
      slopes.push_back(constant.slope(u) + constant.penalty * contact_forces);
    return slopes;
  }

  /// K x = b; by a factor of K itself where the solve with the shared factor fails.
  bool solve(const ToolContact& contact, const Displacement& u, const Eigen::VectorXd& b,
             Eigen::VectorXd& x) {
    if (solver_.linearize(contact, u) && solver_.solve(b, x)) return true;
    const std::lock_guard lock(context_.direct_solve);
    Cholesky factor(context_.model.pattern(), &context_.permutation);
    if (!factor.factorize(solver_.values())) return false;
    SolveWorkspace workspace;
    x.resize(b.size());
    factor.solve(b.data(), x.data(), workspace);
    return true;
  }

  const CampaignContext& context_;
  const std::vector<Varied>& constants_;
  SolidModel window_;
  TangentSolver solver_;
  std::vector<Bonded> bonded_;
};

bool is_among(double depth, const std::vector<double>& depths) {
  return std::any_of(depths.begin(), depths.end(),
                     [&](double d) { return std::abs(d - depth) < 1e-9 * depth; });
}

/// Follows the normal path and the lateral paths of one site and differentiates at the stops.
class SiteDifferentiation {
 public:
  SiteDifferentiation(const CampaignContext& context, const std::vector<Varied>& constants,
                      SolvePool::Member& member, std::int32_t vertex,
                      const std::vector<LateralPlan>& lateral)
      : point_(context.press_point(vertex)),
        lateral_(lateral),
        depths_(context.indentation.lateral_depths),
        no_slip_(context.indentation.friction == ToolFriction::NoSlip),
        differentiator_(context, constants, member, point_),
        solver_(context, &member) {
    result_.vertex = vertex;
    result_.lateral.resize(lateral.size());
  }

  SiteSensitivity run() {
    SitePlan plan{depths_, lateral_};
    for (const LateralPlan& path : lateral_) plan.stops.push_back(path.lateral_depth);
    solver_.observe([this](const auto&... state) { pressed(state...); });
    solver_.observe_bonds(
        [this](const ToolContact& contact, const Displacement& u, const IncrementStart& start) {
          differentiator_.record(contact, u, start);
        });
    solver_.observe_lateral([this](const auto&... state) { moved(state...); });
    const SiteCurves curves = solver_.solve(result_.vertex, plan);
    if (!curves.reason.empty()) result_.reason = curves.reason;
    return std::move(result_);
  }

 private:
  void pressed(const ToolContact& contact, const Displacement& u, const CurveSample& sample) {
    if (is_among(sample.displacement, depths_)) {
      ForceSensitivity s{sample.displacement, dot(sample.force, point_.inward), {}};
      const Eigen::Vector3d inward = to_eigen(point_.inward);
      add(differentiator_.differentiate_tied(contact, u, differentiator_.recorded(), inward,
                                             s.slope),
          s, result_.samples);
    }
    bool starts_lateral = false;
    for (const LateralPlan& path : lateral_)
      starts_lateral = starts_lateral || is_among(sample.displacement, {path.lateral_depth});
    if (starts_lateral || no_slip_) differentiator_.record(contact, u);
    for (const LateralPlan& path : lateral_)
      if (is_among(sample.displacement, {path.lateral_depth}))
        ties_at_start_[path.lateral_depth] = differentiator_.recorded();
  }

  void moved(const LateralPlan& path, const ToolContact& contact, const Displacement& u,
             const CurveSample& sample) {
    ForceSensitivity s{sample.displacement, dot(sample.force, path.direction), {}};
    const auto index =
        static_cast<std::size_t>(std::find_if(lateral_.begin(), lateral_.end(),
                                              [&](const LateralPlan& p) {
                                                return p.lateral_depth == path.lateral_depth &&
                                                       p.direction == path.direction;
                                              }) -
                                 lateral_.begin());
    const Eigen::Vector3d direction = to_eigen(path.direction);
    add(differentiator_.differentiate_tied(contact, u, ties_at_start_.at(path.lateral_depth),
                                           direction, s.slope),
        s, result_.lateral[index]);
  }

  void add(bool found, const ForceSensitivity& s, std::vector<ForceSensitivity>& samples) {
    if (found)
      samples.push_back(s);
    else if (result_.reason.empty())
      result_.reason = "the stiffness is not positive definite at an equilibrium";
  }

  PressPoint point_;
  const std::vector<LateralPlan>& lateral_;
  const std::vector<double>& depths_;
  bool no_slip_;
  std::map<double, std::size_t> ties_at_start_;  ///< recorded states up to each lateral depth
  Differentiator differentiator_;
  SiteSolver solver_;
  SiteSensitivity result_;
};

/// Memory of a site that is differentiated: that of its paths and the tangent of the whole body.
double bytes_of(const CampaignContext& context, std::int32_t vertex) {
  return bytes_of_site(context, vertex) +
         static_cast<double>(sizeof(double)) * context.model.pattern().nonzeros();
}

}  // namespace

namespace {

using SitePlans = std::vector<std::vector<LateralPlan>>;

/// The settings of the paths that pass the wanted states.
CampaignSettings settings_of_paths(const CampaignSettings& settings,
                                   const std::vector<double>& depths, const SitePlans& lateral) {
  CampaignSettings normal = settings;
  IndentationSettings& indentation = normal.indentation;
  indentation.lateral_depths = depths;  // the states that the path must pass
  indentation.depth = *std::max_element(depths.begin(), depths.end());
  indentation.azimuths.clear();  // no lateral paths
  // An equilibrium without friction does not depend on the path: no increments between the depths.
  // Refined elements resolve the contact at the depth of the first one.
  if (indentation.friction == ToolFriction::Frictionless)
    indentation.increments =
        indentation.refine_under_tool == 0 ? 1 : static_cast<int>(depths.size());
  indentation.lateral_travel = 0;  // only the reach of the contact candidates
  for (const auto& plans : lateral) {
    for (const LateralPlan& plan : plans) {
      indentation.depth = std::max(indentation.depth, plan.lateral_depth);
      indentation.lateral_travel = std::max(indentation.lateral_travel, plan.travels.back());
    }
  }
  check_indentation(indentation);
  return normal;
}

/// All sites, differentiated by the adjoint; without constants only pressed.
std::vector<SiteSensitivity> pressed_sites(const Body& body, const CampaignSettings& normal,
                                           const std::vector<RegionConstant>& constants,
                                           const SitePlans& lateral, CampaignCache* cache) {
  const std::vector<LateralPlan> none;
  std::vector<SiteSensitivity> results(normal.sites.size());
  const CampaignContext context(body, normal, Engine::SharedFactor, cache);
  std::vector<Varied> derivatives;
  for (const RegionConstant& constant : constants) {
    derivatives.push_back(varied(body, normal, constant));
  }
  const SiteThreads size =
      site_threads(*context.rest_factor, normal.threads, results.size(), normal.memory,
                   bytes_of(context, normal.sites.front()), kBatch);
  parallel_for_sites(
      *context.rest_factor, size, results.size(), [&](SolvePool::Member& member, std::size_t i) {
        results[i] = SiteDifferentiation(context, derivatives, member, normal.sites[i],
                                         lateral.empty() ? none : lateral[i])
                         .run();
      });
  return results;
}

/// Adds (high - low)/width to the samples that all three have; a path that ended earlier on either
/// side ends there.
void add_differences(const std::vector<ForceSensitivity>& low,
                     const std::vector<ForceSensitivity>& high, double width,
                     std::vector<ForceSensitivity>& samples) {
  samples.resize(std::min({samples.size(), low.size(), high.size()}));
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].slope.push_back((high[i].force - low[i].force) / width);
}

/// Central differences of the forces, for refined elements: their mesh has no tangent of its own.
/// It is the same for all constants, so that its error cancels. Steps of a hundredth leave the
/// force tolerance a hundred times smaller than the force that is differentiated.
std::vector<SiteSensitivity> by_differences(const Body& body, const CampaignSettings& normal,
                                            const std::vector<RegionConstant>& constants,
                                            const SitePlans& lateral, CampaignCache* cache) {
  constexpr double kStep = 1e-2;
  std::vector<SiteSensitivity> results = pressed_sites(body, normal, {}, lateral, cache);
  for (const RegionConstant& constant : constants) {
    CampaignSettings more = normal, less = normal;
    const double value = value_of(more, constant);
    const bool poisson = constant.name == "poisson";
    const double step = poisson      ? kStep * (0.5 - value)
                        : value != 0 ? kStep * std::abs(value)
                                     : kStep;
    value_of(more, constant) = value + step;
    value_of(less, constant) = poisson ? std::max(0.0, value - step) : value - step;
    const double width = value_of(more, constant) - value_of(less, constant);
    const auto high = pressed_sites(body, more, {}, lateral, cache);
    const auto low = pressed_sites(body, less, {}, lateral, cache);
    for (std::size_t i = 0; i < results.size(); ++i) {
      for (const SiteSensitivity* other : {&high[i], &low[i]})
        if (results[i].reason.empty()) results[i].reason = other->reason;
      add_differences(low[i].samples, high[i].samples, width, results[i].samples);
      for (std::size_t p = 0; p < results[i].lateral.size(); ++p)
        add_differences(low[i].lateral[p], high[i].lateral[p], width, results[i].lateral[p]);
    }
  }
  return results;
}

}  // namespace

std::vector<SiteSensitivity> run_sensitivity(const Body& body, const CampaignSettings& settings,
                                             const std::vector<double>& depths,
                                             const std::vector<RegionConstant>& constants,
                                             const SitePlans& lateral, CampaignCache* cache) {
  require_inside(body, "finite elements");
  refuse_unsupported(settings);
  const CampaignSettings normal = settings_of_paths(settings, depths, lateral);
  if (normal.sites.empty()) return {};
  return normal.indentation.refine_under_tool != 0
             ? by_differences(body, normal, constants, lateral, cache)
             : pressed_sites(body, normal, constants, lateral, cache);
}

}  // namespace palpate::fem
