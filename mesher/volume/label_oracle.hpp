// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

/// A body given by the region of each point: a segmented image.
struct LabelField {
  std::function<std::int32_t(const Vec3&)> region;  ///< index into region_names, or kVoid
  Bounds box;                                       ///< m; outside all is void
  double resolution = 0;                            ///< m: what is thinner may be missed, a voxel
  std::vector<std::string> region_names;
};

/// Answers about a label field by steps of half its resolution and bisection.
std::unique_ptr<Oracle> make_oracle(const LabelField& field);

}  // namespace palpate::mesher
