// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/robot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

constexpr double kDragOverDepth = 0.1;  ///< sideways travel that makes a drag
constexpr double kHeldWithin = 0.1;     ///< change of depth that a drag may have
constexpr double kLargestTilt = std::numbers::pi / 6;

void check_log(const RobotLog& log) {
  if (log.tip.size() != log.force.size() ||
      (!log.time.empty() && log.time.size() != log.tip.size()) ||
      (!log.readings.empty() && log.readings.size() != log.tip.size())) {
    refuse(log.name, "its columns have different lengths", "give one value per row");
  }
  if (log.tip.size() < 20) refuse(log.name, "fewer than 20 samples", "record more densely");
}

Vec3 median_of(const std::vector<Vec3>& values, std::size_t count) {
  Vec3 out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> component;
    for (std::size_t i = 0; i < count; ++i) component.push_back(values[i][axis]);
    out[axis] = median(component);
  }
  return out;
}

/// First sample from which the force stays well above that of the first twentieth.
std::size_t touch_of(const RobotLog& log) {
  const std::size_t head = std::max<std::size_t>(8, log.force.size() / 20);
  const Vec3 rest = median_of(log.force, head);
  std::vector<double> idle;
  for (std::size_t i = 0; i < head; ++i) idle.push_back(norm(log.force[i] - rest));
  double largest = 0;
  for (const Vec3& f : log.force) largest = std::max(largest, norm(f - rest));
  const double limit = std::max(6 * median(idle), 0.005 * largest);
  for (std::size_t i = 0; i + 5 <= log.force.size(); ++i) {
    const auto above = [&](const Vec3& f) { return norm(f - rest) > limit; };
    const auto at = log.force.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::all_of(at, at + 5, above)) return i;
  }
  refuse(log.name, "the force never rises above its noise", "check the columns of the force");
}

/// The log in parts along and across the press direction of its site.
struct Parts {
  std::vector<double> along, force_along;
  std::vector<Vec3> across, force_across;
};

Parts parts_of(const RobotLog& log, const Vec3& inward) {
  Parts parts;
  for (std::size_t i = 0; i < log.tip.size(); ++i) {
    const double x = dot(log.tip[i], inward), f = dot(log.force[i], inward);
    parts.along.push_back(x);
    parts.force_along.push_back(f);
    parts.across.push_back(log.tip[i] - x * inward);
    parts.force_across.push_back(log.force[i] - f * inward);
  }
  return parts;
}

/// Samples begin .. end drag the tool at a constant depth.
struct DragSpan {
  std::size_t begin = 0, end = 0;
};

/// The drag, if there is one, from where the tip begins to leave the line of the press to where it
/// is farthest.
std::optional<DragSpan> drag_of(const Parts& parts, std::size_t touch, std::size_t first_deep) {
  const double depth = parts.along[first_deep] - parts.along[touch];
  const Vec3 line = parts.across[first_deep];
  std::size_t farthest = first_deep;
  for (std::size_t i = first_deep; i < parts.along.size(); ++i) {
    if (std::abs(parts.along[i] - parts.along[first_deep]) > kHeldWithin * depth) break;
    if (norm(parts.across[i] - line) > norm(parts.across[farthest] - line)) farthest = i;
  }
  const double travel = norm(parts.across[farthest] - line);
  if (travel < kDragOverDepth * depth) return std::nullopt;
  // Back from the farthest point to the last sample that still was on the line.
  std::size_t begin = farthest;
  for (; begin > first_deep; --begin) {
    if (norm(parts.across[begin] - line) < 0.01 * travel) break;
  }
  return DragSpan{begin, farthest + 1};
}

/// The force along inward is that of the press, offset and drift removed; across it, the offset.
DragCurve drag_curve(const RobotLog& log, const Parts& parts, const DragSpan& span,
                     const Vec3& inward, const Vec3& rest, const RobotSettings& settings,
                     const PressCurve& press) {
  const Vec3 start = parts.across[span.begin];
  const Vec3 way = parts.across[span.end - 1] - start;
  DragCurve drag;
  // Across inward to rounding, as the record asks.
  const Vec3 tangent = way - dot(way, inward) * inward;
  drag.direction = (1 / norm(tangent)) * tangent;
  drag.contact_uncertainty = press.contact.uncertainty;
  drag.work_before = press.work_loading;
  double depth = 0;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    const double travel = std::max(0.0, dot(parts.across[i] - start, drag.direction));
    if (!drag.travel.empty() && travel < drag.travel.back()) continue;
    drag.travel.push_back(travel);
    const double drift =
        press.baseline.drift * (log.time.empty() ? 0.0 : log.time[i] - press.baseline.start);
    drag.force.push_back(log.force[i] - rest - drift * inward);
    depth += parts.along[i] - press.contact.displacement -
             settings.press.compliance * dot(drag.force.back(), inward);
  }
  drag.lateral_depth = std::max(0.0, depth / static_cast<double>(drag.travel.size()));
  return drag;
}

/// The first samples of the log as a press.
PressRecord press_of(const RobotLog& log, const Parts& parts, std::size_t count) {
  const auto first = [count](const std::vector<double>& values) {
    return std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  };
  PressRecord press{log.name,
                    log.time.empty() ? std::vector<double>{} : first(log.time),
                    first(parts.along),
                    first(parts.force_along),
                    {}};
  for (std::size_t axis = 0; axis < 3 && !log.readings.empty(); ++axis) {
    std::vector<double>& channel = press.channels.emplace_back();
    for (std::size_t i = 0; i < count; ++i) channel.push_back(log.readings[i][axis]);
  }
  return press;
}

}  // namespace

RobotCurves analyse_robot_log(const RobotLog& log, const Body& body,
                              const RobotSettings& settings) {
  check_log(log);
  const std::size_t touch = touch_of(log);
  RobotCurves curves;
  // The tip of a sphere depends on the direction of the press, which is that of the site: the site
  // nearest to the centre determines it.
  Vec3 tip = log.tip[touch];
  if (settings.centre_to_tip > 0) {
    const NearestSite near =
        nearest_site(body, tip, settings.centre_to_tip + settings.placement_tolerance, log.name);
    const auto vertex = static_cast<std::size_t>(near.vertex);
    tip = tip + settings.centre_to_tip * body.response.inward[vertex];
  }
  curves.site = nearest_site(body, tip, settings.placement_tolerance, log.name);
  const Vec3 inward = body.response.inward[static_cast<std::size_t>(curves.site.vertex)];
  const Parts parts = parts_of(log, inward);
  const auto [low, high] = std::minmax_element(parts.along.begin(), parts.along.end());
  const double deep = *high - 0.02 * (*high - *low);
  const std::size_t first_deep = static_cast<std::size_t>(
      std::find_if(parts.along.begin(), parts.along.end(), [&](double x) { return x >= deep; }) -
      parts.along.begin());
  if (first_deep <= touch) {
    refuse(log.name, "the tool does not go into the body after the touch",
           "check the frame and the sign of the force");
  }
  const Vec3 way = log.tip[first_deep] - log.tip[touch];
  curves.tilt = std::acos(std::clamp(dot(way, inward) / norm(way), -1.0, 1.0));
  if (curves.tilt > kLargestTilt) {
    refuse(log.name,
           "the press runs " + std::to_string(curves.tilt * 180 / std::numbers::pi) +
               " degrees off the press direction of its site",
           "press along the surface normal, or check the frame");
  }
  const Vec3 pull =
      log.force[first_deep] - median_of(log.force, std::max<std::size_t>(8, touch / 2));
  if (dot(pull, inward) < 0) {
    refuse(log.name, "the force points out of the body where the tool is deepest",
           "check placement.force_is: \"on body\" or \"on tool\"");
  }
  const std::optional<DragSpan> drag = drag_of(parts, touch, first_deep);
  const PressRecord press =
      press_of(log, parts, drag ? std::min(drag->begin + 1, log.tip.size()) : log.tip.size());
  curves.press = analyse_press(press, settings.press);
  curves.touch = tip + (curves.press.contact.displacement - parts.along[touch]) * inward;
  if (drag) {
    const std::size_t head = std::max<std::size_t>(8, touch / 2);
    const Vec3 idle = median_of(log.force, head);
    // Along inward the press determines the offset better.
    const Vec3 rest = idle + (curves.press.baseline.offset - dot(idle, inward)) * inward;
    curves.drag = drag_curve(log, parts, *drag, inward, rest, settings, curves.press);
    if (!cut_at_slip(*curves.drag, settings.lateral_samples, log.name)) curves.drag.reset();
  }
  return curves;
}

}  // namespace palpate::measured
