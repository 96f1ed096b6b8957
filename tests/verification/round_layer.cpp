// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/verification/round_layer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "format/to_index.hpp"
#include "tests/support/prism_body.hpp"

namespace palpate::test {

namespace {

constexpr int kSectors = 3;  ///< of six points, on all but the innermost rings
constexpr double kGrowth = 2;

std::vector<double> ring_radii(const RoundLayer& layer) {
  constexpr double kAngle = 2 * M_PI / (6 * kSectors);
  const double polygon = std::sqrt(kAngle / std::sin(kAngle));
  std::vector<double> radii;
  const auto within = [&](int i) {
    return 1 - std::pow(1 - i / static_cast<double>(layer.rings), layer.crowding);
  };
  for (int i = 1; i <= layer.rings; ++i) radii.push_back(layer.circle * polygon * within(i));
  double step = layer.circle * (1 - within(layer.rings - 1));
  for (int ring = 0; radii.back() + 0.5 * step < layer.extent; ++ring) {
    radii.push_back(std::min(radii.back() + step, layer.extent));
    if (ring > 0) step = std::min(kGrowth * step, 1.5 * layer.thickness);
  }
  radii.back() = layer.extent;
  return radii;
}

/// Coordinates of the layers, from the top down.
std::vector<double> layer_depths(const RoundLayer& layer) {
  std::vector<double> depths{0};
  double step = layer.circle * std::pow(1.0 / layer.rings, layer.crowding);
  while (depths.back() + 1.5 * step < layer.thickness) {
    depths.push_back(depths.back() + step);
    step = std::min(kGrowth * step, 0.5 * layer.thickness);
  }
  depths.push_back(layer.thickness);
  return depths;
}

}  // namespace

Body make_round_layer(const RoundLayer& layer) {
  const std::vector<double> depths = layer_depths(layer);
  const int layers = static_cast<int>(depths.size()) - 1;
  const Triangulation top = rings(ring_radii(layer), kSectors);
  Body body = make_prisms(top, layers, [&](const Vec3& x, int level) {
    return Vec3{x[0], x[1], -depths[to_index(layers - level)]};
  });
  const auto count = static_cast<std::int32_t>(top.points.size());
  for (std::int32_t i = 0; i < count; ++i) body.fixed_nodes.push_back(i);
  body.response.node = {count * layers};
  body.response.inward = {{0, 0, -1}};
  body.response.is_site = {1};
  return body;
}

Pressed press(const Body& body, double young, double poisson, const fem::ToolGeometry& tool,
              double depth, int increments, fem::Engine engine) {
  fem::CampaignSettings s;
  s.materials = {{"tissue", {young, poisson}}};
  s.indentation.tool = tool;
  s.indentation.depth = depth;
  s.indentation.increments = increments;
  s.indentation.lateral_depths.clear();
  s.indentation.lateral_travel = 0;
  s.indentation.force_tolerance = 3e-5;
  const fem::CampaignContext context(body, s, engine);
  Pressed pressed{fem::solve_site(context, 0, nullptr), context.model.mesh().nodes()};
  EXPECT_EQ(pressed.curves.status, SiteStatus::Complete) << pressed.curves.reason;
  return pressed;
}

}  // namespace palpate::test
