// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/sizing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/volume/samples.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kLeafSources = 8;

/// Samples per size: close enough that the field between them is that of the nearest.
constexpr double kSampleSpacing = 0.5;

/// A start of rays below the surface, in parts of the smallest size.
constexpr double kBelow = 1e-4;

double distance_to(const Bounds& box, const Vec3& x) {
  Vec3 outside{};
  for (std::size_t k = 0; k < 3; ++k)
    outside[k] = std::max({box.low[k] - x[k], 0.0, x[k] - box.high[k]});
  return norm(outside);
}

Bounds bounds_of(const std::vector<SizeSource>& sources, std::size_t begin, std::size_t end) {
  Bounds box{sources[begin].point, sources[begin].point};
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], sources[i].point[k]);
      box.high[k] = std::max(box.high[k], sources[i].point[k]);
    }
  }
  return box;
}

double smallest_of(const std::vector<SizeSource>& sources, std::size_t begin, std::size_t end) {
  double smallest = sources[begin].size;
  for (std::size_t i = begin; i < end; ++i) smallest = std::min(smallest, sources[i].size);
  return smallest;
}

}  // namespace

GradedSize::GradedSize(std::vector<SizeSource> sources, double growth)
    : sources_(std::move(sources)), growth_(growth) {
  branches_.push_back({bounds_of(sources_, 0, sources_.size()),
                       smallest_of(sources_, 0, sources_.size()), 0, sources_.size()});
  for (std::size_t branch = 0; branch < branches_.size(); ++branch) divide(branch);
}

/// Halves the sources at the middle of their longest extent.
void GradedSize::divide(std::size_t branch) {
  const auto [begin, end] = std::pair(branches_[branch].begin, branches_[branch].end);
  if (end - begin <= kLeafSources) return;
  const Vec3 span = branches_[branch].box.high - branches_[branch].box.low;
  const auto axis =
      static_cast<std::size_t>(std::max_element(span.begin(), span.end()) - span.begin());
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t i) { return sources_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const auto& a, const auto& b) { return a.point[axis] < b.point[axis]; });
  branches_[branch].children = static_cast<std::int32_t>(branches_.size());
  for (const auto& [first, last] : {std::pair(begin, middle), std::pair(middle, end)}) {
    branches_.push_back(
        {bounds_of(sources_, first, last), smallest_of(sources_, first, last), first, last});
  }
}

double GradedSize::least(const Branch& branch, const Vec3& x) const {
  return branch.smallest + growth_ * distance_to(branch.box, x);
}

void GradedSize::search(std::size_t number, const Vec3& x, double& smallest) const {
  const Branch& branch = branches_[number];
  if (least(branch, x) >= smallest) return;
  if (branch.children < 0) {
    for (std::size_t i = branch.begin; i < branch.end; ++i)
      smallest = std::min(smallest, sources_[i].size + growth_ * norm(x - sources_[i].point));
    return;
  }
  auto first = static_cast<std::size_t>(branch.children), second = first + 1;
  if (least(branches_[second], x) < least(branches_[first], x)) std::swap(first, second);
  search(first, x, smallest);
  search(second, x, smallest);
}

double GradedSize::at(const Vec3& x) const {
  double smallest = std::numeric_limits<double>::infinity();
  search(0, x, smallest);
  return smallest;
}

namespace {

void add_sizes(const Surface& surface, const SizingSettings& settings,
               std::vector<SizeSource>& sizes) {
  const double extent = largest_dimension(surface.points);
  const SizeField size = [&](const Vec3& x) {
    return std::min(settings.surface_size(x), settings.per_thickness * extent);
  };
  double spacing = extent;
  for (const Vec3& x : surface.points) spacing = std::min(spacing, kSampleSpacing * size(x));
  const SurfaceQuery query(surface);
  const double below = kBelow * std::min(settings.smallest_size, extent);
  const SizeField apart = [&](const Vec3& x) { return kSampleSpacing * size(x); };
  for (const Sample& sample : thinned(sample_surface(surface, spacing), apart)) {
    const Vec3 inward = -sample.outward;
    const auto far = query.first_hit(sample.point + below * inward, inward);
    const double thin = far ? settings.per_thickness * (*far + below) : settings.smallest_size;
    const double wanted = size(sample.point);
    sizes.push_back(
        {sample.point, std::min(wanted, std::max({thin, settings.smallest_size, below}))});
  }
}

/// The sizes at the skin, repeated at the walls of the layers below.
void add_layers(const Domain& domain, const SizingSettings& settings,
                std::vector<SizeSource>& sizes) {
  std::vector<SizeSource> skin;
  add_sizes(domain.skin, settings, skin);
  double thinnest = std::numeric_limits<double>::infinity(), depth = 0;
  for (const Layer& layer : domain.layers) thinnest = std::min(thinnest, layer.thickness);
  const SurfaceQuery query(domain.skin);
  for (SizeSource& source : skin) source.size = std::min(source.size, thinnest);
  sizes.insert(sizes.end(), skin.begin(), skin.end());
  for (const Layer& layer : domain.layers) {
    depth += layer.thickness;
    for (const SizeSource& source : skin) {
      const auto foot = query.closest(source.point);
      const Vec3 outward =
          area_vector(domain.skin.points, domain.skin.triangles[to_index(foot.triangle)]);
      sizes.push_back({source.point - depth * unit(outward), source.size});
    }
  }
}

}  // namespace

std::vector<SizeSource> surface_sizes(const Domain& domain, const SizingSettings& settings) {
  std::vector<SizeSource> sizes;
  if (domain.layers.empty()) {
    add_sizes(domain.skin, settings, sizes);
  } else {
    add_layers(domain, settings, sizes);
  }
  for (const Enclosure& enclosure : domain.enclosures)
    add_sizes(enclosure.surface, settings, sizes);
  return sizes;
}

}  // namespace palpate::mesher
