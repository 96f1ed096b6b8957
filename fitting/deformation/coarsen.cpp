// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/coarsen.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "format/to_index.hpp"

namespace palpate::fitting {
namespace {

/// The first `kept` of each row of `all`.
std::vector<float> leading(const std::vector<float>& all, std::size_t row, std::size_t kept) {
  std::vector<float> out;
  for (std::size_t begin = 0; begin < all.size(); begin += row)
    out.insert(out.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
               all.begin() + static_cast<std::ptrdiff_t>(begin + kept));
  return out;
}

/// Sum of the squares of what leading() leaves out. A lateral deflection is of the size of the
/// depth at most: `scale_of(row)`.
template <class Scale>
double squares_left_out(const std::vector<float>& all, std::size_t row, std::size_t kept,
                        const Scale& scale_of) {
  double sum = 0;
  for (std::size_t r = 0; r * row < all.size(); ++r)
    for (std::size_t m = kept; m < row; ++m) {
      const double amplitude = scale_of(r) * static_cast<double>(all[r * row + m]);
      sum += amplitude * amplitude;
    }
  return sum;
}

/// Root mean square over vertices and fields. Modes have the norm 1 over the skin.
double left_out(const Deformation& d, std::size_t kept) {
  const std::size_t modes = d.mode_count(), laterals = d.lateral_depths.size();
  const double squares =
      squares_left_out(d.press_modes, modes, kept, [](std::size_t) { return 1.0; }) +
      squares_left_out(d.lateral_modes, modes, kept, [&](std::size_t row) {
        return d.lateral_depths[row / kTangents % laterals];
      });
  const std::size_t fields = d.sites.size() * (d.depths.size() + kTangents * laterals);
  const double mean = squares / static_cast<double>(fields * d.positions.size());
  return std::sqrt(d.rms_left_out * d.rms_left_out + mean);
}

/// The rows of one lateral depth of each site.
template <class T>
std::vector<T> at_lateral_depth(const std::vector<T>& all, std::size_t sites, std::size_t depths,
                                std::size_t kept) {
  const std::size_t row = all.size() / (sites * depths);
  std::vector<T> out;
  for (std::size_t site = 0; site < sites; ++site) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>((site * depths + kept) * row);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
  }
  return out;
}

/// Keeps the middle one of the lateral depths, the deeper of two.
void keep_one_lateral_depth(Deformation& d) {
  const std::size_t depths = d.lateral_depths.size(), kept = depths / 2, sites = d.sites.size();
  if (depths < 2) return;
  d.lateral_depths = {d.lateral_depths[kept]};
  const auto keep = [&](auto& all) { all = at_lateral_depth(all, sites, depths, kept); };
  keep(d.lateral_local);
  keep(d.lateral_modes);
  keep(d.anisotropic);
  keep(d.anisotropic_scale);
}

}  // namespace

Deformation coarsened(const Deformation& fine, const std::vector<Triangle>& triangles,
                      std::size_t modes) {
  const std::size_t all = fine.mode_count(), kept = std::min(modes, all);
  const std::size_t row = 3 * fine.positions.size();
  Deformation d = fine;
  d.rms_left_out = left_out(fine, kept);
  d.positions.clear();
  d.triangles = triangles;
  d.modes.clear();
  for (const std::int32_t w : fine.vertex_of) d.positions.push_back(fine.positions[to_index(w)]);
  for (std::size_t m = 0; m < kept; ++m)
    for (const std::int32_t w : fine.vertex_of)
      for (std::size_t i = 0; i < 3; ++i)
        d.modes.push_back(fine.modes[m * row + 3 * to_index(w) + i]);
  std::iota(d.vertex_of.begin(), d.vertex_of.end(), 0);
  d.mode_scale.resize(kept);
  d.press_modes = leading(fine.press_modes, all, kept);
  d.lateral_modes = leading(fine.lateral_modes, all, kept);
  keep_one_lateral_depth(d);
  return d;
}

}  // namespace palpate::fitting
