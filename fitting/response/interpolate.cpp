// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/interpolate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "fitting/response/mean_response.hpp"
#include "fitting/response/surface_interpolation.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr int kDeflections = 8;         // at which an error is evaluated
constexpr double kMinReach = 0.9;       // of the deepest response, for a donor
constexpr double kLateralWeight = 0.3;  // largest ratio of lateral to normal force without slip

std::vector<WeightedResponse> sources_of(const Library& library, const std::vector<Donor>& donors) {
  std::vector<WeightedResponse> sources;
  for (const Donor& donor : donors)
    sources.push_back({&library.responses[donor.vertex], donor.weight});
  return sources;
}

/// Differences between a curve and the weighted mean of others.
struct CurveError {
  double relative = 0, newton = 0;
};

template <class Curve>
CurveError error_of_curve(const NodeResponse& direct, const std::vector<WeightedResponse>& sources,
                          Curve curve) {
  const runtime::CompiledCurve known(curve(direct));
  std::vector<runtime::CompiledCurve> others;
  for (const WeightedResponse& source : sources) others.emplace_back(curve(*source.response));
  CurveError error;
  double error2 = 0, force2 = 0;
  for (int i = 1; i <= kDeflections; ++i) {
    const double d = known.last_knot() * i / kDeflections;
    double difference = -known.force(d);
    for (std::size_t s = 0; s < sources.size(); ++s)
      difference += sources[s].weight * others[s].force(d);
    error2 += difference * difference;
    force2 += known.force(d) * known.force(d);
    error.newton = std::max(error.newton, std::abs(difference));
  }
  error.relative = force2 > 0 ? std::sqrt(error2 / force2) : 0;
  return error;
}

LeaveOneOutError error_at(const Library& library, std::size_t vertex,
                          const std::vector<Donor>& donors) {
  const NodeResponse& direct = library.responses[vertex];
  const auto sources = sources_of(library, donors);
  const CurveError normal = error_of_curve(direct, sources, [](const auto& r) { return r.normal; });
  const CurveError lateral =
      error_of_curve(direct, sources, [](const auto& r) { return r.lateral; });
  return {static_cast<std::int32_t>(vertex),
          std::hypot(normal.relative, kLateralWeight * lateral.relative), normal.newton,
          lateral.newton};
}

/// Errors by vertex.
std::vector<std::optional<LeaveOneOutError>> by_vertex(const std::vector<LeaveOneOutError>& errors,
                                                       std::size_t vertices) {
  std::vector<std::optional<LeaveOneOutError>> at(vertices);
  for (const LeaveOneOutError& error : errors) at[static_cast<std::size_t>(error.vertex)] = error;
  return at;
}

}  // namespace

std::vector<std::size_t> sites_of(const Body& body) {
  std::vector<std::size_t> sites;
  for (std::size_t v = 0; v < body.response.is_site.size(); ++v)
    if (body.response.is_site[v] != 0) sites.push_back(v);
  return sites;
}

std::vector<std::size_t> sites_not_computed(const Body& body,
                                            const std::vector<std::int32_t>& computed) {
  std::vector<std::size_t> open;
  for (const std::size_t v : sites_of(body))
    if (!std::binary_search(computed.begin(), computed.end(), static_cast<std::int32_t>(v)))
      open.push_back(v);
  return open;
}

std::vector<std::size_t> interpolation_donors(const Library& library) {
  double deepest = 0;
  std::vector<std::pair<std::size_t, double>> fitted;
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const NodeResponse& response = library.responses[v];
    if (response.status != ResponseStatus::Fitted) continue;
    fitted.emplace_back(v, runtime::CompiledCurve(response.normal).last_knot());
    deepest = std::max(deepest, fitted.back().second);
  }
  std::vector<std::size_t> donors;
  for (const auto& [v, reach] : fitted)
    if (reach >= kMinReach * deepest) donors.push_back(v);
  return donors;
}

std::vector<LeaveOneOutError> leave_one_out(const Library& library) {
  const std::vector<std::size_t> donors = interpolation_donors(library);
  const SurfaceInterpolation others(library.positions, library.inward, donors);
  std::vector<LeaveOneOutError> errors;
  for (const std::size_t v : donors) {
    const std::vector<Donor> weights = others.weights(v);
    if (!weights.empty()) errors.push_back(error_at(library, v, weights));
  }
  return errors;
}

std::size_t interpolate_rest(const Body& body, const std::vector<std::int32_t>& computed,
                             const FitSettings& settings, Library& library) {
  const SurfaceInterpolation field(library.positions, library.inward,
                                   interpolation_donors(library));
  const auto errors = by_vertex(leave_one_out(library), library.positions.size());
  std::size_t count = 0;
  for (const std::size_t v : sites_not_computed(body, computed)) {
    const std::vector<Donor> donors = field.weights(v);
    if (donors.empty()) continue;
    NodeResponse response = mean_response(sources_of(library, donors), settings,
                                          "interpolated response of vertex " + std::to_string(v));
    for (const Donor& donor : field.nearest(v, kErrorNeighbours)) {
      const auto& error = errors[donor.vertex];
      if (!error) continue;
      response.normal_error = std::max(response.normal_error, error->normal);
      response.lateral_error = std::max(response.lateral_error, error->lateral);
    }
    library.responses[v] = std::move(response);
    ++count;
  }
  return count;
}

}  // namespace palpate::fitting
