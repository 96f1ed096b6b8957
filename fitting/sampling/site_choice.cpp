// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/sampling/site_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "fitting/response/mean_response.hpp"
#include "fitting/sampling/surface_interpolation.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::size_t kNeighbours = 3;
constexpr int kDeflections = 8;  // at which a miss is judged
constexpr double kReach = 0.9;   // of the deepest response that a donor has

// A tool that does not slip feels at most mu times as much across as along the press.
constexpr double kLateralShare = 0.3;

std::vector<Vec3> positions_of(const Body& body) {
  std::vector<Vec3> positions;
  for (const std::int32_t node : body.response.node)
    positions.push_back(body.nodes[static_cast<std::size_t>(node)]);
  return positions;
}

std::vector<std::size_t> sites_of_body(const Body& body) {
  std::vector<std::size_t> sites;
  for (std::size_t v = 0; v < body.response.is_site.size(); ++v)
    if (body.response.is_site[v] != 0) sites.push_back(v);
  return sites;
}

std::vector<std::size_t> not_computed(const Body& body, const std::vector<std::int32_t>& computed) {
  std::vector<std::size_t> open;
  for (const std::size_t v : sites_of_body(body))
    if (!std::binary_search(computed.begin(), computed.end(), static_cast<std::int32_t>(v)))
      open.push_back(v);
  return open;
}

/// Fitted responses that reach as deep as the others: a shorter one would be extrapolated.
std::vector<std::size_t> donors_of(const Library& library) {
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
    if (reach >= kReach * deepest) donors.push_back(v);
  return donors;
}

std::vector<WeightedResponse> sources_of(const Library& library, const std::vector<Donor>& donors) {
  std::vector<WeightedResponse> sources;
  for (const Donor& donor : donors)
    sources.push_back({&library.responses[donor.vertex], donor.weight});
  return sources;
}

/// Differences of a curve and the weighted mean of others.
struct CurveMiss {
  double relative = 0, newton = 0;
};

template <class Curve>
CurveMiss miss_of(const NodeResponse& direct, const std::vector<WeightedResponse>& sources,
                  Curve curve) {
  const runtime::CompiledCurve known(curve(direct));
  std::vector<runtime::CompiledCurve> others;
  for (const WeightedResponse& source : sources) others.emplace_back(curve(*source.response));
  CurveMiss miss;
  double error2 = 0, force2 = 0;
  for (int i = 1; i <= kDeflections; ++i) {
    const double d = known.last_knot() * i / kDeflections;
    double error = -known.force(d);
    for (std::size_t s = 0; s < sources.size(); ++s)
      error += sources[s].weight * others[s].force(d);
    error2 += error * error;
    force2 += known.force(d) * known.force(d);
    miss.newton = std::max(miss.newton, std::abs(error));
  }
  miss.relative = force2 > 0 ? std::sqrt(error2 / force2) : 0;
  return miss;
}

Miss miss_at(const Library& library, std::size_t vertex, const std::vector<Donor>& donors) {
  const NodeResponse& direct = library.responses[vertex];
  const auto sources = sources_of(library, donors);
  const CurveMiss normal = miss_of(direct, sources, [](const auto& r) { return r.normal; });
  const CurveMiss lateral = miss_of(direct, sources, [](const auto& r) { return r.lateral; });
  return {static_cast<std::int32_t>(vertex),
          std::hypot(normal.relative, kLateralShare * lateral.relative), normal.newton,
          lateral.newton};
}

/// Misses by vertex.
std::vector<std::optional<Miss>> by_vertex(const std::vector<Miss>& misses, std::size_t vertices) {
  std::vector<std::optional<Miss>> at(vertices);
  for (const Miss& miss : misses) at[static_cast<std::size_t>(miss.vertex)] = miss;
  return at;
}

/// What is expected of the vertices that are not computed, while some of them are taken.
class Expectation {
 public:
  Expectation(const Body& body, const std::vector<std::int32_t>& computed, const Library& library)
      : open_(not_computed(body, computed)), library_(library), gap_(open_.size(), kFar) {
    for (std::size_t i = 0; i < open_.size(); ++i)
      for (const std::int32_t c : computed)
        gap_[i] = std::min(gap_[i], distance(open_[i], static_cast<std::size_t>(c)));
    find_rates();
  }

  /// The vertex of the largest expected miss above `target`, taken away; absent when there is none.
  std::optional<std::int32_t> take_worst(double target) {
    std::optional<std::size_t> worst;
    double largest = target;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      // A vertex that no computed one sees is taken first: nothing is known of it.
      const double expected = gap_[i] == kFar ? kFar : rate_[i] * gap_[i] * gap_[i];
      if (gap_[i] == 0 || expected <= largest) continue;
      largest = expected;
      worst = i;
    }
    if (!worst) return std::nullopt;
    const std::size_t taken = open_[*worst];
    for (std::size_t i = 0; i < open_.size(); ++i)
      gap_[i] = std::min(gap_[i], distance(open_[i], taken));
    return static_cast<std::int32_t>(taken);
  }

 private:
  double distance(std::size_t a, std::size_t b) const {
    return felt_distance(library_.positions, library_.inward, a, b);
  }

  /// Expected miss over the square of the gap.
  void find_rates() {
    const SurfaceInterpolation donors(library_.positions, library_.inward, donors_of(library_));
    std::vector<double> rate_of_donor(library_.positions.size(), 0);
    for (const Miss& miss : leave_one_out(library_)) {
      const auto v = static_cast<std::size_t>(miss.vertex);
      double mean = 0;
      const std::vector<Donor> around = donors.nearest(v, kNeighbours);
      for (const Donor& donor : around) mean += donor.weight / static_cast<double>(around.size());
      rate_of_donor[v] = miss.relative / (mean * mean);
    }
    for (const std::size_t v : open_) {
      double largest = 0;
      for (const Donor& donor : donors.nearest(v, kNeighbours))
        largest = std::max(largest, rate_of_donor[donor.vertex]);
      rate_.push_back(largest);
    }
  }

  std::vector<std::size_t> open_;
  const Library& library_;
  std::vector<double> gap_;   ///< m, to the nearest vertex computed or taken
  std::vector<double> rate_;  ///< 1/m^2
};

}  // namespace

std::vector<std::int32_t> spread_sites(const Body& body, double spacing) {
  const std::vector<Vec3> positions = positions_of(body);
  const std::vector<std::size_t> sites = sites_of_body(body);
  std::vector<double> gap(sites.size(), kFar);
  std::vector<std::int32_t> taken;
  for (;;) {
    const auto farthest = std::max_element(gap.begin(), gap.end());
    if (farthest == gap.end() || *farthest < spacing) break;
    const std::size_t next = sites[static_cast<std::size_t>(farthest - gap.begin())];
    taken.push_back(static_cast<std::int32_t>(next));
    for (std::size_t i = 0; i < sites.size(); ++i)
      gap[i] = std::min(gap[i], felt_distance(positions, body.response.inward, sites[i], next));
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

std::vector<Miss> leave_one_out(const Library& library) {
  const std::vector<std::size_t> donors = donors_of(library);
  const SurfaceInterpolation others(library.positions, library.inward, donors);
  std::vector<Miss> misses;
  for (const std::size_t v : donors) {
    const std::vector<Donor> weights = others.weights(v);
    if (!weights.empty()) misses.push_back(miss_at(library, v, weights));
  }
  return misses;
}

std::size_t interpolate_rest(const Body& body, const std::vector<std::int32_t>& computed,
                             const FitSettings& settings, Library& library) {
  const SurfaceInterpolation field(library.positions, library.inward, donors_of(library));
  const auto misses = by_vertex(leave_one_out(library), library.positions.size());
  std::size_t count = 0;
  for (const std::size_t v : not_computed(body, computed)) {
    const std::vector<Donor> donors = field.weights(v);
    if (donors.empty()) continue;
    NodeResponse response = mean_response(sources_of(library, donors), settings,
                                          "interpolated response of vertex " + std::to_string(v));
    for (const Donor& donor : field.nearest(v, kNeighbours)) {
      const auto& miss = misses[donor.vertex];
      if (!miss) continue;
      response.normal_error = std::max(response.normal_error, miss->normal);
      response.lateral_error = std::max(response.lateral_error, miss->lateral);
    }
    library.responses[v] = std::move(response);
    ++count;
  }
  return count;
}

std::vector<std::int32_t> next_sites(const Body& body, const std::vector<std::int32_t>& computed,
                                     const Library& library, double target, std::size_t most) {
  Expectation expectation(body, computed, library);
  std::vector<std::int32_t> sites;
  while (sites.size() < most) {
    const auto worst = expectation.take_worst(target);
    if (!worst) break;
    sites.push_back(*worst);
  }
  std::sort(sites.begin(), sites.end());
  return sites;
}

}  // namespace palpate::fitting
