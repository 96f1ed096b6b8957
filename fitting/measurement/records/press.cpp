// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/press.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

/// A turn of the displacement counts when it comes back by this fraction of the whole range.
constexpr double kTurn = 0.3;
/// Force over the noise that is taken for contact, and how many samples in a row must show it.
constexpr double kOnset = 5;
constexpr std::size_t kOnsetRun = 5;
/// Fewest samples out of contact that determine baseline and noise.
constexpr std::size_t kFewestFree = 8;
constexpr std::size_t kFewestInContact = 8;

/// One press: samples begin .. peak go in, peak .. end come back.
struct Cycle {
  std::size_t begin = 0, peak = 0, end = 0;
};

void check_record(const PressRecord& record) {
  const std::size_t size = record.displacement.size();
  if (record.force.size() != size || (!record.time.empty() && record.time.size() != size)) {
    refuse(record.name, "its columns have different lengths", "give one value per row");
  }
  for (std::size_t i = 1; i < record.time.size(); ++i) {
    if (record.time[i] >= record.time[i - 1]) continue;
    refuse(record.name, "time goes backwards at sample " + std::to_string(i),
           "give one run per file");
  }
}

/// Standard deviation of the noise of a signal that is smooth otherwise, by second differences.
double noise_of(const std::vector<double>& x) {
  std::vector<double> second;
  for (std::size_t i = 2; i < x.size(); ++i) {
    second.push_back(std::abs(x[i] - 2 * x[i - 1] + x[i - 2]));
  }
  if (second.empty()) return 0;
  constexpr double median_to_deviation = 1.4826;  // of a normal distribution
  return median_to_deviation * median(second) / std::sqrt(6.0);
}

/// Deep points and, between them, shallow ones, by a zigzag that ignores turns below a fraction of
/// the range.
std::vector<Cycle> cycles_of(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double turn = kTurn * (*high - *low);
  std::vector<Cycle> cycles;
  std::size_t lowest = 0, highest = 0;
  bool rising = false;
  Cycle cycle;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!rising) {
      if (x[i] <= x[lowest]) lowest = i;
      if (x[i] - x[lowest] <= turn) continue;
      if (!cycles.empty()) cycles.back().end = lowest + 1;
      cycle = {lowest, i, x.size()};
      highest = i;
      rising = true;
      continue;
    }
    if (x[i] > x[highest]) highest = i;
    if (x[highest] - x[i] <= turn) continue;
    cycle.peak = highest;
    cycles.push_back(cycle);
    rising = false;
    lowest = i;
  }
  if (rising) {
    cycle.peak = highest;
    cycles.push_back(cycle);
  }
  return cycles;
}

/// The samples of a hold at the deepest point belong to neither branch.
void leave_out_hold(const std::vector<double>& x, const Cycle& cycle, std::size_t& loading_end,
                    std::size_t& unloading_begin) {
  const double still = x[cycle.peak] - 4 * noise_of(x) - 1e-12;
  loading_end = cycle.peak + 1;
  while (loading_end > cycle.begin + 1 && x[loading_end - 2] >= still) --loading_end;
  unloading_begin = cycle.peak;
  while (unloading_begin + 1 < cycle.end && x[unloading_begin + 1] >= still) ++unloading_begin;
}

std::vector<double> part(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  return {x.begin() + static_cast<std::ptrdiff_t>(begin),
          x.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// First sample of the branch from which on the force stays above the noise.
std::size_t onset_of(const PressRecord& record, const Cycle& cycle) {
  const std::vector<double> force = part(record.force, cycle.begin, cycle.peak + 1);
  const std::size_t head = std::max<std::size_t>(kFewestFree, force.size() / 20);
  if (force.size() < head + kFewestInContact) {
    refuse(record.name, "the press has only " + std::to_string(force.size()) + " samples",
           "record more densely");
  }
  const std::vector<double> first = part(force, 0, head);
  const double level = median(first);
  const double noise = std::max(noise_of(force), 1e-9 * std::abs(force.back() - level));
  for (std::size_t i = 0; i + kOnsetRun <= force.size(); ++i) {
    const auto above = [&](double f) { return f - level > kOnset * noise; };
    const auto at = force.begin() + static_cast<std::ptrdiff_t>(i);
    if (!std::all_of(at, at + kOnsetRun, above)) continue;
    if (i < kFewestFree) {
      refuse(record.name, "the press begins in contact",
             "let the record begin before the tool touches, at least " +
                 std::to_string(kFewestFree) + " samples");
    }
    return cycle.begin + i;
  }
  refuse(record.name, "the force never rises above its noise",
         "check which column is the force, or press deeper");
}

/// Straight line through the force of the free samples: before the onset, and after the release
/// where the tool is farther out than it was at the onset.
Baseline baseline_of(const PressRecord& record, const Cycle& cycle, std::size_t onset) {
  const double clear = record.displacement[onset] -
                       0.1 * (record.displacement[cycle.peak] - record.displacement[onset]);
  std::vector<double> t, f;
  const auto take = [&](std::size_t i) {
    t.push_back(record.time.empty() ? 0 : record.time[i] - record.time[cycle.begin]);
    f.push_back(record.force[i]);
  };
  // The force rises before it stands out of the noise: keep away from the onset.
  const std::size_t free_end = cycle.begin + (onset - cycle.begin) * 4 / 5;
  for (std::size_t i = cycle.begin; i < std::max(free_end, cycle.begin + kFewestFree / 2); ++i) {
    take(i);
  }
  for (std::size_t i = cycle.peak; i < cycle.end; ++i) {
    if (record.displacement[i] < clear) take(i);
  }
  Baseline baseline;
  if (record.time.empty() || t.back() <= t.front()) {
    baseline.offset = mean(f);
    baseline.noise = deviation(f);
    return baseline;
  }
  const LineFit line = fit_line(t, f);
  baseline.offset = line.offset;
  baseline.drift = line.slope;
  baseline.drift_uncertainty = line.slope_uncertainty;
  baseline.noise = line.residual;
  return baseline;
}

/// Displacement less the yielding of the machine, force less the baseline.
struct Corrected {
  std::vector<double> displacement, force;
};

Corrected corrected(const PressRecord& record, const Baseline& baseline, std::size_t zero,
                    std::size_t begin, std::size_t end, double compliance) {
  Corrected out;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = record.time.empty() ? 0 : record.time[i] - record.time[zero];
    out.force.push_back(record.force[i] - baseline.offset - baseline.drift * t);
    out.displacement.push_back(record.displacement[i] - compliance * out.force.back());
  }
  return out;
}

std::vector<DepthForce> beyond(const Corrected& branch, double contact) {
  std::vector<DepthForce> out;
  for (std::size_t i = 0; i < branch.force.size(); ++i) {
    if (branch.displacement[i] >= contact) {
      out.push_back({branch.displacement[i] - contact, branch.force[i]});
    }
  }
  return out;
}

double work_of(const std::vector<DepthForce>& branch) {
  double work = 0;
  for (std::size_t i = 1; i < branch.size(); ++i) {
    work += 0.5 * (branch[i].force + branch[i - 1].force) * (branch[i].depth - branch[i - 1].depth);
  }
  return work;
}

ContactPoint contact_by_threshold(const Corrected& loading, double threshold,
                                  const std::string& where) {
  for (std::size_t i = loading.force.size(); i-- > 1;) {
    if (loading.force[i - 1] >= threshold) continue;
    const double step = loading.displacement[i] - loading.displacement[i - 1];
    return {loading.displacement[i], std::abs(step) / std::sqrt(12.0)};
  }
  refuse(where, "the press begins above the threshold of contact", "raise the threshold");
}

}  // namespace

namespace {

/// The model of the onset at one contact point: linear in its three constants.
struct OnsetFit {
  double a0 = 0, a1 = 0, a2 = 0;
  double squares = std::numeric_limits<double>::infinity();
};

OnsetFit fit_onset(const std::vector<double>& x, const std::vector<double>& f, double c, double p) {
  // Scaled depths, so that the normal equations are well conditioned.
  const double scale = std::max(x.back() - c, 1e-12);
  Symmetric3 system;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double z = std::max(0.0, (x[i] - c) / scale), rise = std::pow(z, p);
    system.add({1, rise, z * rise}, f[i]);
  }
  std::array<double, 3> a{};
  OnsetFit fit;
  if (!system.solve(a) || a[1] < 0) return fit;
  fit.squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double z = std::max(0.0, (x[i] - c) / scale), rise = std::pow(z, p);
    const double r = f[i] - a[0] - a[1] * rise - a[2] * z * rise;
    fit.squares += r * r;
  }
  fit.a0 = a[0];
  fit.a1 = a[1] / std::pow(scale, p);
  fit.a2 = a[2] / std::pow(scale, p + 1);
  return fit;
}

/// Contact and standard uncertainty from the samples up to one fraction of the force.
ContactPoint fit_range(const std::vector<double>& x, const std::vector<double>& f, double p) {
  const auto squares = [&](double c) { return fit_onset(x, f, c, p).squares; };
  const double c = minimise_scan(squares, x.front(), x[x.size() - x.size() / 8 - 1], 240);
  const OnsetFit fit = fit_onset(x, f, c, p);
  // Covariance of (c, a0, a1, a2) from the linearised model.
  Symmetric4 information;
  std::vector<double> residual;
  const double scale = std::max(x.back() - c, 1e-12);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double z = std::max(0.0, x[i] - c), rise = std::pow(z, p);
    const double slope = z > 0 ? p * fit.a1 * rise / z + (p + 1) * fit.a2 * rise : 0;
    information.add({-slope * scale, 1, std::pow(z / scale, p), std::pow(z / scale, p + 1)});
    residual.push_back(f[i] - fit.a0 - fit.a1 * rise - fit.a2 * z * rise);
  }
  const double freedom = std::max(1.0, static_cast<double>(x.size()) - 4);
  const double variance = fit.squares / freedom * correlation_factor(residual);
  return {c, scale * std::sqrt(std::max(0.0, variance * information.inverse_first()))};
}

}  // namespace

ContactPoint fit_contact(const std::vector<double>& displacement, const std::vector<double>& force,
                         double exponent, const std::string& where) {
  constexpr std::array<double, 3> kShares{0.12, 0.2, 0.33};
  const double largest = *std::max_element(force.begin(), force.end());
  std::array<ContactPoint, 3> points;
  for (std::size_t k = 0; k < kShares.size(); ++k) {
    std::size_t count = 0;
    while (count < force.size() && force[count] < kShares[k] * largest) ++count;
    if (count < 2 * kFewestFree) {
      refuse(where,
             "only " + std::to_string(count) + " samples up to " +
                 std::to_string(static_cast<int>(100 * kShares[k])) +
                 " % of the force: too few to find the contact point",
             "record more densely, or longer before the touch");
    }
    points[k] = fit_range(part(displacement, 0, count), part(force, 0, count), exponent);
  }
  const auto [low, high] =
      std::minmax({points[0].displacement, points[1].displacement, points[2].displacement});
  // The spread of three estimates, as a rectangular distribution of that width.
  const double choice = (high - low) / std::sqrt(12.0);
  return {points[1].displacement, std::hypot(points[1].uncertainty, choice)};
}

void orient(PressRecord& record) {
  if (record.force.empty()) return;
  const std::size_t head = std::max<std::size_t>(1, record.force.size() / 20);
  const double rest = median(part(record.force, 0, head));
  std::size_t peak = 0;
  for (std::size_t i = 0; i < record.force.size(); ++i) {
    if (std::abs(record.force[i] - rest) > std::abs(record.force[peak] - rest)) peak = i;
  }
  const auto flip = [](std::vector<double>& values) {
    for (double& value : values) value = -value;
  };
  const double start = median(part(record.displacement, 0, head));
  if (record.force[peak] < rest) flip(record.force);
  if (record.displacement[peak] < start) flip(record.displacement);
}

namespace {

/// What the machine yields is a part of what it shows. More than nearly all of that means a wrong
/// unit, or nothing is known of the specimen.
void check_compliance(const PressRecord& record, const Cycle& cycle, double compliance) {
  constexpr double kLargestShare = 0.9;
  const auto span = [&](const std::vector<double>& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(cycle.begin);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(cycle.peak) + 1;
    const auto [low, high] = std::minmax_element(begin, end);
    return *high - *low;
  };
  const double yields = compliance * span(record.force), travel = span(record.displacement);
  if (yields <= kLargestShare * travel) return;
  refuse(record.name,
         "by its compliance the machine would yield " + std::to_string(1e3 * yields) + " mm of " +
             std::to_string(1e3 * travel) + " mm of travel",
         "check the units of force, displacement and machine.compliance");
}

}  // namespace

PressCurve analyse_press(const PressRecord& record, const PressSettings& settings) {
  check_record(record);
  const std::vector<Cycle> cycles = cycles_of(record.displacement);
  if (cycles.empty()) {
    refuse(record.name, "the displacement shows no press", "check which column it is");
  }
  const int count = static_cast<int>(cycles.size());
  const int wanted = settings.cycle > 0 ? settings.cycle - 1 : count + settings.cycle;
  if (settings.cycle == 0 || wanted < 0 || wanted >= count) {
    refuse(record.name,
           "there is no cycle " + std::to_string(settings.cycle) + ", the record has " +
               std::to_string(count),
           "count from 1, or from the end with -1");
  }
  const Cycle& cycle = cycles[static_cast<std::size_t>(wanted)];
  check_compliance(record, cycle, settings.compliance);
  const std::size_t onset = onset_of(record, cycle);
  PressCurve curve;
  curve.cycles = count;
  curve.baseline = baseline_of(record, cycle, onset);
  std::size_t loading_end = 0, unloading_begin = 0;
  leave_out_hold(record.displacement, cycle, loading_end, unloading_begin);
  const Corrected loading =
      corrected(record, curve.baseline, cycle.begin, cycle.begin, loading_end, settings.compliance);
  const Corrected unloading = corrected(record, curve.baseline, cycle.begin, unloading_begin,
                                        cycle.end, settings.compliance);
  curve.contact =
      settings.method == ContactMethod::Fit
          ? fit_contact(loading.displacement, loading.force, settings.exponent, record.name)
          : contact_by_threshold(loading, settings.threshold, record.name);
  curve.loading = beyond(loading, curve.contact.displacement);
  curve.unloading = beyond(unloading, curve.contact.displacement);
  if (curve.loading.size() < kFewestInContact) {
    refuse(record.name, "fewer than " + std::to_string(kFewestInContact) + " samples in contact",
           "record more densely, or press deeper");
  }
  curve.work_loading = work_of(curve.loading);
  curve.work_returned = -work_of(curve.unloading);
  if (!record.time.empty()) {
    const double seconds = record.time[loading_end - 1] - record.time[onset];
    const double travel = record.displacement[loading_end - 1] - record.displacement[onset];
    if (seconds > 0) curve.rate = travel / seconds;
  }
  return curve;
}

}  // namespace palpate::measured
