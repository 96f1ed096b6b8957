// SPDX-License-Identifier: AGPL-3.0-or-later
// What relaxation makes of a press, rendered by the runtime itself.
#include <algorithm>
#include <cmath>
#include <vector>

#include "app/report/embed.hpp"
#include "app/report/page_data.hpp"
#include "format/to_index.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::report {
namespace {

using nlohmann::json;

constexpr int kSteps = 400;                 // of a press, and of its release
constexpr double kFast = 0.02, kSlow = 50;  // of the shortest and of the longest time
constexpr double kDepthOfResponse = 0.9;    // of a node: no force is extrapolated

/// A tool over a node, moved along its press direction.
class Tool {
 public:
  Tool(const Library& library, const palpate_library& loaded, std::size_t vertex)
      : library_(library), vertex_(vertex), contact_(loaded.surface, loaded.tree, {0, 0}) {
    to(-1e-6, 1e-9);
    to(1e-12, 1e-9);
  }
  /// @return force along the press direction, N
  double to(double depth, double dt) {
    const Vec3& inward = library_.inward[vertex_];
    contact_.step(library_.positions[vertex_] + depth * inward, dt);
    return dot(contact_.observation().force, inward);
  }

 private:
  const Library& library_;
  std::size_t vertex_;
  runtime::ContactState contact_;
};

/// To the depth and back, each in `time` (s).
json press_and_release(Tool tool, double depth, double time) {
  std::vector<float> at, force;
  for (int i = 1; i <= 2 * kSteps; ++i) {
    const double part = static_cast<double>(i <= kSteps ? i : 2 * kSteps - i) / kSteps;
    at.push_back(static_cast<float>(part * depth));
    force.push_back(static_cast<float>(tool.to(part * depth, time / kSteps)));
  }
  return {{"time", time}, {"depth", column(at)}, {"force", column(force)}};
}

/// A press without time, and a rest of `duration` (s).
json hold(Tool tool, double depth, double duration) {
  std::vector<float> time, force;
  tool.to(depth / 2, 1e-9);
  for (int i = 0; i <= kSteps; ++i) {
    time.push_back(static_cast<float>(duration * i / kSteps));
    force.push_back(static_cast<float>(tool.to(depth, i == 0 ? 1e-9 : duration / kSteps)));
  }
  return {{"time", column(time)}, {"force", column(force)}};
}

/// The fractions of a time over the nodes: smallest, median, largest.
json fractions_at(const Library& library, std::size_t i) {
  std::vector<double> of_nodes;
  for (const NodeResponse& node : library.responses)
    if (node.status != ResponseStatus::Hole)
      of_nodes.push_back(static_cast<double>(node.relaxation[i]));
  std::sort(of_nodes.begin(), of_nodes.end());
  return {{"time", library.relaxation_times[i]},
          {"least", of_nodes.front()},
          {"median", of_nodes[of_nodes.size() / 2]},
          {"most", of_nodes.back()}};
}

}  // namespace

json relaxation_data(const Library& library, std::int32_t vertex) {
  if (!library.relaxes() || vertex < 0) return nullptr;
  const palpate_library loaded(library);
  const std::vector<double>& times = library.relaxation_times;
  const double fast = kFast * times.front(), slow = kSlow * times.back();
  const runtime::CompiledCurve curve(library.responses[to_index(vertex)].normal);
  const double depth = kDepthOfResponse * curve.last_knot();
  const Tool tool(library, loaded, to_index(vertex));
  json presses = json::array(), fractions = json::array();
  for (const double time : {fast, std::sqrt(times.front() * times.back()), slow})
    presses.push_back(press_and_release(tool, depth, time));
  for (std::size_t i = 0; i < times.size(); ++i) fractions.push_back(fractions_at(library, i));
  return {{"vertex", vertex},
          {"depth", depth},
          {"presses", presses},
          {"hold", hold(tool, depth, 3 * times.back())},
          {"fractions", fractions}};
}

}  // namespace palpate::report
