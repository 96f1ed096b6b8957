// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/relaxation_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "fitting/measurement/relaxation/series_starts.hpp"
#include "format/error.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

constexpr double kLeastExponent = 0.5, kMostExponent = 6;
constexpr std::size_t kFewStarts = 3;

void check(const std::vector<RelaxationRecord>& records, const RelaxationSettings& s) {
  const std::string where = "relaxation";
  const int most = static_cast<int>(kMostTerms);
  if (records.empty()) refuse(where, "there is no record", "give one record or more");
  if (s.terms < 0 || s.terms > most || s.most_terms < 1 || s.most_terms > most)
    refuse(where, "the number of terms is not within 1 .. " + std::to_string(most), "correct it");
  if (!(s.exponent >= kLeastExponent && s.exponent <= kMostExponent))
    refuse(where, "the exponent is not within 0.5 .. 6", "1.5 is that of a sphere");
  if (s.times.size() > kMostTerms)
    refuse(where, "more than " + std::to_string(most) + " times are given", "give fewer times");
  for (std::size_t i = 0; i < s.times.size(); ++i) {
    if (s.times[i] > (i == 0 ? 0 : s.times[i - 1]) && std::isfinite(s.times[i])) continue;
    refuse(where, "the times are not positive and ascending", "sort them");
  }
}

std::vector<double> logarithmic(double from, double to, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(from *
                  std::pow(to / from, (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
  return out;
}

}  // namespace

RelaxationProblem::RelaxationProblem(const std::vector<RelaxationRecord>& records,
                                     const RelaxationSettings& settings)
    : settings_(settings) {
  check(records, settings);
  shortest_time_ = shortest_seen_ = kInfinity;
  for (const RelaxationRecord& r : records)
    largest_travel_ =
        std::max(largest_travel_, *std::max_element(r.travel.begin(), r.travel.end()));
  for (const RelaxationRecord& r : records) {
    if (r.span() > longest_seen_) longest_record_ = models_.size();
    models_.emplace_back(r, largest_travel_);
    const double samples = 2 * r.interval();
    shortest_time_ = std::min(shortest_time_, std::max(samples, 0.02 * r.ramp));
    shortest_seen_ = std::min(shortest_seen_, std::max(samples, 0.1 * r.ramp));
    longest_seen_ = std::max(longest_seen_, r.span());
  }
  longest_time_ = 3 * longest_seen_;
}

ConstantPlaces RelaxationProblem::places(std::size_t terms) const {
  ConstantPlaces p;
  p.records = models_.size();
  p.terms = terms;
  std::size_t next = p.records;
  if (settings_.fit_exponent) p.exponent = next++;
  if (settings_.curve == ElasticCurve::TwoPowers) p.second_power = next++;
  p.fraction = next;
  next += terms;
  if (settings_.times.empty()) {
    p.time = next;
    next += terms;
  }
  p.count = next;
  return p;
}

std::vector<std::size_t> RelaxationProblem::series() const {
  std::vector<std::size_t> lengths;
  for (const HistoryModel& model : models_) lengths.push_back(model.measured().size());
  return lengths;
}

BodyConstants<double> RelaxationProblem::body(const ConstantPlaces& places, const double* c,
                                              std::size_t record) const {
  BodyConstants<double> body{c[record],
                             places.exponent ? c[*places.exponent] : settings_.exponent,
                             places.second_power ? c[*places.second_power] : 0.0,
                             {},
                             {}};
  for (std::size_t i = 0; i < places.terms; ++i) {
    body.fraction.push_back(c[places.fraction + i]);
    body.time.push_back(places.time ? std::exp(c[*places.time + i]) : settings_.times[i]);
  }
  return body;
}

bool RelaxationProblem::evaluate(const ConstantPlaces& places, const double* c, double* r,
                                 double* J) const {
  constexpr double kLeastRest = 1e-9;
  double sum = 0;
  for (std::size_t i = 0; i < places.terms; ++i) sum += c[places.fraction + i];
  if (!(sum < 1 - kLeastRest)) return false;
  std::vector<double> slopes;
  std::size_t row = 0;
  for (std::size_t k = 0; k < models_.size(); ++k) {
    const HistoryModel& model = models_[k];
    const BodyConstants<double> constants = body(places, c, k);
    const std::size_t samples = model.measured().size(), n = HistoryModel::columns(places.terms);
    if (J == nullptr) {
      const std::vector<double> values = model.predict(constants);
      for (std::size_t i = 0; i < samples; ++i)
        r[row + i] = (values[i] - model.measured()[i]) / model.scale();
    } else {
      model.differentiate(constants, r + row, slopes);
      for (std::size_t i = 0; i < samples; ++i) {
        double* out = J + (row + i) * places.count;
        const double* in = slopes.data() + i * n;
        std::fill(out, out + places.count, 0.0);
        out[k] = in[0];
        if (places.exponent) out[*places.exponent] = in[1];
        if (places.second_power) out[*places.second_power] = in[2];
        for (std::size_t t = 0; t < places.terms; ++t) {
          out[places.fraction + t] = in[3 + t];
          if (places.time) out[*places.time + t] = in[3 + places.terms + t];
        }
      }
    }
    row += samples;
  }
  return std::all_of(r, r + row, [](double v) { return std::isfinite(v); });
}

LeastSquares RelaxationProblem::squares(std::size_t terms) const {
  const ConstantPlaces p = places(terms);
  LeastSquares problem;
  for (std::size_t k = 0; k < p.records; ++k)
    problem.constants.push_back({"force_" + std::to_string(k + 1), "N", 1, 1e-12, 1e9});
  if (p.exponent)
    problem.constants.push_back(
        {"exponent", "1", settings_.exponent, kLeastExponent, kMostExponent});
  if (p.second_power) problem.constants.push_back({"second_power", "1", 0.1, 0, 1, true});
  for (std::size_t i = 0; i < terms; ++i)
    problem.constants.push_back({"fraction_" + std::to_string(i + 1), "1", 0.1, 0, 1});
  for (std::size_t i = 0; p.time && i < terms; ++i)
    problem.constants.push_back({"time_" + std::to_string(i + 1), "s", 0, std::log(shortest_time_),
                                 std::log(longest_time_), true, true});
  problem.series = series();
  for (const std::size_t length : problem.series) problem.residuals += length;
  problem.confidence = settings_.confidence;
  problem.max_iterations = 100;
  problem.tolerance = 1e-10;
  problem.model = [this, p](const double* c, double* r, double* J) { return evaluate(p, c, r, J); };
  problem.canonical = [p](std::vector<double>& c) {
    if (!p.time) return;
    std::vector<std::pair<double, double>> order;
    for (std::size_t i = 0; i < p.terms; ++i) order.emplace_back(c[*p.time + i], c[p.fraction + i]);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < p.terms; ++i) {
      c[*p.time + i] = order[i].first;
      c[p.fraction + i] = order[i].second;
    }
  };
  return problem;
}

std::vector<double> RelaxationProblem::full_start(const ConstantPlaces& p, std::size_t from,
                                                  const std::vector<double>& fraction,
                                                  const std::vector<double>& time,
                                                  double exponent) const {
  std::vector<double> start(p.count, 0.0);
  if (p.exponent) start[*p.exponent] = exponent;
  if (p.second_power) start[*p.second_power] = 0.1;
  for (std::size_t i = 0; i < p.terms; ++i) {
    start[p.fraction + i] = fraction[i];
    if (p.time) start[*p.time + i] = std::log(time[i]);
  }
  for (std::size_t k = 0; k < p.records; ++k) {
    start[k] = 1;
    // The force is linear in its constant: the best one by projection.
    BodyConstants<double> unit = body(p, start.data(), k);
    const std::vector<double> e = models_[k].elastic(unit.exponent);
    double above = 0, below = 0;
    std::vector<double> sum = e;
    for (std::size_t i = 0; i < p.terms; ++i) {
      const std::vector<double> m = models_[k].memory(unit.exponent, unit.time[i]);
      for (std::size_t j = 0; j < e.size(); ++j) sum[j] += unit.fraction[i] * (m[j] - e[j]);
    }
    for (std::size_t j = 0; j < e.size(); ++j) {
      above += sum[j] * models_[k].record().force[j];
      below += sum[j] * sum[j];
    }
    start[k] = above > 0 && below > 0 ? above / below : models_[from].scale();
  }
  return start;
}

std::vector<std::vector<double>> RelaxationProblem::starts(std::size_t terms) const {
  constexpr std::size_t kGrid = 12;
  const ConstantPlaces p = places(terms);
  std::vector<double> exponents{settings_.exponent};
  if (settings_.fit_exponent) exponents = {1, 1.25, 1.5, 1.75, 2, 2.5, 3};
  const std::vector<double> times =
      settings_.times.empty() ? logarithmic(shortest_time_, longest_time_, kGrid) : settings_.times;
  std::vector<std::vector<double>> starts;
  for (const SeriesStart& s :
       series_starts(models_[longest_record_], exponents, times, terms, kFewStarts))
    starts.push_back(full_start(p, longest_record_, s.fraction, s.time, s.exponent));
  if (!starts.empty()) return starts;
  const std::vector<double> spread =
      settings_.times.empty() ? logarithmic(shortest_time_, longest_time_, terms) : times;
  const std::vector<double> alike(terms,
                                  0.5 / static_cast<double>(std::max<std::size_t>(terms, 1)));
  return {full_start(p, longest_record_, alike, spread, settings_.exponent)};
}

}  // namespace palpate::calibrate
