// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/press.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "fitting/measurement/records/baseline.hpp"
#include "fitting/measurement/records/cycles.hpp"
#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::measured {
namespace {

/// Fewest samples from the contact on that make a curve.
constexpr std::size_t kFewestInContact = 4;

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

/// What the machine yields is a part of what it shows. More than nearly all of that means a wrong
/// unit, or nothing is known of the specimen.
void check_compliance(const PressRecord& record, const Cycle& cycle, double compliance) {
  constexpr double kLargestFraction = 0.9;
  const auto span = [&](const std::vector<double>& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(cycle.begin);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(cycle.peak) + 1;
    const auto [low, high] = std::minmax_element(begin, end);
    return *high - *low;
  };
  const double yields = compliance * span(record.force), travel = span(record.displacement);
  if (yields <= kLargestFraction * travel) return;
  refuse(record.name,
         "by its compliance the machine would yield " + length_text(yields) + " of " +
             length_text(travel) + " of travel",
         "check the units of force, displacement and machine.compliance");
}

/// Displacement less the yielding of the machine, force less the baseline.
std::vector<DepthForce> corrected(const PressRecord& record, const Baseline& baseline,
                                  std::size_t zero, std::size_t begin, std::size_t end,
                                  double compliance) {
  std::vector<DepthForce> out;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = record.time.empty() ? static_cast<double>(i) - static_cast<double>(zero)
                                         : record.time[i] - baseline.start;
    const double force = record.force[i] - baseline.offset - baseline.drift * t;
    out.push_back({record.displacement[i] - compliance * force, force, t});
  }
  return out;
}

/// From the contact point on, with the depth counted from there.
std::vector<DepthForce> beyond(std::vector<DepthForce> branch, double contact) {
  for (DepthForce& sample : branch) sample.depth -= contact;
  std::erase_if(branch, [](const DepthForce& sample) { return sample.depth < 0; });
  return branch;
}

/// Without the samples of pauses, but for the first of each: runs in which the depth stays within a
/// thousandth of the reach, or its noise, twenty times as long as the mean speed would take.
std::vector<DepthForce> without_pauses(const std::vector<DepthForce>& branch) {
  constexpr double kBand = 1e-3, kSlower = 20, kFewest = 10;
  std::vector<double> depths;
  for (const DepthForce& sample : branch) depths.push_back(sample.depth);
  const double reach = depths.empty() ? 0 : depths.back() - depths.front();
  if (!(reach > 0)) return branch;
  const double band = std::max(kBand * reach, 4 * noise_of(depths));
  const auto longest = static_cast<std::size_t>(
      std::max(kFewest, kSlower * static_cast<double>(depths.size()) * band / reach));
  std::vector<DepthForce> moving;
  for (std::size_t i = 0, next = 0; i < branch.size(); i = next) {
    next = i + 1;
    while (next < branch.size() && std::abs(depths[next] - depths[i]) <= band) ++next;
    moving.push_back(branch[i]);
    if (next - i < longest) next = i + 1;
  }
  return moving;
}

double work_of(const std::vector<DepthForce>& branch) {
  double work = 0;
  for (std::size_t i = 1; i < branch.size(); ++i) {
    work += 0.5 * (branch[i].force + branch[i - 1].force) * (branch[i].depth - branch[i - 1].depth);
  }
  return work;
}

ContactPoint contact_by_threshold(const std::vector<DepthForce>& loading, double threshold,
                                  const std::string& where) {
  if (std::ranges::none_of(loading, [&](const DepthForce& s) { return s.force >= threshold; }))
    refuse(where, "no force reaches the threshold of contact", "lower the threshold");
  for (std::size_t i = loading.size(); i-- > 1;) {
    if (loading[i - 1].force >= threshold) continue;
    const double step = loading[i].depth - loading[i - 1].depth;
    return {loading[i].depth, std::abs(step) / std::sqrt(12.0)};
  }
  refuse(where, "the press begins above the threshold of contact", "raise the threshold");
}

/// The cycle with this number, from 1 or from the end.
const Cycle& chosen(const std::vector<Cycle>& cycles, int number, const std::string& where) {
  const int count = static_cast<int>(cycles.size());
  const int wanted = number > 0 ? number - 1 : count + number;
  if (number == 0 || wanted < 0 || wanted >= count) {
    refuse(
        where,
        "there is no cycle " + std::to_string(number) + ", the record has " + std::to_string(count),
        "count from 1, or from the end with -1");
  }
  return cycles[static_cast<std::size_t>(wanted)];
}

std::vector<double> first(const std::vector<double>& values, std::size_t count) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// Mean speed of loading, from the contact on.
double rate_of(const std::vector<DepthForce>& loading, double compliance) {
  const DepthForce &a = loading.front(), &b = loading.back();
  const double travel = b.depth - a.depth + compliance * (b.force - a.force);
  return b.time > a.time ? travel / (b.time - a.time) : kUnknown;
}

/// How many samples come before the tool has moved by a part of its whole travel: the force of rest
/// is theirs. Not a part of the samples: a hold may have nearly all of them.
std::size_t count_at_rest(const std::vector<double>& displacement) {
  constexpr double kStill = 0.02;
  const double start = median(first(displacement, std::min<std::size_t>(5, displacement.size())));
  double travel = 0;
  for (const double x : displacement) travel = std::max(travel, std::abs(x - start));
  const auto moved = std::find_if(displacement.begin(), displacement.end(),
                                  [&](double x) { return std::abs(x - start) > kStill * travel; });
  return std::max<std::size_t>(1, static_cast<std::size_t>(moved - displacement.begin()));
}

/// Readings at their limit, of the force or of a channel that has a good part of it; the first
/// where several are.
std::optional<Saturation> saturation_in(const PressRecord& record, const Cycle& cycle) {
  if (record.channels.empty()) return saturation_of(record.force, record.displacement, cycle);
  constexpr double kGoodPart = 0.5;
  const auto rise = [&](const std::vector<double>& values) {
    double largest = 0;
    for (std::size_t i = cycle.begin; i < cycle.loading_end; ++i)
      largest = std::max(largest, std::abs(values[i] - values[cycle.begin]));
    return largest;
  };
  std::optional<Saturation> first;
  for (const std::vector<double>& channel : record.channels) {
    if (rise(channel) < kGoodPart * rise(record.force)) continue;
    const std::optional<Saturation> found = saturation_of(channel, record.displacement, cycle);
    if (found && (!first || found->first < first->first)) first = found;
  }
  return first;
}

void end_before(const Saturation& saturation, Cycle& cycle, const std::string& where) {
  if (saturation.first < cycle.begin + kFewestInContact) {
    refuse(where,
           "the load cell is at its limit of " + force_text(std::abs(saturation.reading)) +
               " from the beginning",
           "measure within the range of the load cell");
  }
  cycle.loading_end = saturation.first;
}

/// One press whose branches are known.
PressCurve analyse_cycle(const PressRecord& record, const Cycle& cycle,
                         const PressSettings& settings) {
  check_compliance(record, cycle, settings.compliance);
  const BaselineAndContact found = baseline_and_contact(record, cycle, settings);
  PressCurve curve;
  curve.baseline = found.baseline;
  curve.contact = found.contact;
  curve.common = found.common;
  const std::vector<DepthForce> loading = corrected(
      record, curve.baseline, cycle.begin, cycle.begin, cycle.loading_end, settings.compliance);
  const std::vector<DepthForce> unloading = corrected(
      record, curve.baseline, cycle.begin, cycle.unloading_begin, cycle.end, settings.compliance);
  if (settings.method == ContactMethod::Threshold) {
    curve.contact = contact_by_threshold(loading, settings.threshold, record.name);
    curve.common.replace_contact(curve.contact);
  }
  curve.loading = without_pauses(beyond(loading, curve.contact.displacement));
  curve.unloading = beyond(unloading, curve.contact.displacement);
  if (settings.method == ContactMethod::Given && curve.loading.empty())
    refuse(record.name, "the contact point that is given is beyond the whole press",
           "correct the point, and its unit");
  if (curve.loading.size() < kFewestInContact) {
    refuse(record.name, "fewer than " + std::to_string(kFewestInContact) + " samples in contact",
           "record more densely, or press deeper");
  }
  curve.work_loading = work_of(curve.loading);
  curve.work_returned = -work_of(curve.unloading);
  if (!record.time.empty()) curve.rate = rate_of(curve.loading, settings.compliance);
  return curve;
}

}  // namespace

Signs orient(PressRecord& record) {
  Signs signs;
  if (record.force.empty() || record.displacement.size() != record.force.size()) return signs;
  const std::size_t head = count_at_rest(record.displacement);
  const double rest = median(first(record.force, head));
  std::size_t peak = 0;
  for (std::size_t i = 0; i < record.force.size(); ++i) {
    if (std::abs(record.force[i] - rest) > std::abs(record.force[peak] - rest)) peak = i;
  }
  const auto flip = [](std::vector<double>& values, double& sign) {
    for (double& value : values) value = -value;
    sign = -1;
  };
  const double start = median(first(record.displacement, head));
  if (record.force[peak] < rest) flip(record.force, signs.force);
  if (record.displacement[peak] < start) flip(record.displacement, signs.displacement);
  return signs;
}

PressCurve analyse_press(const PressRecord& record, const PressSettings& settings) {
  check_record(record);
  const std::vector<Cycle> cycles = cycles_of(record.displacement);
  if (cycles.empty()) {
    refuse(record.name, "the displacement shows no press", "check which column it is");
  }
  Cycle cycle = chosen(cycles, settings.cycle, record.name);
  std::optional<Saturation> saturation = saturation_in(record, cycle);
  if (saturation && !record.time.empty()) {
    saturation->from = record.time[saturation->first];
    saturation->to = record.time[saturation->last];
  }
  if (saturation) end_before(*saturation, cycle, record.name);
  PressCurve curve;
  try {
    curve = analyse_cycle(record, cycle, settings);
  } catch (const Error& error) {
    if (!saturation) throw;
    throw Error(error.kind(), error.where(),
                error.problem() + "; the press is used up to sample " +
                    std::to_string(saturation->first) + ", where the load cell reaches its limit",
                error.remedy());
  }
  curve.cycles = static_cast<int>(cycles.size());
  curve.cycle = settings.cycle > 0 ? settings.cycle : curve.cycles + settings.cycle + 1;
  curve.saturation = saturation;
  if (saturation) curve.work_returned = kUnknown;
  return curve;
}

}  // namespace palpate::measured
