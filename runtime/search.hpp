// SPDX-License-Identifier: Apache-2.0
// Which triangles the force loop will need next; this may be computed at a low rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "format/vec3.hpp"
#include "runtime/collision.hpp"
#include "runtime/delivery.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// Position of the force loop.
struct TipReport {
  Vec3 position{};                    ///< m
  std::int32_t element = kNoElement;  ///< active element, if any
};

/// Finds the triangles around the tip, repeatedly. The motion of the tip until the next call is
/// predicted from that between the last two. Allocates; for one thread other than the force loop.
class Search {
 public:
  /// The surface and the tree must outlive the search. `most`: triangles in a delivery; the active
  /// element and its 1-ring (about 13) come first.
  Search(const Surface& surface, const CollisionTree& tree, std::size_t most = Delivery::kMost);

  /// In contact: the 1-ring of the active element, then outwards over the surface, nearest to the
  /// predicted path first. Free: the triangles nearest to the predicted path, on any part of the
  /// body.
  Delivery look(const TipReport& tip);

 private:
  struct Way {
    Vec3 from{}, to{};
  };
  double distance(std::int32_t m, const Way& way) const;
  void around(std::int32_t active, const Way& way);
  void add_ring(std::int32_t active);
  void near(const Way& way, double motion);
  bool add(std::int32_t m);

  const Surface* surface_;
  const CollisionTree* tree_;
  std::size_t most_;
  double edge_ = 0;  ///< m, typical
  std::optional<Vec3> last_;
  std::vector<std::uint32_t> stamp_;  ///< per element: the search that last found it
  std::uint32_t look_ = 0;
  std::vector<std::int32_t> found_;
};

}  // namespace palpate::runtime
