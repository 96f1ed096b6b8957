// SPDX-License-Identifier: Apache-2.0
// Where on a body a contact is, as its memories need it.
#pragma once

#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// A contact point, the responses there and its normal: a view, valid while these live.
struct ContactPlace {
  const SurfacePoint& point;
  const InterpolatedResponse& response;
  const Vec3& normal;
  const Vec3&
      weights;  ///< of the three lateral responses: n_l, or n_l w_l of the grip when coupled
};

}  // namespace palpate::runtime
