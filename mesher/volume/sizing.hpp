// SPDX-License-Identifier: AGPL-3.0-or-later
// How long the edges of a mesh shall be, by place.
#pragma once

#include <memory>
#include <vector>

#include "mesher/volume/domain.hpp"
#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

/// A size that is wanted at a point.
struct SizeSource {
  Vec3 point{};
  double size = 0;
};

/// The largest field that is at most `size` at each source and grows by at most `growth` per
/// length: min over the sources of size + growth |x - point|.
class GradedSize {
 public:
  /// @param sources at least one
  GradedSize(std::vector<SizeSource> sources, double growth);
  double at(const Vec3& x) const;

 private:
  struct Branch {
    Bounds box;
    double smallest = 0;             // size of its sources
    std::size_t begin = 0, end = 0;  // in sources_
    std::int32_t children = -1;      // the first of two neighbours, or -1 for a leaf
  };
  void divide(std::size_t branch);
  void search(std::size_t branch, const Vec3& x, double& smallest) const;
  double least(const Branch& branch, const Vec3& x) const;

  std::vector<SizeSource> sources_;
  double growth_;
  std::vector<Branch> branches_;
};

struct SizingSettings {
  SizeField surface_size;      ///< wanted where nothing is thin
  double smallest_size = 0;    ///< thin places are not refined further
  double per_thickness = 0.7;  ///< largest size / local thickness
};

/// Sizes at points of all surfaces of the domain and of the walls of layers: `surface_size`, or
/// less where the body, an enclosure or a layer is thinner. The thickness at a point is the
/// distance to the far side along the normal.
std::vector<SizeSource> surface_sizes(const Domain& domain, const SizingSettings& settings);

}  // namespace palpate::mesher
