// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr std::size_t kFewestFree = 4;       ///< samples out of contact
constexpr std::size_t kFewestForLine = 6;    ///< of them, for a drift
constexpr std::size_t kFewestInContact = 6;  ///< in the smallest range
/// Fractions of the largest force up to which the onset is fitted; the later ones where the record
/// is so coarse that the earlier ones hold too few samples.
constexpr std::array<std::array<double, 3>, 4> kRanges{
    {{0.12, 0.2, 0.33}, {0.2, 0.33, 0.5}, {0.33, 0.5, 0.75}, {0.5, 0.75, 1}}};
constexpr double kDeepEnough = 0.01;  ///< of the largest force: a baseline known so well

/// Up to which displacements samples count as out of contact, before the press, with those at it (a
/// specimen in grips waits where it is unloaded), and below which after the press.
struct Clear {
  double before = kNever, after = kNever;
};

class Press {
 public:
  Press(const PressRecord& record, const Cycle& cycle, const PressSettings& settings)
      : r_(record), c_(cycle), s_(settings) {
    start_ = has_time() ? r_.time[c_.begin] : 0;
    const std::size_t size = c_.loading_end - c_.begin;
    const std::size_t head =
        std::clamp<std::size_t>(size / 20, std::min<std::size_t>(8, size), size);
    level_ = zeroed() ? 0 : median(part(r_.force, c_.begin, c_.begin + head));
    correct({.offset = level_});
    check_rise();
  }

  BaselineAndContact run();

 private:
  bool has_time() const { return !r_.time.empty(); }
  bool zeroed() const { return s_.baseline == BaselineMethod::Zeroed; }
  /// Without a time the number of the sample stands for it.
  double time_at(std::size_t i) const {
    return has_time() ? r_.time[i] - start_
                      : static_cast<double>(i) - static_cast<double>(c_.begin);
  }
  double loading_duration() const { return time_at(c_.loading_end - 1); }

  static std::vector<double> part(const std::vector<double>& x, std::size_t begin,
                                  std::size_t end) {
    return {x.begin() + static_cast<std::ptrdiff_t>(begin),
            x.begin() + static_cast<std::ptrdiff_t>(end)};
  }

  /// Force and displacement of all samples for a baseline.
  void correct(const OnsetEstimate& baseline) {
    force_.assign(r_.force.size(), 0);
    x_ = r_.displacement;
    for (std::size_t i = c_.before; i < c_.end; ++i) {
      force_[i] = r_.force[i] - baseline.offset - baseline.drift * time_at(i);
      x_[i] -= s_.compliance * force_[i];
    }
    largest_ = *std::max_element(force_.begin() + static_cast<std::ptrdiff_t>(c_.begin),
                                 force_.begin() + static_cast<std::ptrdiff_t>(c_.loading_end));
  }

  void check_rise() const {
    constexpr double kOnset = 5;  // times the noise
    const std::vector<double> loading = part(force_, c_.begin, c_.loading_end);
    const std::size_t tail = std::max<std::size_t>(1, std::min<std::size_t>(5, loading.size() / 4));
    const double end = median(part(loading, loading.size() - tail, loading.size()));
    const double noise = noise_of(loading);
    if (end > kOnset * noise) return;
    if (end < -kOnset * noise)
      refuse(r_.name, "the force falls as the tool goes in",
             "check the signs of the columns of displacement and force");
    refuse(r_.name, "the force never rises above its noise",
           "check which column is the force, or press deeper");
  }

  /// Loading samples below a fraction of the largest force: their number does not hang on single
  /// samples that noise lifts above it.
  std::size_t count_up_to(double fraction) const {
    std::size_t count = 0;
    for (std::size_t i = c_.begin; i < c_.loading_end; ++i) {
      if (force_[i] <= fraction * largest_) ++count;
    }
    return count;
  }

  const std::array<double, 3>& ranges() const;
  OnsetSamples samples(std::size_t loading, const Clear& clear) const;
  OnsetSamples free_samples(const Clear& clear) const;
  Clear clear_of(const OnsetEstimate& found) const;

  struct FreeLine {
    std::size_t samples = 0;
    OnsetEstimate fit;
    double uncertainty = kUnknown, possible = kUnknown;  ///< N/s
    double from = 0;                                     ///< s, mean time of the baseline
    bool significant = false, straight = false;
  };
  FreeLine free_line(const OnsetEstimate& found) const;
  bool drift_decides(const OnsetEstimate& with) const;
  void decide_drift(const OnsetEstimate& contact);
  void check_approach(const OnsetEstimate& found) const;
  void fit_all();
  void baseline_only();

  const PressRecord& r_;
  const Cycle& c_;
  const PressSettings& s_;
  double start_ = 0, level_ = 0, largest_ = 0;
  std::vector<double> force_, x_;
  BaselineAndContact out_;
};

const std::array<double, 3>& Press::ranges() const {
  const double noise = noise_of(part(r_.force, c_.begin, c_.loading_end));
  std::size_t rise = c_.loading_end - c_.begin;
  while (rise > 0 && force_[c_.begin + rise - 1] > 3 * noise) --rise;
  for (const auto& fractions : kRanges) {
    const std::size_t count = count_up_to(fractions[0]);
    if (count >= 2 * kFewestInContact && count >= rise + kFewestInContact) return fractions;
  }
  refuse(r_.name,
         "the press has only " + std::to_string(c_.loading_end - c_.begin) + " samples, " +
             std::to_string(c_.loading_end - c_.begin - rise) +
             " of them in contact: too few to find the contact point",
         "record more densely, or give the contact point: contact.method = \"given\"");
}

/// Takes samples in order of time.
class Collector {
 public:
  void take(std::size_t i, double time, double displacement, double force, bool free) {
    samples_.time.push_back(time);
    samples_.displacement.push_back(displacement);
    samples_.force.push_back(force);
    samples_.free.push_back(free ? 1 : 0);
    if (samples_.stretches.empty() || next_ != i) samples_.stretches.push_back(0);
    ++samples_.stretches.back();
    next_ = i + 1;
  }
  OnsetSamples& samples() { return samples_; }

 private:
  OnsetSamples samples_;
  std::size_t next_ = 0;
};

/// The samples of the approach and onset, `loading` of them, and those out of contact before and
/// after the press; without a time only those that belong to the press itself.
OnsetSamples Press::samples(std::size_t loading, const Clear& clear) const {
  Collector out;
  for (std::size_t i = c_.before; i < c_.begin; ++i) {
    if (x_[i] <= clear.before && (has_time() || c_.before == 0))
      out.take(i, time_at(i), x_[i], r_.force[i], true);
  }
  for (std::size_t i = c_.begin; i < c_.begin + loading; ++i) {
    out.take(i, time_at(i), x_[i], r_.force[i], false);
  }
  for (std::size_t i = c_.peak; i < c_.end && has_time(); ++i) {
    if (x_[i] < clear.after) out.take(i, time_at(i), x_[i], r_.force[i], true);
  }
  return out.samples();
}

/// The samples out of contact before and after the press.
OnsetSamples Press::free_samples(const Clear& clear) const {
  Collector out;
  for (std::size_t i = c_.before; i < c_.loading_end; ++i) {
    if (x_[i] <= clear.before && (i >= c_.begin || has_time() || c_.before == 0))
      out.take(i, time_at(i), x_[i], r_.force[i], true);
  }
  for (std::size_t i = c_.peak; i < c_.end; ++i) {
    if (x_[i] < clear.after) out.take(i, time_at(i), x_[i], r_.force[i], true);
  }
  return out.samples();
}

/// Before the contact point: within its uncertainty the force does not stand out of the noise.
/// After the release a tenth of the depth farther, where the tool goes back so far: wet and sticky
/// specimens follow it.
Clear Press::clear_of(const OnsetEstimate& found) const {
  constexpr std::size_t kFewestReleased = 8;
  constexpr double kFollows = 0.1;
  Clear clear;
  clear.before = found.contact;
  const double far = clear.before - kFollows * (x_[c_.peak] - clear.before);
  const auto released = std::count_if(x_.begin() + static_cast<std::ptrdiff_t>(c_.peak),
                                      x_.begin() + static_cast<std::ptrdiff_t>(c_.end),
                                      [&](double x) { return x < far; });
  clear.after = static_cast<std::size_t>(released) >= kFewestReleased ? far : clear.before;
  return clear;
}

/// The line through the samples out of contact that are one uncertainty of the contact point away
/// from it, for the choice of that point goes after their noise; no samples where they are too few.
Press::FreeLine Press::free_line(const OnsetEstimate& found) const {
  Clear clear = clear_of(found);
  const double u = std::sqrt(std::max(0.0, found.covariance[2][2]));
  clear.before -= u;
  clear.after -= u;
  FreeLine line;
  const OnsetSamples free = free_samples(clear);
  if (zeroed() || free.size() < kFewestForLine || free.time.back() <= free.time.front())
    return line;
  line.samples = free.size();
  line.fit = fit_baseline(free, true);
  line.uncertainty = std::sqrt(line.fit.covariance[1][1]);
  const double freedom = static_cast<double>(free.size()) - 2;
  line.significant = std::abs(line.fit.drift) > student_quantile(0.99, freedom) * line.uncertainty;
  line.possible = std::abs(line.fit.drift) + student_quantile(0.95, freedom) * line.uncertainty;
  line.straight = is_straight(free);
  std::vector<double> used = free.time;
  // Without a time the samples after the release do not take part in the baseline.
  if (!has_time()) {
    const double end = time_at(c_.loading_end - 1);
    std::erase_if(used, [end](double at) { return at > end; });
  }
  line.from = mean(used);
  return line;
}

/// The contact point that is estimated without a drift comes far too early, or too late, where
/// there is a large one: the other serves where what lies before it shows a drift and is a straight
/// line, as no onset would be.
bool Press::drift_decides(const OnsetEstimate& with) const {
  const FreeLine line = free_line(with);
  return line.significant && line.straight;
}

void Press::decide_drift(const OnsetEstimate& contact) {
  Baseline& b = out_.baseline;
  b.state = DriftState::Unknown;
  b.possible_drift = kUnknown;
  out_.common.suspected_drift = 0;
  const OnsetSamples free = free_samples(clear_of(contact));
  if (zeroed() || free.size() < kFewestForLine || free.time.back() <= free.time.front()) return;
  if (has_time()) {
    const OnsetEstimate fit = fit_baseline(free, true);
    const auto& S = fit.covariance;
    const double t = time_at(c_.loading_end - 1);
    const double at_end = std::sqrt(std::max(0.0, S[0][0] + 2 * t * S[0][1] + t * t * S[1][1]));
    if (at_end <= std::max(fit.noise, kDeepEnough * largest_)) {
      b.state = DriftState::Fitted;
      return;
    }
    b.state = DriftState::Undetermined;
  }
  const FreeLine line = free_line(contact);
  if (has_time()) b.possible_drift = line.possible;
  if (!line.significant) return;
  b.state = DriftState::Suspected;
  out_.common.suspected_drift = line.fit.drift;
  out_.common.suspected_from = line.from;
}

void Press::check_approach(const OnsetEstimate& found) const {
  constexpr double kMostUncertain = 0.1, kMostBefore = 0.01;  // of the depth
  const double u = std::sqrt(found.covariance[2][2]), depth = x_[c_.peak] - x_[c_.begin];
  if (found.contact >= x_[c_.begin] - kMostBefore * depth && u <= kMostUncertain * depth) return;
  refuse(r_.name, "the press begins in contact",
         "let the record begin before the tool touches, or give the contact point: "
         "contact.method = \"given\"");
}

/// Baseline and contact point by the onset.
void Press::fit_all() {
  const std::array<double, 3>& fractions = ranges();
  const std::size_t middle = count_up_to(fractions[1]);
  OnsetModel model{s_.exponent, !zeroed(), false};
  const OnsetEstimate without = fit_onset(samples(middle, {}), model);
  OnsetEstimate with = without;
  if (!zeroed()) {
    with = fit_onset(samples(middle, clear_of(without)), {s_.exponent, true, true});
  }
  const OnsetEstimate& rough = drift_decides(with) ? with : without;
  const Clear clear = clear_of(rough);
  decide_drift(rough);
  model.drift = out_.baseline.state == DriftState::Fitted;
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    out_.common.estimates[k] = fit_onset(samples(count_up_to(fractions[k]), clear), model);
    if (zeroed()) {
      out_.common.estimates[k].covariance[0][0] = s_.zero_uncertainty * s_.zero_uncertainty;
    }
  }
  const OnsetEstimate& found = out_.common.estimates[1];
  check_approach(found);
  double variance = out_.common.variance_of({0, 0, 1});
  if (out_.baseline.state == DriftState::Suspected) {
    variance += (with.contact - found.contact) * (with.contact - found.contact);
  }
  out_.contact = {found.contact, std::sqrt(variance)};
}

/// Leaves out what comes after a time.
void keep_before(OnsetSamples& samples, double time) {
  while (!samples.time.empty() && samples.time.back() > time) {
    samples.time.pop_back();
    samples.displacement.pop_back();
    samples.force.pop_back();
    samples.free.pop_back();
    if (--samples.stretches.back() == 0) samples.stretches.pop_back();
  }
}

/// The baseline for a contact point that is given.
void Press::baseline_only() {
  if (zeroed()) {
    OnsetEstimate zero;
    zero.covariance[0][0] = s_.zero_uncertainty * s_.zero_uncertainty;
    zero.noise = noise_of(part(r_.force, c_.begin, c_.loading_end));
    out_.common.estimates.fill(zero);
    return;
  }
  OnsetEstimate contact;
  contact.contact = s_.contact;
  const Clear clear = clear_of(contact);
  OnsetSamples free = free_samples(clear);
  if (!has_time()) keep_before(free, time_at(c_.loading_end - 1));
  if (free.size() < kFewestFree) {
    refuse(r_.name,
           "it has " + std::to_string(free.size()) +
               " samples before the contact point that is given: too few for a baseline",
           "say baseline.method = \"zeroed\" if the force is zero there, or correct the point");
  }
  decide_drift(contact);
  out_.common.estimates.fill(fit_baseline(free, out_.baseline.state == DriftState::Fitted));
}

BaselineAndContact Press::run() {
  const bool given = s_.method == ContactMethod::Given;
  // What the machine yields hangs on the baseline.
  for (int round = s_.compliance > 0 ? 2 : 1; round > 0; --round) {
    if (given) {
      baseline_only();
    } else {
      fit_all();
    }
    correct(out_.common.estimates[1]);
  }
  if (given) {
    out_.contact = {s_.contact, s_.contact_uncertainty};
    out_.common.replace_contact(out_.contact);
  }
  const OnsetEstimate& found = out_.common.estimates[1];
  out_.common.compliance = s_.compliance;
  Baseline& b = out_.baseline;
  b.start = start_;
  b.offset = found.offset;
  b.drift = found.drift;
  b.noise = found.noise;
  b.autocorrelation = found.autocorrelation;
  if (b.state == DriftState::Fitted) b.drift_uncertainty = std::sqrt(found.covariance[1][1]);
  return out_;
}

}  // namespace

double CommonErrors::variance_of(const std::array<double, 3>& h) const {
  std::array<double, 3> values{}, variances{};
  for (std::size_t k = 0; k < 3; ++k) {
    const OnsetEstimate &e = estimates[k], &middle = estimates[1];
    values[k] = h[0] * (e.offset - middle.offset) + h[1] * (e.drift - middle.drift) +
                h[2] * (e.contact - middle.contact);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) variances[k] += h[i] * e.covariance[i][j] * h[j];
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double spread = (*high - *low) * (*high - *low);
  const double chance = std::max(0.0, variances[0] - variances[2]);
  return std::max(0.0, variances[1]) + std::max(0.0, spread - chance) / 12;
}

double CommonErrors::variance(double time, double slope) const {
  const double yields = 1 + compliance * slope;
  const double suspected = yields * suspected_drift * (time - suspected_from);
  return variance_of({-yields, -yields * time, slope}) + suspected * suspected;
}

void CommonErrors::replace_contact(const ContactPoint& contact) {
  for (OnsetEstimate& e : estimates) {
    e.contact = contact.displacement;
    for (std::size_t i = 0; i < 3; ++i) e.covariance[i][2] = e.covariance[2][i] = 0;
    e.covariance[2][2] = contact.uncertainty * contact.uncertainty;
  }
}

BaselineAndContact baseline_and_contact(const PressRecord& record, const Cycle& cycle,
                                        const PressSettings& settings) {
  return Press(record, cycle, settings).run();
}

}  // namespace palpate::measured
