// SPDX-License-Identifier: AGPL-3.0-or-later
// The body as the solver of one site sees it.
#pragma once

#include <optional>

#include "fem/campaign/campaign_context.hpp"
#include "fem/mesh/refined_mesh.hpp"

namespace palpate::fem {

/// The body and the window around the tool, on the mesh of the campaign; or, where
/// IndentationSettings::refine_under_tool asks for it, with the elements around the tool divided in
/// eight. The factor of the campaign serves both: what is divided lies inside the window, which
/// every site solves by itself. Immutable after construction.
class SiteBody {
 public:
  SiteBody(const CampaignContext& context, const Eigen::Vector3d& site);

  const SolidModel& whole() const { return refined_ ? *refined_ : *whole_; }
  const QuadraticMesh& mesh() const { return whole().mesh(); }
  /// Only with a shared factor.
  const SolidModel& window() const { return *window_; }
  const Prolongation* prolongation() const { return prolongation_ ? &*prolongation_ : nullptr; }
  /// The state before the touch, on the nodes of mesh().
  const Displacement& rest() const { return rest_; }
  double bytes() const;  ///< without what the campaign shares

 private:
  const SolidModel* whole_;
  std::optional<SolidModel> refined_, window_;
  std::optional<Prolongation> prolongation_;
  Displacement rest_;
};

}  // namespace palpate::fem
