// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/relaxation/relaxing_press.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fem/campaign/campaign_context.hpp"
#include "fem/campaign/first_touch.hpp"
#include "fem/campaign/region_laws.hpp"
#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/relaxation/branch_stresses.hpp"
#include "fem/solve/newton.hpp"
#include "format/error.hpp"

namespace palpate::fem {

namespace {

/// Residual that counts as none, over the allowed one at the largest force so far: a tool that has
/// let go has no force to compare with.
constexpr double kRoundOff = 0.1;
/// A time step that fails is halved down to this part of its piece of the motion.
constexpr double kSmallestPart = 1e-7;
/// Part of the shortest time of relaxation with which the motion begins.
constexpr double kFirstStep = 0.02;
/// Tolerance of the time steps over that of their equilibria, at least: their error is a difference
/// of two of them.
constexpr double kLeastTolerance = 2;
constexpr double kSafety = 0.9, kMostGrowth = 2, kMostShrinking = 0.2;

void check_motion(const std::vector<ToolMotion>& motion) {
  const auto refuse_motion = [](const std::string& problem) {
    refuse("motion of the tool", problem, "give times from 0 s on and finite travels from touch");
  };
  if (motion.size() < 2) refuse_motion("it has fewer than two points");
  if (motion.front().time_s != 0 || motion.front().travel > 0 || motion.front().drag != 0)
    refuse_motion("it does not start at 0 s without contact");
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (!std::isfinite(motion[i].time_s) || !std::isfinite(motion[i].travel) ||
        !std::isfinite(motion[i].drag))
      refuse_motion("point " + std::to_string(i) + " is not finite");
    if (i > 0 && motion[i].time_s < motion[i - 1].time_s)
      refuse_motion("point " + std::to_string(i) + " goes back in time");
  }
}

/// Follows a motion in time steps.
class Press {
 public:
  Press(const CampaignContext& context, const CampaignSettings& settings, RegionRelaxation series,
        std::int32_t vertex, const RelaxingSettings& relaxing)
      : context_(context),
        relaxing_(relaxing),
        point_(context.press_point(vertex)),
        model_(SolidModel::relaxing(context.model, &step_)),
        solver_(model_, &context.permutation),
        no_slip_(settings.indentation.friction == ToolFriction::NoSlip),
        aside_(tangent_frame(to_eigen(point_.inward))[0]),
        max_travel_(settings.indentation.depth / settings.indentation.increments),
        max_drag_(settings.indentation.lateral_travel / settings.indentation.lateral_increments),
        force_tolerance_(settings.indentation.force_tolerance),
        first_step_(series.empty() ? 0 : kFirstStep * series.times_s.front()),
        here_{
            context.rest,
            contact_at(context, context.model.mesh(), context.reference_position(point_.position)),
            {std::move(series), context.model.mesh().region},
            {}} {
    touching_ = tool_at_first_touch(context, here_.contact, here_.u, point_,
                                    context.rest_position(point_.position));
    here_.contact.move_to(touching_);
    if (no_slip_) here_.contact.bond(here_.u, kTouching * touching_.geometry.radius);
  }

  RelaxingPress follow(const std::vector<ToolMotion>& motion) {
    RelaxingPress press;
    here_.sample.travel = motion.front().travel;
    press.samples.push_back(here_.sample);
    for (const ToolMotion& to : motion) deepest_ = std::max(deepest_, to.travel);
    for (std::size_t i = 1; i < motion.size(); ++i) {
      press.reason = follow_piece(motion[i - 1], motion[i], press.samples);
      if (!press.reason.empty()) return press;
    }
    press.complete = true;
    return press;
  }

 private:
  /// The body and its tool at a time.
  struct State {
    Displacement u;
    ToolContact contact;
    BranchStresses branches;
    RelaxingSample sample;
  };

  /// Part of a piece of the motion with which it begins: the time step so far, at most one
  /// increment of travel.
  double first_part(double duration, double longest) const {
    const bool unlimited = !(duration > 0) || first_step_ == 0;
    return unlimited ? longest : std::min(longest, length_ / duration);
  }

  /// @return why the piece was not followed to its end; else empty.
  std::string follow_piece(const ToolMotion& from, const ToolMotion& to,
                           std::vector<RelaxingSample>& samples) {
    const double duration = to.time_s - from.time_s;
    const double increments = std::max(std::abs(to.travel - from.travel) / max_travel_,
                                       std::abs(to.drag - from.drag) / max_drag_);
    const double longest = increments > 1 ? 1 / increments : 1;
    if (!dragged_ && to.drag != from.drag) {
      dragged_ = true;
      here_.contact.bond(here_.u);
    }
    if (!(duration > 0)) length_ = first_step_;
    double done = 0, part = first_part(duration, longest);
    std::string reason = "its error stays above the tolerance";
    while (done < 1) {
      if (++steps_ > relaxing_.max_steps)
        return "the motion needs more than " + std::to_string(relaxing_.max_steps) + " steps";
      if (part < kSmallestPart)
        return "no time step after " + std::to_string(here_.sample.time_s) + " s: " + reason;
      const double next = done + part > 1 - 1e-9 ? 1 : done + part;
      std::optional<State> end = step_to(at(from, to, next), reason);
      if (!end) {
        part *= 0.5;
        continue;
      }
      const double peak = std::max(peak_, norm(end->sample.force));
      const double allowed = relaxing_.time_tolerance * std::max(peak, peak_ahead(end->sample));
      const double error = end->sample.time_error;
      const double change = error > 0 ? kSafety * std::cbrt(allowed / error) : kMostGrowth;
      if (error > allowed) {
        reason = "its error stays above the tolerance";
        part *= std::max(kMostShrinking, change);
        continue;
      }
      here_ = std::move(*end);
      peak_ = peak;
      samples.push_back(here_.sample);
      done = next;
      part = std::min(longest, part * std::clamp(change, kMostShrinking, kMostGrowth));
      if (duration > 0) length_ = part * duration;
    }
    return {};
  }

  /// N, what the force of a tool that sticks comes to at the largest travel if it grows in
  /// proportion to it, which is less than it does. A sticking contact that grows from a point is
  /// alike at every size: the part of the force by which two steps differ from one is the same in
  /// the smallest.
  double peak_ahead(const RelaxingSample& sample) const {
    return no_slip_ && sample.travel > 0 ? norm(sample.force) * deepest_ / sample.travel : 0;
  }

  static ToolMotion at(const ToolMotion& from, const ToolMotion& to, double part) {
    if (part == 1) return to;
    return {from.time_s + part * (to.time_s - from.time_s),
            from.travel + part * (to.travel - from.travel),
            from.drag + part * (to.drag - from.drag)};
  }

  /// The state after a step from here, in two halves, with its error. Nothing where one fails.
  std::optional<State> step_to(const ToolMotion& end, std::string& reason) {
    const bool takes_time = end.time_s > here_.sample.time_s;
    if (!takes_time) return solved(here_, end, here_.u, reason);
    const ToolMotion middle{0.5 * (here_.sample.time_s + end.time_s),
                            0.5 * (here_.sample.travel + end.travel),
                            0.5 * (here_.sample.drag + end.drag)};
    const std::optional<State> half = solved(here_, middle, here_.u, reason);
    if (!half) return std::nullopt;
    std::optional<State> fine = solved(*half, end, half->u, reason);
    if (!fine) return std::nullopt;
    const std::optional<State> coarse = solved(here_, end, fine->u, reason);
    if (!coarse) return std::nullopt;
    fine->sample.time_error = norm(fine->sample.force - coarse->sample.force) / 3;
    return fine;
  }

  std::optional<State> solved(const State& from, const ToolMotion& end, const Displacement& start,
                              std::string& reason) {
    const double h = end.time_s - from.sample.time_s;
    State state{start, from.contact, from.branches, {}};
    Tool tool = touching_;
    tool.tip += end.travel * to_eigen(point_.inward) + end.drag * aside_;
    state.contact.move_to(tool);
    step_ = from.branches.step(h);
    NewtonOptions options;
    options.tolerance = force_tolerance_;
    options.reuse_factor = true;
    options.round_off = std::max(context_.round_off, kRoundOff * force_tolerance_ * peak_);
    const auto settle = [&] {
      const NewtonResult result = solver_.solve(state.contact, options, state.u);
      reason = result.reason;
      return result.converged;
    };
    if (!settle()) return std::nullopt;
    if (no_slip_ && state.contact.bond_since({from.u, from.contact.tool().tip}, state.u) &&
        !settle())
      return std::nullopt;
    state.branches.advance(h, context_.model.isochoric_stress(state.u));
    state.sample = {end.time_s,
                    end.travel,
                    end.drag,
                    to_vec3(state.contact.tool_force(state.u)),
                    state.contact.contact_area(state.u),
                    state.contact.penetration(state.u),
                    0};
    return state;
  }

  const CampaignContext& context_;
  RelaxingSettings relaxing_;
  PressPoint point_;
  HistoryStress step_;  ///< of the step that is solved
  SolidModel model_;
  NewtonSolver solver_;
  bool no_slip_;
  Eigen::Vector3d aside_;  ///< direction of drags
  double max_travel_;      ///< m, of one step
  double max_drag_;        ///< m, of one step
  bool dragged_ = false;
  double force_tolerance_;       ///< relative
  double first_step_;            ///< s, after a step of the tool; 0: elastic
  double length_ = first_step_;  ///< s, of the next time step
  State here_;
  Tool touching_;
  double peak_ = 0;     ///< N, largest force so far
  double deepest_ = 0;  ///< m, largest travel of the motion
  int steps_ = 0;
};

void check_settings(const Body& body, const CampaignSettings& settings,
                    const RelaxingSettings& relaxing) {
  if (settings.gravity.acts())
    refuse(body.name, "relaxation of a body under its weight", "remove gravity");
  if (!(relaxing.time_tolerance > kLeastTolerance * settings.indentation.force_tolerance))
    refuse(body.name, "the tolerance of the time steps is not above that of their equilibria",
           "give a time tolerance of more than twice the force_tolerance");
  if (settings.indentation.refine_under_tool != 0)
    refuse(body.name, "elements cannot be refined under the tool of a body that relaxes",
           "remove solver.refine_under_tool and choose a smaller mesh.element_size");
}

}  // namespace

RelaxingPress press_relaxing(const Body& body, const CampaignSettings& settings,
                             std::int32_t vertex, const std::vector<ToolMotion>& motion,
                             const RelaxingSettings& relaxing) {
  check_indentation(settings.indentation);
  check_settings(body, settings, relaxing);
  check_motion(motion);
  const CampaignContext context(body, settings, Engine::Direct);
  Press press(context, settings, relaxation_of_regions(body, settings.materials), vertex, relaxing);
  return press.follow(motion);
}

}  // namespace palpate::fem
