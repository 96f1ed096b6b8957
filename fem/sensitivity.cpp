// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/sensitivity.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "fem/at.hpp"
#include "fem/indentation.hpp"
#include "fem/laws/law.hpp"
#include "fem/region_laws.hpp"
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
  v.penalty =
      std::log(contact_stiffness(body, more, v.more) / contact_stiffness(body, less, v.less)) /
      v.width;
  return v;
}

/// Differentiates at the equilibria of one site.
class Differentiator {
 public:
  Differentiator(const CampaignContext& context, const std::vector<Varied>& constants)
      : context_(context),
        constants_(constants),
        factor_(context.model.pattern(), &context.permutation) {}

  /// False when the stiffness is not positive definite: the equilibrium is at a limit point.
  bool differentiate(const ToolContact& contact, const Displacement& u, const Vec3& inward,
                     std::vector<double>& slope) {
    const SolidModel& model = context_.model;
    model.stiffness(u, K_);
    contact.add_stiffness(model, u, true, K_);
    if (!factor_.factorize(K_)) return false;
    const Eigen::Vector3d direction(inward[0], inward[1], inward[2]);
    Eigen::VectorXd contact_forces = Eigen::VectorXd::Zero(model.pattern().n);
    contact.add_forces(model, u, contact_forces);
    slope.clear();
    for (const Varied& constant : constants_) {
      Eigen::VectorXd d(model.pattern().n);
      const Eigen::VectorXd load = -(constant.slope(u) + constant.penalty * contact_forces);
      factor_.solve(load.data(), d.data(), workspace_);
      Displacement du = Displacement::Zero(3, u.cols());
      move(model, 1, d, du);
      const Eigen::Vector3d dF =
          contact.tool_force_slope(u, du) + constant.penalty * contact.tool_force(u);
      slope.push_back(dF.dot(direction));
    }
    return true;
  }

 private:
  const CampaignContext& context_;
  const std::vector<Varied>& constants_;
  Cholesky factor_;
  SolveWorkspace workspace_;
  std::vector<double> K_;
};

bool is_among(double depth, const std::vector<double>& depths) {
  return std::any_of(depths.begin(), depths.end(),
                     [&](double d) { return std::abs(d - depth) < 1e-9 * depth; });
}

SiteSensitivity differentiate_site(const CampaignContext& context, SolveBatch::Member* batch,
                                   Differentiator& differentiator, std::int32_t vertex) {
  SiteSensitivity result;
  result.vertex = vertex;
  const Vec3 inward = context.body.response.inward[at(vertex)];
  SiteSolver solver(context, batch);
  solver.observe([&](const ToolContact& contact, const Displacement& u, const CurveSample& sample) {
    if (!is_among(sample.displacement, context.indentation.held_depths)) return;
    ForceSensitivity s{sample.displacement, dot(sample.force, inward), {}};
    if (differentiator.differentiate(contact, u, inward, s.slope)) {
      result.samples.push_back(std::move(s));
    } else if (result.reason.empty()) {
      result.reason = "the stiffness is not positive definite at an equilibrium";
    }
  });
  const SiteCurves curves = solver.solve(vertex);
  if (!curves.reason.empty()) result.reason = curves.reason;
  return result;
}

}  // namespace

std::vector<SiteSensitivity> run_sensitivity(const Body& body, const CampaignSettings& settings,
                                             const std::vector<double>& depths,
                                             const std::vector<RegionConstant>& constants) {
  CampaignSettings normal = settings;
  normal.indentation.held_depths = depths;  // the states that the path must pass
  normal.indentation.depth = *std::max_element(depths.begin(), depths.end());
  normal.indentation.azimuths.clear();  // no lateral paths
  check_indentation(normal.indentation);
  const CampaignContext context(body, normal, Engine::SharedFactor);
  std::vector<Varied> derivatives;
  for (const RegionConstant& constant : constants) {
    derivatives.push_back(varied(body, normal, constant));
  }
  std::vector<SiteSensitivity> results(settings.sites.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      use_one_thread_per_site();
      SolveBatch batch(*context.rest_factor, 1);
      SolveBatch::Member member(batch, 0);
      Differentiator differentiator(context, derivatives);
      for (std::size_t i = next++; i < results.size(); i = next++) {
        results[i] = differentiate_site(context, &member, differentiator, settings.sites[i]);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
      next = results.size();
    }
  };
  std::vector<std::thread> threads;
  const auto count = std::min<std::size_t>(at(std::max(1, settings.threads)), results.size());
  for (std::size_t t = 0; t < count; ++t) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace palpate::fem
