// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/site_equilibrium.hpp"

#include <algorithm>

#include "fem/solve/turned_factor.hpp"

namespace palpate::fem {

namespace {

/// Residual at which the shared-factor solver stops, over the wanted error of the force. The force
/// is off by up to twice that residual on a lateral path (bench_precompute errors).
constexpr double kSharedTolerance = 0.5;
/// Factor on that tolerance for a no-slip normal path: the surface is bonded where it is met, so
/// that errors add up, and an error may decide whether a node has touched.
constexpr double kNoSlipTolerance = 0.5;
/// Residual before the touch, over the weight.
constexpr double kSettled = 1e-6;
/// Steps with the shared factor before a site gets a factor of its own: as many as that costs, by
/// its size, and no more than an increment may take.
constexpr int kFewestSteps = 15, kMostSteps = 80;
constexpr double kBytesOfStep = 1e7;

int steps_before_own_factor(const RestFactor& factor) {
  return static_cast<int>(
      std::clamp<double>(factor.bytes() / kBytesOfStep, kFewestSteps, kMostSteps));
}

/// A factor of the body as it has turned, in the place that memory has for it. Which site waits for
/// a place changes no result.
struct OwnFactor {
  OwnFactor(const CampaignContext& context, SolvePool::Member& member, const Displacement& u)
      : place(context, member),
        turned(context.model, context.permutation,
               context.rest_factor->in_double_precision() ? Precision::Double : Precision::Single,
               u.leftCols(context.model.mesh().nodes())) {}

  OwnFactorPlace place;
  TurnedFactor turned;
};

SharedFactorSolver::BentBody bent_body(const CampaignContext& context, SolvePool::Member& member) {
  const auto turned_solve = [&](const Displacement& u) -> SharedFactorSolver::RestSolve {
    return [own = std::make_shared<OwnFactor>(context, member, u)](
               const Eigen::VectorXd& b, Eigen::VectorXd& x) { own->turned.solve(b, x); };
  };
  const int steps = steps_before_own_factor(*context.rest_factor);
  return {turned_solve, steps, steps - kFewestSteps, context.at_rest.energy};
}

}  // namespace

std::size_t pairs_needed(const CampaignContext& context) {
  const bool no_slip = context.indentation.friction == ToolFriction::NoSlip;
  return no_slip || !context.model.mesh().sprung.empty() ? SharedFactorSolver::kMostPairs
                                                         : SharedFactorSolver::kFewPairs;
}

SiteEquilibrium::SiteEquilibrium(const CampaignContext& context, const SiteBody& body,
                                 SolvePool::Member* member)
    : context_(context),
      force_tolerance_(context.indentation.force_tolerance),
      member_(member),
      direct_possible_(body.prolongation() == nullptr) {
  if (context.engine == Engine::Direct) return;
  shared_ = std::make_unique<SharedFactorSolver>(
      body.whole(), body.window(),
      [member](const Eigen::VectorXd& b, Eigen::VectorXd& x) { member->solve(b, x); },
      bent_body(context, *member), pairs_needed(context), body.prolongation(),
      &context.window_fronts);
}

NewtonResult SiteEquilibrium::solve(const ToolContact& contact, bool direct_allowed,
                                    Displacement& u) {
  NewtonResult result;
  if (shared_) {
    result = solve_shared(contact, options_of_shared(), u);
    if (result.converged || !direct_allowed || !direct_possible_) return result;
  }
  const int before = result.iterations;
  result = shared_ ? solve_direct_alone(contact, u) : solve_direct(contact, u);
  result.iterations += before;
  if (shared_ && result.converged) shared_->accept(contact.tool().tip, u);
  return result;
}

void SiteEquilibrium::start_path(const Tool& tool, const Displacement& u) {
  if (shared_) shared_->start_path(tool.tip, u);
  if (direct_) direct_->start_path();
}

NewtonResult SiteEquilibrium::settle(const ToolContact& contact, Displacement& u) {
  NewtonOptions options = options_of_shared();
  options.least_force = context_.model.weight_norm();
  options.tolerance = kSettled;
  return solve_shared(contact, options, u);
}

NewtonOptions SiteEquilibrium::options_of_shared() const {
  NewtonOptions options;
  options.round_off = context_.round_off;
  options.tolerance = kSharedTolerance * force_tolerance_;
  options.max_iterations = kMostSteps + steps_before_own_factor(*context_.rest_factor);
  if (context_.indentation.friction == ToolFriction::NoSlip) options.tolerance *= kNoSlipTolerance;
  return options;
}

NewtonResult SiteEquilibrium::solve_shared(const ToolContact& contact, const NewtonOptions& options,
                                           Displacement& u) {
  Displacement trial = u;
  NewtonResult result = shared_->solve(contact, options, trial);
  if (result.converged)
    u.swap(trial);
  else
    shared_->restart();
  return result;
}

NewtonResult SiteEquilibrium::solve_direct(const ToolContact& contact, Displacement& u) {
  NewtonOptions options;
  options.round_off = context_.round_off;
  options.tolerance = force_tolerance_;
  if (!direct_) direct_ = std::make_unique<NewtonSolver>(context_.model, &context_.permutation);
  return direct_->solve(contact, options, u);
}

/// One site at a time, and the factor is freed at once: factors of the whole body, one for each
/// site that runs, would fill the memory.
NewtonResult SiteEquilibrium::solve_direct_alone(const ToolContact& contact, Displacement& u) {
  std::unique_lock lock(context_.direct_solve, std::try_to_lock);
  if (!lock) member_->without_core([&lock] { lock.lock(); });
  const OwnFactorPlace place(context_, *member_);
  NewtonResult result = solve_direct(contact, u);
  direct_.reset();
  return result;
}

}  // namespace palpate::fem
