// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "fem/at.hpp"
#include "fem/crew.hpp"
#include "fem/indentation.hpp"
#include "fem/laws/law.hpp"
#include "fem/region_laws.hpp"
#include "fem/tangent_solver.hpp"
#include "format/error.hpp"

namespace palpate::fem {
namespace {

/// A constant as the tangent-linear model needs it: the body with a little more and a little less
/// of it. The laws are smooth in their constants, so that central differences over 1e-5 are exact
/// to about 1e-9.
struct Varied {
  SolidModel more, less;
  double width;    ///< between the two values
  double penalty;  ///< d(ln eps)/d(constant)

  /// d(internal forces)/d(constant).
  Eigen::VectorXd slope(const Displacement& u) const {
    Eigen::VectorXd high, low;
    more.forces(u, high);
    less.forces(u, low);
    return (high - low) / width;
  }
};

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
      if (material.region == region) laws.push_back(unchecked_law(material.law));
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
                 SolveBatch::Member& batch, const PressPoint& place)
      : context_(context),
        constants_(constants),
        inward_(place.inward.data()),
        window_(window_at(context, Eigen::Vector3d(place.position.data()))),
        solver_(context.model, window_,
                [&batch](const Eigen::VectorXd& b, Eigen::VectorXd& x) { batch.solve(b, x); }) {}

  /// False when the stiffness is not positive definite: the equilibrium is at a limit point.
  bool differentiate(const ToolContact& contact, const Displacement& u,
                     std::vector<double>& slope) {
    slope.clear();
    if (constants_.empty()) return true;
    const SolidModel& model = context_.model;
    Eigen::VectorXd by_u = Eigen::VectorXd::Zero(model.pattern().n), adjoint;
    contact.add_tool_force_gradient(model, u, inward_, by_u);
    if (!solve(contact, u, by_u, adjoint)) return false;
    Eigen::VectorXd contact_forces = Eigen::VectorXd::Zero(model.pattern().n);
    contact.add_forces(model, u, contact_forces);
    const double force = contact.tool_force(u).dot(inward_);
    for (const Varied& constant : constants_) {
      const Eigen::VectorXd residual = constant.slope(u) + constant.penalty * contact_forces;
      slope.push_back(constant.penalty * force - adjoint.dot(residual));
    }
    return true;
  }

 private:
  /// K x = b; by a factor of K itself where the shared one does not get there.
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
  Eigen::Vector3d inward_;
  SolidModel window_;
  TangentSolver solver_;
};

bool is_among(double depth, const std::vector<double>& depths) {
  return std::any_of(depths.begin(), depths.end(),
                     [&](double d) { return std::abs(d - depth) < 1e-9 * depth; });
}

SiteSensitivity differentiate_site(const CampaignContext& context,
                                   const std::vector<Varied>& constants, SolveBatch::Member& batch,
                                   std::int32_t vertex) {
  SiteSensitivity result;
  result.vertex = vertex;
  const PressPoint place = context.place(vertex);
  Differentiator differentiator(context, constants, batch, place);
  SiteSolver solver(context, &batch);
  solver.observe([&](const ToolContact& contact, const Displacement& u, const CurveSample& sample) {
    if (!is_among(sample.displacement, context.indentation.held_depths)) return;
    ForceSensitivity s{sample.displacement, dot(sample.force, place.inward), {}};
    if (differentiator.differentiate(contact, u, s.slope)) {
      result.samples.push_back(std::move(s));
    } else if (result.reason.empty()) {
      result.reason = "the stiffness is not positive definite at an equilibrium";
    }
  });
  const SiteCurves curves = solver.solve(vertex);
  if (!curves.reason.empty()) result.reason = curves.reason;
  return result;
}

/// Of a site that is differentiated: beside what its paths need, the tangent of the whole body.
double bytes_of(const CampaignContext& context, std::int32_t vertex) {
  return bytes_of_site(context, vertex) + sizeof(double) * context.model.pattern().nonzeros();
}

}  // namespace

std::vector<SiteSensitivity> run_sensitivity(const Body& body, const CampaignSettings& settings,
                                             const std::vector<double>& depths,
                                             const std::vector<RegionConstant>& constants) {
  CampaignSettings normal = settings;
  normal.indentation.held_depths = depths;  // the states that the path must pass
  normal.indentation.depth = *std::max_element(depths.begin(), depths.end());
  normal.indentation.azimuths.clear();  // no lateral paths
  // An equilibrium without friction does not depend on the way there: the depths are steps enough.
  if (normal.indentation.friction == ToolFriction::Frictionless) normal.indentation.increments = 1;
  check_indentation(normal.indentation);
  std::vector<SiteSensitivity> results(settings.sites.size());
  if (results.empty()) return results;
  const CampaignContext context(body, normal, Engine::SharedFactor);
  std::vector<Varied> derivatives;
  for (const RegionConstant& constant : constants) {
    derivatives.push_back(varied(body, normal, constant));
  }
  const CrewSize size = crew_size(*context.rest_factor, settings.threads, results.size(),
                                  settings.memory, bytes_of(context, settings.sites.front()));
  work_abreast(*context.rest_factor, size, results.size(),
               [&](SolveBatch::Member& member, std::size_t i) {
                 results[i] = differentiate_site(context, derivatives, member, settings.sites[i]);
               });
  return results;
}

}  // namespace palpate::fem
