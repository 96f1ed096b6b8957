// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/slide_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

namespace palpate::fitting {
namespace {

constexpr int kSectors = 8;  // of the azimuth, initially

Range first_half(const Range& range) {
  return {range.low, range.middle()};
}
Range second_half(const Range& range) {
  return {range.middle(), range.high};
}

SlideCell::Natural between(const SlideCell::Natural& a, const SlideCell::Natural& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

double apart(const SlideCell::Natural& a, const SlideCell::Natural& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Divides the longest side, in natural coordinates.
std::pair<SlideCell, SlideCell> halve_part(const SlideCell& cell) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (apart(cell.part[k], cell.part[(k + 1) % 3]) >
        apart(cell.part[longest], cell.part[(longest + 1) % 3]))
      longest = k;
  }
  const std::size_t next = (longest + 1) % 3;
  const SlideCell::Natural middle = between(cell.part[longest], cell.part[next]);
  std::pair<SlideCell, SlideCell> halves{cell, cell};
  halves.first.part[longest] = middle;
  halves.second.part[next] = middle;
  return halves;
}

std::pair<SlideCell, SlideCell> halve_azimuth(const SlideCell& cell) {
  std::pair<SlideCell, SlideCell> halves{cell, cell};
  halves.first.azimuth = first_half(cell.azimuth);
  halves.second.azimuth = second_half(cell.azimuth);
  return halves;
}

std::pair<SlideCell, SlideCell> halve_depth(const SlideCell& cell) {
  std::pair<SlideCell, SlideCell> halves{cell, cell};
  halves.first.z = first_half(cell.z);
  halves.second.z = second_half(cell.z);
  halves.second.reach.low = halves.second.z.low;
  return halves;
}

/// The state in the middle of a cell, with the largest depth offset or with none.
SlideCell state_in(const SlideCell& cell, bool offset) {
  SlideCell::Natural centre{};
  for (const SlideCell::Natural& n : cell.part)
    for (std::size_t l = 0; l < 3; ++l) centre[l] += n[l] / 3;
  const double azimuth = cell.azimuth.middle(), z = cell.z.middle();
  const double reach = offset ? cell.reach.high : z;
  return {{centre, centre, centre}, {azimuth, azimuth}, {z, z}, {reach, reach}};
}

using Halving = std::pair<SlideCell, SlideCell> (*)(const SlideCell&);

/// Cyclic order, used while no trial lowers the bound. The part of the triangle has two dimensions
/// and is halved three times a cycle: bounds depend more on position than on depth or azimuth.
Halving cyclic(int halvings) {
  constexpr std::array<Halving, 5> kOrder{halve_depth, halve_part, halve_part, halve_azimuth,
                                          halve_part};
  return kOrder[static_cast<std::size_t>(halvings) % kOrder.size()];
}

}  // namespace

SlideSearch::SlideSearch(ContactElement element)
    : element_(std::move(element)), jacobian_(element_) {
  const std::vector<double> depths = element_.depth_cells();
  for (std::size_t k = 0; k + 1 < depths.size(); ++k) {
    for (int i = 0; i < kSectors; ++i) {
      SlideCell cell;
      cell.azimuth = {2 * M_PI * i / kSectors, 2 * M_PI * (i + 1) / kSectors};
      cell.z = {depths[k], depths[k + 1]};
      cell.reach = {depths[k], element_.depth};
      parts_.push({cell, jacobian_.bound(cell), 0});
    }
  }
}

/// Halves along the coordinate that loosens the bound most: the one whose restriction to its middle
/// lowers the bound most.
std::pair<SlideCell, SlideCell> SlideSearch::halves(const Part& part) const {
  const SlideCell middle = state_in(part.cell, false);
  SlideCell position = part.cell, azimuth = part.cell, depth = part.cell;
  position.part = middle.part;
  azimuth.azimuth = middle.azimuth;
  depth.z = middle.z;
  const double by_position = jacobian_.bound(position), by_azimuth = jacobian_.bound(azimuth),
               by_depth = jacobian_.bound(depth);
  const double least = std::min({by_position, by_azimuth, by_depth});
  if (!(least < part.bound)) return cyclic(part.halvings)(part.cell);
  if (least == by_position) return halve_part(part.cell);
  return least == by_azimuth ? halve_azimuth(part.cell) : halve_depth(part.cell);
}

void SlideSearch::evaluate_middle(const SlideCell& cell) {
  for (const bool offset : {false, true}) {
    const SlideCell state = state_in(cell, offset);
    const double norm = jacobian_.bound(state);
    if (norm <= attained_) continue;
    attained_ = norm;
    causes_ = jacobian_.causes(state);
  }
}

void SlideSearch::advance(int halvings, double enough) {
  for (int i = 0; i < halvings; ++i) {
    const Part worst = parts_.top();
    evaluate_middle(worst.cell);
    if (worst.bound <= kNearEnough * std::max(attained_, enough)) return;
    parts_.pop();
    ++spent_;
    const auto [first, second] = halves(worst);
    for (const SlideCell& cell : {first, second})
      parts_.push({cell, std::min(worst.bound, jacobian_.bound(cell)), worst.halvings + 1});
  }
}

}  // namespace palpate::fitting
