// SPDX-License-Identifier: AGPL-3.0-or-later
// The bodies of the published experiment.
#pragma once

#include <memory>
#include <optional>

#include "app/experiment/slingshot.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "runtime/lockstep_search.hpp"
#include "runtime/search_thread.hpp"

namespace palpate::app::slingshot {

inline constexpr double kCurved = 0.005;  // m: the wall is quadratic up to here

/// Force of the wall (34) at depth x, N.
double wall_force(double k, double x);

/// The body along a line parallel to the x axis: force against the motion (N) at a depth (m). Each
/// call is one sample of the force loop.
class LineOfTouch {
 public:
  LineOfTouch(const SlingshotSetup& setup, double k);
  double force(double depth);

  Vec3 tip(double depth) const;                     ///< m
  const palpate_library* body() const;              ///< the cylinder; null: the wall
  const runtime::ContactObservation& seen() const;  ///< of the last sample on the cylinder

 private:
  SlingshotSetup setup_;
  double k_;
  double entry_ = 0;  ///< m, of the line into the undeformed cylinder
  std::unique_ptr<palpate_library> body_;
  std::optional<runtime::ContactState> contact_;
  std::unique_ptr<runtime::LockstepSearch> search_;
  runtime::Delivery delivered_;
  std::unique_ptr<runtime::SearchThread> thread_;
};

}  // namespace palpate::app::slingshot
