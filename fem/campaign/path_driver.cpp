// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/path_driver.hpp"

#include <algorithm>
#include <cstdio>

#include "fem/contact/increment_work.hpp"
#include "fem/mesh/point_text.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/profile.hpp"
#include "format/number_text.hpp"

namespace palpate::fem {

namespace {

constexpr int kMaxHalvings = 5;
constexpr int kHalvingsBeforeDirect = 2;
constexpr double kLargestStep = 0.25;  ///< of one increment, over the tool radius
/// Over the tool radius. The penetration into a free surface stays far below.
constexpr double kLargestPenetration = 0.01;
/// An element whose volume ratio is below this is about to invert.
constexpr double kNearInversion = 0.25;

/// What the last equilibrium before a failure says about its cause; empty when nothing.
std::string about_inversion(const SolidModel& model, const Displacement& u) {
  const auto [J, X] = model.most_compressed(u);
  if (J > kNearInversion) return {};
  char text[96];
  std::snprintf(text, sizeof text, " (an element at %s is about to invert: det F = %.2f)",
                point_text(X).c_str(), J);
  return text;
}

}  // namespace

bool PathDriver::advance(double from, double to, Predictor& states, Displacement& u,
                         CurveSample& sample, std::string& reason) {
  const PartTimer timer(Part::Vectors);
  work_ = problem_.follows_work ? std::optional(0.0) : std::nullopt;
  // A tool that moves by a large part of its size at once could pass the surface unnoticed.
  double at = from, step = std::min(to - from, kLargestStep * problem_.tool_radius);
  int halvings = 0;
  CurveSample here;
  here.iterations = 0;
  std::string failure;  // of the last attempt: dropped when a smaller step succeeds
  while (at < to) {
    const double next = to - at <= 1.001 * step ? to : at + step;
    Displacement trial = states.predict(problem_.model, next);
    const Outcome outcome = equilibrate(next, halvings, trial, here, failure);
    if (outcome == Outcome::Found) {
      add_work(at, states.last(), trial);
      u = trial;
      states.add(next, u);
      at = next;
      sample = here;
      continue;
    }
    if (++halvings > kMaxHalvings) {
      reason = "at " + length_text(next) + ": " + failure;
      if (outcome == Outcome::NotFound) reason += about_inversion(problem_.model, states.last());
      reached_ = at;
      problem_.contact.move_to(problem_.tool_at(at));
      return false;
    }
    // What lies beyond the onset of a fault is no state to go on from.
    if (outcome == Outcome::Meaningless)
      problem_.equilibrium.start_path(problem_.tool_at(at), states.last());
    step *= 0.5;
  }
  reached_ = to;
  return true;
}

bool PathDriver::settle(double s, Predictor& states, Displacement& u, CurveSample& sample,
                        std::string& reason) {
  Displacement trial = u;
  CurveSample here;
  here.iterations = sample.iterations;
  if (equilibrate(s, 0, trial, here, reason) != Outcome::Found) {
    reason = "at " + length_text(s) + ": " + reason;
    return false;
  }
  u = trial;
  sample = here;
  states.replace_last(u);
  return true;
}

void PathDriver::add_work(double from, const Displacement& before, const Displacement& after) {
  if (!work_) return;
  const PartTimer timer(Part::Contact);
  const auto more =
      work_between(problem_.contact, problem_.model, problem_.tool_at(from).tip, before, after);
  work_ = more ? std::optional(*work_ + *more) : std::nullopt;
}

PathDriver::Outcome PathDriver::equilibrate(double s, int halvings, Displacement& u,
                                            CurveSample& sample, std::string& reason) {
  problem_.contact.move_to(problem_.tool_at(s));
  const NewtonResult result =
      problem_.equilibrium.solve(problem_.contact, halvings >= kHalvingsBeforeDirect, u);
  sample.iterations += result.iterations;
  reason = result.reason;
  if (!result.converged) return Outcome::NotFound;
  record(s, u, result.solid, sample);
  const std::string fault = fault_of(sample, u);
  if (fault.empty()) return Outcome::Found;
  reason = fault;
  return Outcome::Meaningless;
}

std::string PathDriver::fault_of(const CurveSample& sample, const Displacement& u) const {
  const PartTimer timer(Part::BodyPasses);
  if (const auto touch = problem_.contact.touch_of_support(u))
    return "the tool touches a support at " + point_text(*touch) +
           ", where the response is no longer that of soft tissue";
  if (sample.penetration > kLargestPenetration * problem_.tool_radius)
    return "the tool cuts into the surface, by " + length_text(sample.penetration) +
           ", at which what it meets is no longer soft: a support, or a region much stiffer than "
           "the surface, lies close beneath it";
  if (sample.displacement > kLargestStep * problem_.tool_radius && sample.contact_area == 0)
    return "the tool lost contact";
  if (const int entering = problem_.self_contact.entering_node(u); entering >= 0)
    return "the surface meets itself at " + point_text(problem_.model.mesh().X.col(entering)) +
           ", which is not modelled";
  if (const auto loss = problem_.model.ellipticity_loss(u)) return loss->reason();
  return {};
}

void PathDriver::record(double s, const Displacement& u,
                        const std::optional<SolidModel::State>& known, CurveSample& sample) const {
  const ToolContact& contact = problem_.contact;
  const PartTimer timer(Part::BodyPasses);
  const SolidModel::State state = known ? *known : problem_.model.energy(u);
  const PartTimer inner(Part::Contact);
  sample.displacement = s;
  sample.force = to_vec3(contact.tool_force(u));
  sample.strain_energy = state.energy - problem_.energy_at_rest;
  if (problem_.relaxes) sample.isochoric_energy = problem_.model.isochoric_energies(u);
  sample.volume_change = state.volume - problem_.volume_at_rest;
  sample.min_jacobian = state.min_J;
  sample.penetration = contact.penetration(u);
  sample.contact_area = contact.contact_area(u);
  sample.facets_in_contact = contact.facets_in_contact(u);
  sample.contact_energy = contact.energy(u);
  sample.tension = contact.tension(u);
}

}  // namespace palpate::fem
