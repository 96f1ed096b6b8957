// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/press_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "fitting/measurement/compare/compare.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"

namespace palpate::app {
namespace {

/// What is left of the uncertainty of a force beside the contact point, at least: the difference of
/// two uncertainties is itself uncertain, and one that is too small makes intervals too narrow.
constexpr double kLeastOwnPart = 0.5;
/// Linearised intervals of a half width below this fraction of the value, of a constant that is
/// correlated with no other beyond this, are not in doubt.
constexpr double kPreciseEnough = 0.1, kInDoubt = 0.95;
/// Distance from the best fit, in standard errors, that is not worth one more evaluation.
constexpr double kCloseEnough = 0.01;

/// One measured curve at the depths, or the travels of a drag, that are compared.
struct Target {
  std::size_t set = 0;  ///< of the measured curves
  std::int32_t vertex = -1;
  std::size_t site = 0;  ///< among those that are solved
  std::size_t plan = 0;  ///< of a lateral path, among those of its site
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;  ///< m, of a lateral path
  std::vector<double> depth, force, uncertainty;
  std::vector<double> slope;  ///< N/m, of the force; from the model, for a measured one is noisy
  double contact_uncertainty = kUnknown;
  int shift = -1;  ///< index of its contact shift among the constants
};

Target target_of(const SiteCurves& site, const CurvePath& path, const std::vector<double>& depths) {
  std::vector<double> x, f, u;
  for (const CurveSample& sample : path.samples) {
    x.push_back(sample.displacement);
    f.push_back(dot(sample.force, path.direction));
    u.push_back(sample.force_uncertainty);
  }
  const compare::MonotoneCubic force(x, f);
  const compare::MonotoneCubic uncertainty(x, u);
  const bool known = std::all_of(u.begin() + 1, u.end(), [](double v) { return std::isfinite(v); });
  Target target;
  target.vertex = site.vertex;
  target.kind = path.kind;
  target.lateral_depth = path.lateral_depth;
  target.contact_uncertainty = path.contact_uncertainty;
  for (const double depth : depths) {
    if (depth > x.back() * (1 + 1e-9)) break;
    target.depth.push_back(depth);
    target.force.push_back(force.value(depth));
    target.uncertainty.push_back(known ? uncertainty.value(depth) : kUnknown);
  }
  return target;
}

/// @param sets  their number: with several, the name says which.
std::string shift_name(const Target& target, std::size_t sets) {
  const std::string of_set = sets > 1 ? fmt::format(", curves {}", target.set + 1) : "";
  if (target.kind == PathKind::Normal) {
    return fmt::format("contact shift of site {}{}", target.vertex, of_set);
  }
  return fmt::format("contact shift of the drag at {} of site {}{}",
                     length_text(target.lateral_depth), target.vertex, of_set);
}

class Fitter {
 public:
  Fitter(std::span<const Curves> measured, PressModel& model, const PressFitSettings& settings)
      : model_(model), settings_(settings) {
    for (const Curves& curves : measured) take_targets(curves);
    known_ = std::all_of(targets_.begin(), targets_.end(), [](const Target& t) {
      return std::all_of(t.uncertainty.begin(), t.uncertainty.end(),
                         [](double u) { return std::isfinite(u) && u > 0; });
    });
    constants_ = model_.constants(plans_.front());
    modulus_ = model_.modulus();
    if (modulus_) constants_[*modulus_].linear = true;
  }

  PressFit run(const std::string& where) {
    const calibrate::LeastSquares problem = make_problem();
    PressFit fit;
    fit.calibration = best_fit(problem, where);
    finish(fit);
    const int before = evaluations_;
    calibrate::ProfileSettings profiles = settings_.profile;
    profiles.of = profiled(fit.calibration);
    if (!profiles.of.empty()) calibrate::add_profiles(problem, fit.calibration, profiles);
    fit.profile_evaluations = evaluations_ - before;
    return fit;
  }

 private:
  struct Evaluation {
    std::vector<double> at;
    bool usable = false;
    std::vector<std::vector<fem::SiteSensitivity>> sites;  ///< of each set
  };
  static constexpr std::size_t kRemembered = 8;

  calibrate::LeastSquares make_problem() {
    calibrate::LeastSquares problem;
    problem.constants = constants_;
    for (Target& target : targets_) {
      if (!known_ || !(target.contact_uncertainty > 0)) continue;
      target.shift = static_cast<int>(problem.constants.size());
      problem.constants.push_back({shift_name(target, plans_.size()), "m", 0, -kInfinity, kInfinity,
                                   /*may_vanish=*/true,
                                   /*logarithm=*/false, /*linear=*/true});
      ++problem.residuals;
    }
    for (const Target& target : targets_) {
      problem.residuals += target.depth.size();
      problem.series.push_back(target.depth.size());
    }
    problem.known_scatter = known_;
    problem.confidence = settings_.confidence;
    problem.max_iterations = 40;
    // Each evaluation may be a campaign: stop well within any interval.
    problem.tolerance = 1e-6;
    problem.step_tolerance = 1e-4;
    problem.offset_tolerance = kCloseEnough;
    problem.linear_first = true;
    problem.model = [this, columns = problem.constants.size()](const double* c, double* r,
                                                               double* J) {
      return evaluate(c, columns, r, J);
    };
    return problem;
  }

  calibrate::Calibration best_fit(const calibrate::LeastSquares& problem,
                                  const std::string& where) {
    std::vector<std::vector<double>> starts = model_.starts(plans_.front());
    if (starts.empty()) return calibrate::minimise(problem, where);
    for (std::vector<double>& start : starts) start.resize(problem.constants.size(), 0);
    return calibrate::minimise(problem, starts, where);
  }

  /// The constants whose profiles are wanted, see Profiles.
  std::vector<std::size_t> profiled(const calibrate::Calibration& calibration) const {
    const std::size_t wanted_of = model_.profiled(plans_.front());
    std::vector<std::size_t> of;
    // Beside a constant at its bound the linearised intervals are those of the others alone.
    bool bounded = false;
    for (std::size_t i = 0; i < wanted_of; ++i)
      bounded = bounded || calibration.estimates[i].at_bound;
    for (std::size_t i = 0; i < wanted_of; ++i) {
      const calibrate::Estimate& e = calibration.estimates[i];
      bool wanted = settings_.profiles == Profiles::All;
      if (settings_.profiles == Profiles::Doubtful) {
        wanted = bounded || !(e.high - e.value < kPreciseEnough * std::abs(e.value));
        for (std::size_t j = 0; j < wanted_of; ++j)
          wanted = wanted || (j != i && std::abs(calibration.correlation[i][j]) > kInDoubt);
      }
      if (wanted) of.push_back(i);
    }
    return of;
  }

  void take_targets(const Curves& measured) {
    double deepest = 0;
    for (const SiteCurves& site : measured.sites) {
      for (const CurvePath& path : site.paths) {
        if (path.kind == PathKind::Normal && path.samples.size() >= 3) {
          deepest = std::max(deepest, path.samples.back().displacement);
        }
      }
    }
    PressPlan& plan = plans_.emplace_back();
    plan.set = plans_.size() - 1;
    for (int i = 1; i <= settings_.depths; ++i)
      plan.depths.push_back(deepest * i / settings_.depths);
    for (const SiteCurves& site : measured.sites) take_paths(site, plan);
    if (plan.vertices.empty()) {
      refuse("measured curves", "they hold no normal path",
             "import presses along the inward "
             "direction");
    }
  }

  void take_paths(const SiteCurves& site, PressPlan& plan) {
    std::vector<fem::LateralPlan> plans;
    std::vector<Target> targets;
    bool has_normal = false;
    for (const CurvePath& path : site.paths) {
      if (path.samples.size() < 3) continue;
      const bool normal = path.kind == PathKind::Normal;
      if (normal ? has_normal : !is_measured_drag(path)) continue;
      Target target = target_of(site, path, normal ? plan.depths : travels_of(path));
      if (target.depth.empty()) continue;
      target.set = plan.set;
      target.site = plan.vertices.size();
      target.plan = plans.size();
      if (!normal) plans.push_back({path.lateral_depth, path.direction, target.depth});
      has_normal = has_normal || normal;
      targets.push_back(std::move(target));
    }
    // A drag alone has no normal curve to hold its depth against.
    if (!has_normal) return;
    plan.vertices.push_back(site.vertex);
    plan.lateral.push_back(std::move(plans));
    for (Target& target : targets) targets_.push_back(std::move(target));
  }

  /// A path without repeats was computed, not measured.
  bool is_measured_drag(const CurvePath& path) const {
    return settings_.drags && path.kind == PathKind::Lateral && path.repeats > 0 &&
           path.lateral_depth > 0;
  }

  std::vector<double> travels_of(const CurvePath& path) const {
    std::vector<double> travels;
    for (int i = 1; i <= settings_.depths; ++i) {
      travels.push_back(path.samples.back().displacement * i / settings_.depths);
    }
    return travels;
  }

  const std::vector<fem::ForceSensitivity>& model_of(const Target& target) const {
    const fem::SiteSensitivity& site = recent_.front().sites[target.set][target.site];
    return target.kind == PathKind::Normal ? site.samples : site.lateral[target.plan];
  }

  /// The slopes of the first evaluation, scaled to the measured forces, serve throughout: weights
  /// that moved with the constants would bias them.
  void freeze_slopes() {
    for (Target& target : targets_) {
      const std::vector<fem::ForceSensitivity>& model = model_of(target);
      std::vector<double> x{0}, f{0};
      double product = 0, square = 0;
      for (std::size_t i = 0; i < target.depth.size(); ++i) {
        x.push_back(model[i].depth);
        f.push_back(model[i].force);
        product += target.force[i] * f.back();
        square += f.back() * f.back();
      }
      const double scale = product / square;
      const compare::MonotoneCubic curve(x, f);
      for (std::size_t i = 0; i < target.depth.size(); ++i) {
        // The lateral force of a sphere without slip grows as the root of its depth, see
        // lateral_paths().
        target.slope.push_back(scale * (target.kind == PathKind::Normal
                                            ? curve.slope(target.depth[i])
                                            : model[i].force / (2 * target.lateral_depth)));
      }
    }
  }

  /// The model at these constants, with the modulus at its start: its forces times modulus_factor()
  /// are those of any other. The last evaluations are remembered: a descent asks for values and
  /// slopes separately, and goes back when a step does not help.
  bool solve(std::vector<double> at) {
    if (modulus_) at[*modulus_] = constants_[*modulus_].start;
    const auto known = std::find_if(recent_.begin(), recent_.end(),
                                    [&](const Evaluation& e) { return e.at == at; });
    if (known != recent_.end()) {
      std::rotate(recent_.begin(), known, known + 1);
      return recent_.front().usable;
    }
    if (recent_.size() == kRemembered) recent_.pop_back();
    recent_.emplace_front().at = std::move(at);
    ++evaluations_;
    const std::string outcome = run_model(recent_.front());
    if (settings_.log)
      settings_.log(
          fmt::format("evaluation {}:{}{}", evaluations_, text_of(recent_.front().at), outcome));
    if (recent_.front().usable && targets_.front().slope.empty()) freeze_slopes();
    return recent_.front().usable;
  }

  /// What went wrong, as a clause for the log; empty where nothing did.
  std::string run_model(Evaluation& evaluation) {
    evaluation.sites.resize(plans_.size());
    for (const PressPlan& plan : plans_) {
      std::string refusal;
      if (!model_.forces(plan, evaluation.at, evaluation.sites[plan.set], refusal))
        return ", " + refusal;
    }
    std::string failures;
    for (const Target& target : targets_) {
      if (model_of(target).size() >= target.depth.size()) continue;
      failures += fmt::format(", failed at site {}: {}", target.vertex,
                              evaluation.sites[target.set][target.site].reason);
    }
    evaluation.usable = failures.empty();
    return failures;
  }

  /// The constants that an evaluation is for: without the modulus, unless there is no other.
  std::string text_of(const std::vector<double>& at) const {
    std::string text;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (i == modulus_ && at.size() > 1) continue;
      text += fmt::format(" {} = {:.6g}", constants_[i].name, at[i]);
    }
    return text;
  }

  double modulus_factor(const double* constants) const {
    return modulus_ ? constants[*modulus_] / constants_[*modulus_].start : 1;
  }

  /// Standard uncertainty of a sample beside that of its contact point.
  double own_uncertainty(const Target& target, std::size_t i) const {
    if (!known_) return 1;
    const double u = target.uncertainty[i];
    if (target.shift < 0) return u;
    const double of_contact = target.slope[i] * target.contact_uncertainty;
    return std::sqrt(
        std::max(u * u - of_contact * of_contact, kLeastOwnPart * kLeastOwnPart * u * u));
  }

  bool evaluate(const double* c, std::size_t columns, double* r, double* J) {
    const std::vector<double> sought(c, c + constants_.size());
    if (!solve(sought)) return false;
    const double factor = modulus_factor(c);
    std::size_t row = 0;
    for (const Target& target : targets_) {
      const std::vector<fem::ForceSensitivity>& samples = model_of(target);
      const double shift = target.shift < 0 ? 0 : c[target.shift];
      for (std::size_t i = 0; i < target.depth.size(); ++i, ++row) {
        const fem::ForceSensitivity& model = samples[i];
        const double u = own_uncertainty(target, i);
        r[row] = (factor * model.force + target.slope[i] * shift - target.force[i]) / u;
        if (J == nullptr) continue;
        std::fill(J + row * columns, J + (row + 1) * columns, 0.0);
        for (std::size_t k = 0; k < sought.size(); ++k)
          J[row * columns + k] = (k == modulus_ ? 1 : factor) * model.slope[k] / u;
        if (target.shift >= 0) {
          J[row * columns + static_cast<std::size_t>(target.shift)] = target.slope[i] / u;
        }
      }
    }
    for (const Target& target : targets_) {
      if (target.shift < 0) continue;
      r[row] = c[target.shift] / target.contact_uncertainty;
      if (J != nullptr) {
        std::fill(J + row * columns, J + (row + 1) * columns, 0.0);
        J[row * columns + static_cast<std::size_t>(target.shift)] = 1 / target.contact_uncertainty;
      }
      ++row;
    }
    return true;
  }

  void finish(PressFit& fit) {
    std::vector<double> found;
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      found.push_back(fit.calibration.estimates[i].value);
    }
    solve(found);
    const double factor = modulus_factor(found.data());
    double squares = 0, largest = 0;
    std::size_t count = 0;
    for (const Target& target : targets_) {
      const std::vector<fem::ForceSensitivity>& model = model_of(target);
      FittedPath path;
      path.set = target.set;
      path.vertex = target.vertex;
      path.kind = target.kind;
      path.lateral_depth = target.lateral_depth;
      path.depth = target.depth;
      path.measured = target.force;
      path.uncertainty = target.uncertainty;
      if (target.shift >= 0) {
        path.contact_shift =
            fit.calibration.estimates[static_cast<std::size_t>(target.shift)].value;
      }
      for (std::size_t i = 0; i < target.depth.size(); ++i) {
        path.fitted.push_back(factor * model[i].force + target.slope[i] * path.contact_shift);
        const double e = path.fitted.back() - target.force[i];
        squares += e * e;
        largest = std::max(largest, std::abs(target.force[i]));
        ++count;
      }
      fit.paths.push_back(std::move(path));
    }
    fit.rms = std::sqrt(squares / static_cast<double>(count));
    fit.relative_rms = fit.rms / largest;
    fit.evaluations = evaluations_;
  }

  PressModel& model_;
  const PressFitSettings& settings_;
  std::vector<PressPlan> plans_;                ///< of each set
  std::vector<calibrate::Constant> constants_;  ///< of the model
  std::optional<std::size_t> modulus_;
  std::vector<Target> targets_;
  bool known_ = false;
  std::deque<Evaluation> recent_;  ///< the latest first
  int evaluations_ = 0;
};

}  // namespace

PressFit fit_presses(std::span<const Curves> measured, PressModel& model,
                     const PressFitSettings& settings, const std::string& where) {
  return Fitter(measured, model, settings).run(where);
}

}  // namespace palpate::app
