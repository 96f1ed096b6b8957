// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/relaxation_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fitting/measurement/relaxation/information.hpp"
#include "fitting/measurement/relaxation/relaxation_problem.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

struct Candidate {
  TriedSeries tried;
  std::optional<Calibration> calibration;
};

std::vector<double> values_of(const Calibration& c) {
  std::vector<double> values;
  for (const Estimate& e : c.estimates) values.push_back(e.value);
  return values;
}

/// Why a series of free times is no series of so many terms.
std::string refusal_of(const ConstantPlaces& p, const Calibration& c) {
  constexpr double kApart = 1.2;
  for (std::size_t i = 0; p.time && i < p.terms; ++i) {
    const Estimate &g = c.estimates[p.fraction + i], &time = c.estimates[*p.time + i];
    if (g.at_bound) return "the fraction of a term vanishes";
    if (time.at_bound && p.terms > 1) return "a time is at the end of what is sought";
    if (i > 0 && time.value - c.estimates[*p.time + i - 1].value < std::log(kApart))
      return "two times are within a fifth of each other";
  }
  return "";
}

Candidate candidate_of(const RelaxationProblem& problem, std::size_t terms) {
  Candidate candidate;
  candidate.tried.terms = static_cast<int>(terms);
  candidate.tried.aicc = candidate.tried.bic = candidate.tried.relative_rms = kUnknown;
  const LeastSquares squares = problem.squares(terms);
  if (squares.residuals <= squares.constants.size() + 3) {
    candidate.tried.refused = "there are too few samples";
    return candidate;
  }
  candidate.calibration = converged_minimum(squares, problem.starts(terms), "relaxation");
  if (!candidate.calibration) {
    candidate.tried.refused = "the fit does not converge";
    return candidate;
  }
  std::vector<double> r(squares.residuals);
  squares.model(values_of(*candidate.calibration).data(), r.data(), nullptr);
  const Information information = information_of(r, squares.series, squares.constants.size());
  candidate.tried.aicc = information.aicc;
  candidate.tried.bic = information.bic;
  candidate.tried.relative_rms =
      std::sqrt(2 * candidate.calibration->cost / static_cast<double>(r.size()));
  candidate.tried.refused = refusal_of(problem.places(terms), *candidate.calibration);
  return candidate;
}

double value_of(const TriedSeries& tried, Criterion criterion) {
  return criterion == Criterion::Bic ? tried.bic : tried.aicc;
}

std::vector<Candidate> candidates_of(const RelaxationProblem& problem,
                                     const RelaxationSettings& settings) {
  std::vector<Candidate> candidates;
  candidates.push_back(candidate_of(problem, 0));
  if (!settings.times.empty()) {
    candidates.push_back(candidate_of(problem, settings.times.size()));
    return candidates;
  }
  const int first = settings.terms > 0 ? settings.terms : 1;
  const int last = settings.terms > 0 ? settings.terms : settings.most_terms;
  for (int n = first; n <= last; ++n) {
    candidates.push_back(candidate_of(problem, static_cast<std::size_t>(n)));
    const TriedSeries &tried = candidates.back().tried,
                      &before = candidates[candidates.size() - 2].tried;
    const bool good = tried.refused.empty() &&
                      value_of(tried, settings.criterion) < value_of(before, settings.criterion);
    if (!good && before.terms > 0 && before.refused.empty()) break;
  }
  return candidates;
}

/// The series that is taken: the first candidate is the elastic body.
const Candidate& choose(const std::vector<Candidate>& candidates,
                        const RelaxationSettings& settings, const std::string& where) {
  const Candidate* best = nullptr;
  std::string why;
  for (const Candidate& c : candidates) {
    if (c.tried.terms > 0 && !c.tried.refused.empty())
      why +=
          (why.empty() ? "" : "; ") + std::to_string(c.tried.terms) + " terms: " + c.tried.refused;
    if (!c.calibration || !c.tried.refused.empty()) continue;
    if (best == nullptr ||
        value_of(c.tried, settings.criterion) < value_of(best->tried, settings.criterion))
      best = &c;
  }
  if (best == nullptr || (best->tried.terms == 0 && !why.empty())) {
    refuse(where, "no series is found (" + why + ")",
           "try fewer terms, give the times, or record a longer hold after a faster ramp");
  }
  if (best->tried.terms == 0) {
    refuse(where, "the records show no relaxation: an elastic body explains them as well",
           "hold longer; what relaxes within the ramp or after the record is not seen");
  }
  return *best;
}

/// Linear combinations of the estimates with their intervals, by the delta method.
class Delta {
 public:
  explicit Delta(const Calibration& c) : c_(c) {
    for (const Estimate& e : c.estimates)
      if (std::isfinite(e.standard_error) && e.standard_error > 0)
        t_ = (e.high - e.value) / e.standard_error;
  }

  Interval of(double value, const std::vector<double>& slope) const {
    double variance = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
      for (std::size_t j = 0; j < slope.size(); ++j) {
        const double both = slope[i] * slope[j];
        if (both == 0 || !std::isfinite(c_.correlation[i][j])) continue;
        variance += both * c_.correlation[i][j] * c_.estimates[i].standard_error *
                    c_.estimates[j].standard_error;
      }
    }
    const double half = t_ * std::sqrt(std::max(0.0, variance));
    return {value, value - half, value + half};
  }

 private:
  const Calibration& c_;
  double t_ = 0;
};

/// What follows from the constants. `c` has the logarithms of the times.
class Reader {
 public:
  Reader(const RelaxationProblem& problem, const ConstantPlaces& places, const Calibration& c)
      : problem_(problem), p_(places), values_(values_of(c)), delta_(c) {}

  BodyConstants<double> body(std::size_t record) const {
    return problem_.body(p_, values_.data(), record);
  }

  /// g at a time; infinity gives the long-term fraction.
  Interval relaxed(double t) const {
    const BodyConstants<double> b = body(0);
    std::vector<double> slope(values_.size(), 0.0);
    double g = 1;
    for (std::size_t i = 0; i < p_.terms; ++i) {
      const double x = t / b.time[i], left = std::exp(-x);
      g -= b.fraction[i] * (1 - left);
      slope[p_.fraction + i] = left - 1;
      if (p_.time) slope[*p_.time + i] = left > 0 ? b.fraction[i] * left * x : 0;
    }
    return delta_.of(g, slope);
  }

  FittedRecord fitted(std::size_t record) const {
    const HistoryModel& model = problem_.models()[record];
    const BodyConstants<double> b = body(record);
    FittedRecord out;
    out.name = model.record().name;
    out.fitted = model.predict(b);
    double squares = 0;
    for (std::size_t i = 0; i < out.fitted.size(); ++i)
      squares += std::pow(out.fitted[i] - model.measured()[i], 2);
    out.rms = std::sqrt(squares / static_cast<double>(out.fitted.size()));
    out.relative_rms = out.rms / model.scale();
    std::vector<double> slope(values_.size(), 0.0);
    slope[record] = 1;
    out.instantaneous = delta_.of(b.force, slope);
    const double rest = relaxed(kInfinity).value;
    slope[record] = rest;
    for (std::size_t i = 0; i < p_.terms; ++i) slope[p_.fraction + i] = -b.force;
    out.long_term = delta_.of(b.force * rest, slope);
    return out;
  }

 private:
  const RelaxationProblem& problem_;
  ConstantPlaces p_;
  std::vector<double> values_;
  Delta delta_;
};

/// Logarithms of the times -> times.
void turn_into_seconds(const ConstantPlaces& p, Calibration& c) {
  for (std::size_t i = 0; p.time && i < p.terms; ++i) {
    Estimate& e = c.estimates[*p.time + i];
    const double time = std::exp(e.value);
    e.value = time;
    e.logarithm = false;
    e.standard_error *= time;
    e.unit_error *= time;
    for (double* end : {&e.low, &e.high, &e.profile_low, &e.profile_high}) *end = std::exp(*end);
    for (auto& [value, rise] : e.profile) value = std::exp(value);
  }
}

std::string seconds(double t) {
  return number_text(t) + " s";
}

void warn_of_unseen_times(const RelaxationFit& fit, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < fit.series.size(); ++i) {
    const double time = fit.series[i].time_s;
    const std::string name = "the relaxation time " + seconds(time);
    if (time < fit.shortest)
      warnings.push_back(name + " is shorter than the record resolves (" + seconds(fit.shortest) +
                         ", of ramp and sampling): only the product of its fraction and time is "
                         "determined, and the instantaneous constants with it are not");
    if (time > fit.longest)
      warnings.push_back(name + " is longer than the record (" + seconds(fit.longest) +
                         "): its fraction and the long-term constants are extrapolated");
  }
}

void warn_of_wide_times(const ConstantPlaces& p, Calibration& c) {
  constexpr double kWide = 4;
  for (std::size_t i = 0; p.time && i < p.terms; ++i) {
    const Estimate& e = c.estimates[*p.time + i];
    if (e.at_bound || !(e.high > kWide * e.low)) continue;
    c.warnings.push_back(e.name + " is not determined: its interval spans a factor of " +
                         number_text(e.high / e.low));
  }
}

void add_profiles_of_series(const LeastSquares& squares, const ConstantPlaces& p, Calibration& c) {
  ProfileSettings settings;
  settings.between = 4;
  for (std::size_t i = p.fraction; i < p.count; ++i) settings.of.push_back(i);
  add_profiles(squares, c, settings);
}

}  // namespace

RelaxationFit fit_relaxation(const std::vector<RelaxationRecord>& records,
                             const RelaxationSettings& settings) {
  constexpr int kBandPoints = 60;
  const RelaxationProblem problem(records, settings);
  const std::vector<Candidate> candidates = candidates_of(problem, settings);
  const Candidate& best = choose(candidates, settings, records.front().name);
  const auto terms = static_cast<std::size_t>(best.tried.terms);
  const ConstantPlaces places = problem.places(terms);
  RelaxationFit fit;
  fit.calibration = *best.calibration;
  if (settings.profiles) add_profiles_of_series(problem.squares(terms), places, fit.calibration);
  const Reader reader(problem, places, fit.calibration);
  const BodyConstants<double> body = reader.body(0);
  for (std::size_t i = 0; i < terms; ++i)
    if (body.fraction[i] > 0) fit.series.push_back({body.fraction[i], body.time[i]});
  fit.exponent = body.exponent;
  fit.second_power = body.second_power;
  fit.largest_travel = problem.largest_travel();
  fit.shortest = problem.shortest_seen();
  fit.longest = problem.longest_seen();
  fit.long_term_fraction = reader.relaxed(kInfinity);
  for (const Candidate& candidate : candidates) fit.tried.push_back(candidate.tried);
  for (std::size_t k = 0; k < records.size(); ++k) fit.records.push_back(reader.fitted(k));
  const double from = 0.1 * fit.shortest;
  for (int i = 0; i <= kBandPoints; ++i) {
    const double t = from * std::pow(fit.longest / from, static_cast<double>(i) / kBandPoints);
    fit.band.push_back({t, reader.relaxed(t)});
  }
  turn_into_seconds(places, fit.calibration);
  warn_of_wide_times(places, fit.calibration);
  warn_of_unseen_times(fit, fit.calibration.warnings);
  return fit;
}

}  // namespace palpate::calibrate
