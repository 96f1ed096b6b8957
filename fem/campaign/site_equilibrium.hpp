// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <memory>

#include "fem/campaign/campaign_context.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fem/solve/newton.hpp"
#include "fem/solve/shared_factor_solver.hpp"

namespace palpate::fem {

/// Curvature pairs that the shared-factor solver of a campaign keeps at most.
std::size_t pairs_needed(const CampaignContext& context);

/// The solvers of one site: first the shared factor, then Newton's method on the whole body where
/// that fails. A body with refined elements is never factorized as a whole, so that it has only the
/// first. One thread.
class SiteEquilibrium {
 public:
  /// `member`: may be null for Engine::Direct.
  SiteEquilibrium(const CampaignContext& context, const SiteBody& body, SolvePool::Member* member);

  /// Moves `u` to the equilibrium. `direct_allowed`: the whole body may be factorized, which costs
  /// about a hundred times more.
  NewtonResult solve(const ToolContact& contact, bool direct_allowed, Displacement& u);

  /// Moves `u` to the equilibrium under the weight, without the tool, by the shared factor. The
  /// residual is then at most 1e-6 of the weight: no mode is off by more than that part of its sag.
  NewtonResult settle(const ToolContact& contact, Displacement& u);

  /// To be called at the start of a path: the tool and the equilibrium there.
  void start_path(const Tool& tool, const Displacement& u);

  /// From here on the relative error of the tool force may be this instead of that of the settings.
  void allow_error(double force_tolerance) { force_tolerance_ = force_tolerance; }

 private:
  NewtonOptions options_of_shared() const;
  NewtonResult solve_shared(const ToolContact& contact, const NewtonOptions& options,
                            Displacement& u);
  NewtonResult solve_direct(const ToolContact& contact, Displacement& u);
  NewtonResult solve_direct_alone(const ToolContact& contact, Displacement& u);

  const CampaignContext& context_;
  double force_tolerance_;
  SolvePool::Member* member_;
  bool direct_possible_;
  std::unique_ptr<SharedFactorSolver> shared_;
  std::unique_ptr<NewtonSolver> direct_;
};

}  // namespace palpate::fem
