// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/site_fields.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/friction_cone.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {
namespace {

bool among(const std::vector<double>& depths, double depth) {
  return std::any_of(depths.begin(), depths.end(), [&](double d) { return same_depth(depth, d); });
}

}  // namespace

std::vector<double> field_depths(const IndentationSettings& settings, int count) {
  std::vector<double> depths;
  int last = 0;
  for (int k = 1; k <= count && last < settings.increments; ++k) {
    const double fraction = static_cast<double>(k) / count;
    const int nearest = static_cast<int>(std::lround(settings.increments * fraction * fraction));
    last = std::max(nearest, last + 1);
    depths.push_back(settings.depth * last / settings.increments);
  }
  return depths;
}

FieldRecorder::FieldRecorder(SiteSolver& solver, const CampaignContext& context,
                             const std::vector<std::int32_t>& nodes, int depths,
                             std::optional<double> friction)
    : solver_(solver),
      context_(context),
      nodes_(nodes),
      depths_(field_depths(context.indentation, depths)),
      friction_(friction) {
  solver.observe([this](const ToolContact&, const Displacement& u, const CurveSample& sample) {
    keep_press(sample.displacement, u);
  });
  solver.observe_lateral([this](const LateralPlan& plan, const ToolContact& contact,
                                const Displacement& u, const CurveSample& sample) {
    const Eigen::Vector3d& n = contact.tool().inward;
    const bool is_held = friction_ && within_friction(sample.force, {n[0], n[1], n[2]}, *friction_);
    keep_lateral({plan.lateral_depth, plan.direction, sample.displacement, since_rest(u)}, is_held);
  });
}

void FieldRecorder::keep_press(double depth, const Displacement& u) {
  const bool starts_path = among(context_.indentation.lateral_depths, depth);
  if (starts_path) lateral_starts_.insert_or_assign(depth, since_rest(u));
  if (among(depths_, depth) || (starts_path && friction_))
    fields_.normal.push_back({depth, since_rest(u)});
}

/// A state beyond friction gives way to the next one of its path.
void FieldRecorder::keep_lateral(LateralField field, bool is_held) {
  const auto start =
      std::find_if(lateral_starts_.begin(), lateral_starts_.end(),
                   [&](const auto& entry) { return same_depth(entry.first, field.depth); });
  if (start == lateral_starts_.end()) return;
  for (std::size_t i = 0; i < field.skin.size(); ++i) field.skin[i] -= start->second[i];
  auto& kept = fields_.lateral;
  const bool goes_on =
      !kept.empty() && kept.back().depth == field.depth && kept.back().direction == field.direction;
  if (goes_on && !last_is_held_)
    kept.back() = std::move(field);
  else
    kept.push_back(std::move(field));
  last_is_held_ = is_held;
}

SiteFields FieldRecorder::take(std::int32_t vertex) {
  lateral_starts_.clear();
  SiteFields taken = std::exchange(fields_, {});
  taken.vertex = vertex;
  return taken;
}

std::vector<float> FieldRecorder::since_rest(const Displacement& u) const {
  std::vector<float> skin;
  skin.reserve(3 * nodes_.size());
  for (const std::int32_t node : nodes_)
    for (Eigen::Index i = 0; i < 3; ++i)
      skin.push_back(static_cast<float>(u(i, node) - solver_.state_at_rest()(i, node)));
  return skin;
}

}  // namespace palpate::fem
