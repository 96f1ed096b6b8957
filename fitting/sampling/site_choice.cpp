// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/sampling/site_choice.hpp"

#include <algorithm>
#include <optional>

#include "fitting/response/interpolate.hpp"
#include "fitting/response/surface_interpolation.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

std::vector<Vec3> positions_of(const Body& body) {
  std::vector<Vec3> positions;
  for (const std::int32_t node : body.response.node)
    positions.push_back(body.nodes[static_cast<std::size_t>(node)]);
  return positions;
}

/// Expected errors of the vertices that are not computed, updated while some of them are chosen.
class ExpectedErrors {
 public:
  ExpectedErrors(const Body& body, const std::vector<std::int32_t>& computed,
                 const Library& library)
      : open_(sites_not_computed(body, computed)),
        library_(library),
        gap_(open_.size(), kInfinity) {
    for (std::size_t i = 0; i < open_.size(); ++i)
      for (const std::int32_t c : computed)
        gap_[i] = std::min(gap_[i], distance(open_[i], static_cast<std::size_t>(c)));
    find_rates();
  }

  /// Chooses the vertex of the largest expected error above `target`; absent when there is none.
  std::optional<std::int32_t> choose_worst(double target) {
    std::optional<std::size_t> worst;
    double largest = target;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      // A vertex without a computed neighbour comes first: nothing is known there.
      const double expected = gap_[i] == kInfinity ? kInfinity : rate_[i] * gap_[i] * gap_[i];
      if (gap_[i] == 0 || expected <= largest) continue;
      largest = expected;
      worst = i;
    }
    if (!worst) return std::nullopt;
    const std::size_t chosen = open_[*worst];
    for (std::size_t i = 0; i < open_.size(); ++i)
      gap_[i] = std::min(gap_[i], distance(open_[i], chosen));
    return static_cast<std::int32_t>(chosen);
  }

 private:
  double distance(std::size_t a, std::size_t b) const {
    return interpolation_distance(library_.positions, library_.inward, a, b);
  }

  /// Expected error divided by the square of the gap.
  void find_rates() {
    const SurfaceInterpolation donors(library_.positions, library_.inward,
                                      interpolation_donors(library_));
    std::vector<double> rate_of_donor(library_.positions.size(), 0);
    for (const LeaveOneOutError& error : leave_one_out(library_)) {
      const auto v = static_cast<std::size_t>(error.vertex);
      double mean = 0;
      const std::vector<Donor> around = donors.nearest(v, kErrorNeighbours);
      for (const Donor& donor : around) mean += donor.weight / static_cast<double>(around.size());
      rate_of_donor[v] = error.relative / (mean * mean);
    }
    for (const std::size_t v : open_) {
      double largest = 0;
      for (const Donor& donor : donors.nearest(v, kErrorNeighbours))
        largest = std::max(largest, rate_of_donor[donor.vertex]);
      rate_.push_back(largest);
    }
  }

  std::vector<std::size_t> open_;
  const Library& library_;
  std::vector<double> gap_;   ///< m, to the nearest vertex computed or chosen
  std::vector<double> rate_;  ///< 1/m^2
};

}  // namespace

std::vector<std::int32_t> spread_sites(const Body& body, double spacing) {
  const std::vector<Vec3> positions = positions_of(body);
  const std::vector<std::size_t> sites = sites_of(body);
  std::vector<double> gap(sites.size(), kInfinity);
  std::vector<std::int32_t> chosen;
  for (;;) {
    const auto farthest = std::max_element(gap.begin(), gap.end());
    if (farthest == gap.end() || *farthest < spacing) break;
    const std::size_t next = sites[static_cast<std::size_t>(farthest - gap.begin())];
    chosen.push_back(static_cast<std::int32_t>(next));
    for (std::size_t i = 0; i < sites.size(); ++i)
      gap[i] =
          std::min(gap[i], interpolation_distance(positions, body.response.inward, sites[i], next));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<std::int32_t> next_sites(const Body& body, const std::vector<std::int32_t>& computed,
                                     const Library& library, double target, std::size_t most) {
  ExpectedErrors expected(body, computed, library);
  std::vector<std::int32_t> sites;
  while (sites.size() < most) {
    const auto worst = expected.choose_worst(target);
    if (!worst) break;
    sites.push_back(*worst);
  }
  std::sort(sites.begin(), sites.end());
  return sites;
}

}  // namespace palpate::fitting
