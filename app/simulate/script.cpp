// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/simulate/script.hpp"

#include <algorithm>
#include <cmath>

#include "app/simulate/hand_path.hpp"
#include "app/simulate/surface_path.hpp"
#include "format/error.hpp"
#include "format/numbers.hpp"
#include "format/to_index.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::app {
namespace {

constexpr double kPressOverDepth = 0.5;
constexpr double kSlideOverDiagonal = 0.5;
constexpr double kPressTime = 1, kSlideTime = 2;       // s, at the peak of the speed all the way
constexpr double kHoldOverTime = 2, kLongestHold = 5;  // s
// The device of [Mahvash & Hayward 2005, section VI] on the stiffest wall that it renders, 170 N/m:
// 84.5 g, 0.081 N s/m and 10 mN, rounded.
constexpr double kMassOverStiffness = 5e-4;     // s^2
constexpr double kDampingOverStiffness = 5e-4;  // s
constexpr double kFrictionOverForce = 0.01;
// The hand yields by a fifth of its path, without oscillating.
constexpr double kHandOverStiffness = 4;
constexpr double kHandDampingOverStiffness = 0.1;  // s

/// Typical stiffness, force and energy of the responses at their last knots.
struct Typical {
  double stiffness = 0;  ///< N/m, median secant
  double force = 0;      ///< N, median
  double energy = 0;     ///< J, median
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Typical typical_of(const Library& library) {
  std::vector<double> stiffness, force, energy;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const runtime::CompiledCurve curve(node.normal);
    force.push_back(curve.force(curve.last_knot()));
    stiffness.push_back(force.back() / curve.last_knot());
    energy.push_back(curve.evaluate(curve.last_knot()).energy);
  }
  return {median(std::move(stiffness)), median(std::move(force)), median(std::move(energy))};
}

/// Diagonal of the box around the triangles whose corners all have a response, m.
double diagonal_of(const Library& library) {
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
  for (const Triangle& triangle : library.triangles) {
    const bool touchable = std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
      return library.responses[to_index(v)].status != ResponseStatus::Hole;
    });
    for (std::size_t corner = 0; touchable && corner < 3; ++corner)
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], library.positions[to_index(triangle[corner])][i]);
        high[i] = std::max(high[i], library.positions[to_index(triangle[corner])][i]);
      }
  }
  return low[0] <= high[0] ? norm(high - low) : 0;
}

void derive(double& value, double derived) {
  if (std::isnan(value)) value = derived;
}

void derive_device(runtime::SimulatedDeviceSettings& device, const Typical& body) {
  derive(device.mass, kMassOverStiffness * body.stiffness);
  derive(device.damping, kDampingOverStiffness * body.stiffness);
  derive(device.coulomb_friction, kFrictionOverForce * body.force);
  derive(device.hand_stiffness, kHandOverStiffness * body.stiffness);
  derive(device.hand_damping, kHandDampingOverStiffness * body.stiffness);
}

}  // namespace

double depth_of_responses(const Library& library) {
  double depth = kInfinity;
  for (const NodeResponse& node : library.responses)
    if (node.status != ResponseStatus::Hole)
      depth = std::min(depth, static_cast<double>(node.normal.knot.back()));
  if (std::isinf(depth))
    refuse(library.name, "no vertex of the library has a response",
           "look at the failed sites with `palpate inspect`");
  return depth;
}

SimulateSection settled(SimulateSection script, const Library& library) {
  derive(script.press_depth, kPressOverDepth * depth_of_responses(library));
  derive(script.press_speed, kPeakOverMean * 2 * script.press_depth / kPressTime);
  const double longest_time = library.relaxes() ? library.relaxation_times.back() : 0;
  derive(script.hold, std::min(kHoldOverTime * longest_time, kLongestHold));
  derive(script.slide_length, kSlideOverDiagonal * diagonal_of(library));
  const double slide =
      script.path == SlidePath::Between ? norm(script.to - script.from) : script.slide_length;
  derive(script.slide_speed, kPeakOverMean * slide / kSlideTime);
  const Typical body = typical_of(library);
  derive(script.tank_cap, std::max(runtime::ContactSettings{}.tank_cap, body.energy));
  derive_device(script.device, body);
  return script;
}

HandPath scripted_path(const SimulateSection& script, const Library& library) {
  constexpr double kPoints = 100;  // of the slide, at least
  if (script.path == SlidePath::Between) {
    const double spacing = norm(script.to - script.from) / kPoints;
    return {script, path_between(library, script.from, script.to, spacing)};
  }
  const std::size_t start = middle_triangle(library);
  return {script,
          straight_path(library, start, script.slide_length, script.slide_length / kPoints)};
}

}  // namespace palpate::app
