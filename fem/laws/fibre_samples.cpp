// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/fibre_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "format/error.hpp"

namespace palpate::fem {

FibreSamples::FibreSamples(std::vector<FibreSample> samples) : samples_(std::move(samples)) {
  if (samples_.empty())
    throw Error(ErrorKind::Configuration, "fibres", "there is no sample of their directions",
                "give at least one");
  for (const FibreSample& s : samples_) {
    const double length = norm(s.mean), sum = length + norm(s.at) + norm(s.across);
    if (!(std::isfinite(sum) && length > 0))
      throw Error(ErrorKind::Configuration,
                  "fibres at (" + std::to_string(s.at[0]) + ", " + std::to_string(s.at[1]) + ", " +
                      std::to_string(s.at[2]) + ") m",
                  "their direction has no length or is not finite",
                  "give finite directions that are not zero");
  }
  arrange(0, samples_.size(), 0);
}

void FibreSamples::arrange(std::size_t first, std::size_t last, std::size_t axis) {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return samples_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(
      at(first), at(middle), at(last),
      [axis](const FibreSample& a, const FibreSample& b) { return a.at[axis] < b.at[axis]; });
  arrange(first, middle, (axis + 1) % 3);
  arrange(middle + 1, last, (axis + 1) % 3);
}

void FibreSamples::search(std::size_t first, std::size_t last, std::size_t axis, const Vec3& X,
                          const FibreSample*& best, double& distance) const {
  if (first == last) return;
  const std::size_t middle = first + (last - first) / 2, next = (axis + 1) % 3;
  const FibreSample& here = samples_[middle];
  if (const double d = norm(here.at - X); d < distance) {
    distance = d;
    best = &here;
  }
  const double beyond = X[axis] - here.at[axis];
  const auto below = [&] { search(first, middle, next, X, best, distance); };
  const auto above = [&] { search(middle + 1, last, next, X, best, distance); };
  beyond < 0 ? below() : above();
  if (std::abs(beyond) < distance) beyond < 0 ? above() : below();
}

const FibreSample& FibreSamples::nearest(const Vec3& X) const {
  const FibreSample* best = &samples_.front();
  double distance = std::numeric_limits<double>::infinity();
  search(0, samples_.size(), 0, X, best, distance);
  return *best;
}

}  // namespace palpate::fem
