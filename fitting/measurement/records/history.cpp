// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/history.hpp"

#include <algorithm>
#include <cmath>

#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::measured {
namespace {

void check_values(const PressRecord& record) {
  if (record.time.empty()) {
    refuse(record.name, "it has no time",
           "name the column of the time, or import it as a [[press]], which needs none");
  }
  if (record.displacement.size() != record.time.size() ||
      record.force.size() != record.time.size()) {
    refuse(record.name, "its columns have different lengths", "give one value per row");
  }
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    for (const double value : {record.time[i], record.displacement[i], record.force[i]}) {
      if (std::isfinite(value)) continue;
      refuse(record.name, "sample " + std::to_string(i + 1) + " is not a finite number",
             "remove the row, or split the record there");
    }
    if (i == 0 || record.time[i] > record.time[i - 1]) continue;
    refuse(record.name,
           "the time does not increase at sample " + std::to_string(i + 1) + " (" +
               number_text(record.time[i - 1]) + " s, then " + number_text(record.time[i]) + " s)",
           "give one run per file, with enough digits of the time");
  }
}

std::size_t sample_at(const std::vector<double>& time, double t) {
  return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t) - time.begin());
}

std::vector<Phase> declared_phases(const History& history,
                                   const std::vector<DeclaredPhase>& declared) {
  std::vector<Phase> phases;
  for (const DeclaredPhase& d : declared) {
    const std::string span = std::string(phase_name(d.kind)) + " from " + number_text(d.from) +
                             " s to " + number_text(d.to) + " s";
    const Phase phase{d.kind, sample_at(history.time, d.from), sample_at(history.time, d.to)};
    if (!(d.from < d.to) || phase.begin >= phase.end) {
      refuse(history.name, "the declared " + span + " holds no sample",
             "the record goes from " + number_text(history.time.front()) + " s to " +
                 number_text(history.time.back()) + " s");
    }
    if (!phases.empty() && phase.begin < phases.back().end) {
      refuse(history.name, "the declared " + span + " overlaps the phase before it",
             "give phases in order of time");
    }
    phases.push_back(phase);
  }
  return phases;
}

double duration(const History& history, const Phase& phase) {
  return history.time[phase.end - 1] - history.time[phase.begin];
}

int cycles_in(const History& history) {
  int cycles = 0;
  bool loaded = false;
  for (const Phase& phase : history.phases) {
    if (phase.kind == PhaseKind::Ramp) loaded = true;
    if (phase.kind != PhaseKind::Release || !loaded) continue;
    ++cycles;
    loaded = false;
  }
  return cycles;
}

/// A drift that serves until the deepest point may be unknown by the end of a long hold, where it
/// would pass for relaxation: it has to be known there to the noise of one sample, or to 1 % of the
/// largest force.
bool drift_is_determined(const PressRecord& record, const Baseline& b) {
  constexpr double kPart = 0.01;
  if (b.state != DriftState::Fitted) return b.drift == 0;
  double largest = 0;
  for (const double force : record.force) largest = std::max(largest, force - b.offset);
  const double at_end = b.drift_uncertainty * (record.time.back() - record.time.front());
  return at_end <= std::max(b.noise, kPart * largest);
}

}  // namespace

History analyse_history(const PressRecord& record, const HistorySettings& settings) {
  check_values(record);
  PressSettings press = settings.press;
  press.cycle = 1;
  PressCurve curve = analyse_press(record, press);
  if (!drift_is_determined(record, curve.baseline)) {
    PressRecord timeless = record;  // of which no drift is taken
    timeless.time.clear();
    curve = analyse_press(timeless, press);
  }
  History history;
  history.name = record.name;
  history.time = record.time;
  history.baseline = curve.baseline;
  history.contact = curve.contact;
  history.saturation = curve.saturation;
  const Baseline& b = curve.baseline;
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    const double force = record.force[i] - b.offset - b.drift * (record.time[i] - b.start);
    history.force.push_back(force);
    history.travel.push_back(record.displacement[i] - press.compliance * force -
                             curve.contact.displacement);
  }
  const PhaseSignals signals{history.time, record.displacement, history.travel, history.force};
  history.control = settings.control.value_or(control_of(signals));
  history.phases = settings.declared.empty() ? phases_of(signals, history.control)
                                             : declared_phases(history, settings.declared);
  return history;
}

void require_time_dependence(const History& history) {
  constexpr std::size_t kFewest = 20;
  double ramp = 0, longest = 0;
  std::size_t samples = 0;
  for (const Phase& phase : history.phases) {
    if (phase.kind == PhaseKind::Ramp && ramp == 0) ramp = duration(history, phase);
    if (phase.kind != PhaseKind::Hold || duration(history, phase) < longest) continue;
    longest = duration(history, phase);
    samples = phase.end - phase.begin;
  }
  if (cycles_in(history) >= 2) return;
  const std::string remedy =
      "record a hold, or two cycles or more; where a hold is not recognised, declare it as a phase";
  if (longest == 0)
    refuse(history.name, "it has no hold in contact and fewer than two cycles", remedy);
  if (samples < kFewest) {
    refuse(history.name,
           "its hold has " + std::to_string(samples) + " samples, fewer than " +
               std::to_string(kFewest),
           "record more densely, or hold longer");
  }
  if (longest >= ramp) return;
  refuse(history.name,
         "its hold of " + number_text(longest) + " s is shorter than the ramp of " +
             number_text(ramp) + " s before it: what relaxes in the hold has relaxed in the ramp",
         "hold longer, or press faster");
}

}  // namespace palpate::measured
