// SPDX-License-Identifier: AGPL-3.0-or-later
// Keeps the displacement of the skin while a site is solved.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fem/campaign/indentation.hpp"
#include "format/site_fields.hpp"

namespace palpate::fem {

/// The depths that are kept of a normal path, m, ascending: different increments of the path, near
/// depth (k/N)^2, k = 1 .. N, closer together where the contact is small.
std::vector<double> field_depths(const IndentationSettings& settings, int count);

/// Observes one site after another of the campaign. The displacement is kept on `nodes` of the
/// body. One object belongs to one thread.
class FieldRecorder {
 public:
  /// `solver` and `context` must outlive the recorder, and the recorder the solutions.
  /// `friction`: see CampaignSettings::field_friction.
  FieldRecorder(SiteSolver& solver, const CampaignContext& context,
                const std::vector<std::int32_t>& nodes, int depths,
                std::optional<double> friction = std::nullopt);

  /// The fields of the site solved last, without the digest of its curves.
  SiteFields take(std::int32_t vertex);

 private:
  std::vector<float> since_rest(const Displacement& u) const;
  void keep_press(double depth, const Displacement& u);
  void keep_lateral(LateralField field, bool is_held);

  const SiteSolver& solver_;
  const CampaignContext& context_;
  const std::vector<std::int32_t>& nodes_;
  std::vector<double> depths_;
  std::optional<double> friction_;
  bool last_is_held_ = false;  ///< by friction: the lateral field that was kept last
  std::map<double, std::vector<float>> lateral_starts_;  ///< by depth
  SiteFields fields_;
};

}  // namespace palpate::fem
