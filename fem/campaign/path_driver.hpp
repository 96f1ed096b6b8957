// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fem/campaign/predictor.hpp"
#include "fem/campaign/site_equilibrium.hpp"
#include "fem/contact/self_contact.hpp"
#include "format/curves.hpp"

namespace palpate::fem {

/// What a path is followed with. The references must outlive the driver.
struct PathProblem {
  const SolidModel& model;
  ToolContact& contact;  ///< moved along the path
  SiteEquilibrium& equilibrium;
  const SelfContact& self_contact;
  double tool_radius;                   ///< m
  double energy_at_rest;                ///< J, subtracted from the energy of the samples
  double volume_at_rest;                ///< m^3, subtracted from the volume
  bool follows_work;                    ///< integrate the work of the tool within increments
  bool relaxes;                         ///< samples have the energies of the regions
  std::function<Tool(double)> tool_at;  ///< the tool at a travel, m
};

/// Follows a path in increments, each predicted from the last, and halves those that fail. The path
/// ends where no equilibrium is found, or where that which is found is no indentation: the tool
/// penetrates a constrained region or lost contact, the body meets itself, or the law loses
/// ellipticity. The onset of either is found to a 32nd of the increment.
class PathDriver {
 public:
  /// `u`: the equilibrium at travel 0.
  PathDriver(PathProblem problem, const Displacement& u) : problem_(std::move(problem)) {
    problem_.equilibrium.start_path(problem_.tool_at(0), u);
  }

  /// From `from`, where `states` end, to `to`. True: u is the equilibrium and `sample` is filled
  /// but for the work. False: `reason` says why, one clause; where reached() lies beyond `from`, u,
  /// `sample` and the tool of the contact are those of the last equilibrium before it.
  bool advance(double from, double to, Predictor& states, Displacement& u, CurveSample& sample,
               std::string& reason);

  /// From an equilibrium at `s`, which bonding has changed or which is less accurate, to the one
  /// there is now: u, `sample` and the last of `states`. False: `reason` says why, and they are as
  /// before.
  bool settle(double s, Predictor& states, Displacement& u, CurveSample& sample,
              std::string& reason);

  /// m, end of the last advance().
  double reached() const { return reached_; }
  /// J, of the tool in the last advance(); nothing where it could not be integrated.
  std::optional<double> work() const { return work_; }

 private:
  enum class Outcome {
    Found,
    NotFound,    ///< a smaller step may help
    Meaningless  ///< found, but no indentation: smaller steps lead to its onset
  };

  Outcome equilibrate(double s, int halvings, Displacement& u, CurveSample& sample,
                      std::string& reason);
  /// Why the equilibrium of `sample` is no indentation; empty when it is one.
  std::string fault_of(const CurveSample& sample, const Displacement& u) const;
  /// `known`: the state of the body at u.
  void record(double s, const Displacement& u, const std::optional<SolidModel::State>& known,
              CurveSample& sample) const;
  void add_work(double from, const Displacement& before, const Displacement& after);

  PathProblem problem_;
  std::optional<double> work_;
  double reached_ = 0;
};

}  // namespace palpate::fem
