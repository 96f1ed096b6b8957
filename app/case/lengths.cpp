// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/lengths.hpp"
#include "format/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate::app {
namespace {

constexpr double kPatchesInDiagonal = 15;
constexpr double kDepthOverThickness = 0.2;
constexpr double kSpacingOverPatch = 3;

/// Fills lengths that are `auto` and notes what it chose.
class Derivation {
 public:
  explicit Derivation(std::string& notes) : notes_(notes) {}

  /// The length stays `auto` where `derived` is not known.
  void fill(const char* key, double& length, double derived) {
    if (!std::isnan(length) || std::isnan(derived)) return;
    length = derived;
    notes_ += fmt::format("{}{} = {}", notes_.empty() ? "" : ", ", key, length_text(length));
  }

 private:
  std::string& notes_;
};

}  // namespace

bool needs_body_size(const Case& c) {
  return std::isnan(c.mesh.patch_spacing) || std::isnan(c.campaign.indentation.depth);
}

void derive_lengths(Case& c, const std::optional<BodySize>& body) {
  fem::IndentationSettings& paths = c.campaign.indentation;
  Derivation derive(c.derived);
  if (body) derive.fill("patch_spacing", c.mesh.patch_spacing, body->diagonal / kPatchesInDiagonal);
  const double patch = c.mesh.patch_spacing;
  derive.fill("element_size", c.mesh.element_size, kElementOverPatch * patch);
  derive.fill("tool radius", paths.tool.radius, kRadiusOverPatch * patch);
  if (c.sampling.method == SamplingMethod::Adaptive)
    derive.fill("initial_spacing", c.sampling.initial_spacing, kSpacingOverPatch * patch);
  if (body)
    derive.fill("depth", paths.depth,
                std::min(kDepthOverPatch * patch, kDepthOverThickness * body->thickness));
  derive.fill("lateral_travel", paths.lateral_travel, kTravelOverDepth * paths.depth);
  const double depth = paths.depth;
  if (paths.lateral_depths.empty() && !std::isnan(depth))
    paths.lateral_depths = {depth / 3, 2 * depth / 3, depth};
}

}  // namespace palpate::app
