// SPDX-License-Identifier: AGPL-3.0-or-later
// A flat plate of response vertices with curves whose stiffness is a given field.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "fitting/response/fit_settings.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {

constexpr double kStep = 0.005;
constexpr double kDepth = 0.006, kTravel = 0.003;
inline const Vec3 kInward{0, 0, -1};

using Field = std::function<double(const Vec3&)>;

/// A square plate of (n+1)^2 response vertices, `kStep` apart, in the plane z = 0.
inline Body plate(int n) {
  Body body;
  body.name = "plate";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      body.response.node.push_back(static_cast<std::int32_t>(body.nodes.size()));
      body.nodes.push_back({i * kStep, j * kStep, 0});
      body.response.inward.push_back(kInward);
      body.response.is_site.push_back(1);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      body.response.triangles.push_back({a, b, d});
      body.response.triangles.push_back({a, d, c});
    }
  return body;
}

inline const Vec3& position(const Body& body, std::int32_t vertex) {
  return body.nodes[static_cast<std::size_t>(vertex)];
}

/// Curves of a body that is stiffer where the field is larger: 500 N/m^1.5 times it.
inline SiteCurves press(const Body& body, std::int32_t vertex, const Field& field) {
  const double scale = field(position(body, vertex));
  SiteCurves site;
  site.vertex = vertex;
  site.status = SiteStatus::Complete;
  CurvePath normal{PathKind::Normal, 0, kInward, {}};
  for (int i = 0; i <= 12; ++i) {
    CurveSample sample;
    sample.displacement = kDepth * i / 12;
    sample.force = 500 * scale * std::pow(sample.displacement, 1.5) * kInward;
    normal.samples.push_back(sample);
  }
  CurvePath lateral{PathKind::Lateral, kDepth, {1, 0, 0}, {}};
  for (int i = 0; i <= 6; ++i) {
    CurveSample sample;
    sample.displacement = kTravel * i / 6;
    sample.force = normal.samples.back().force + Vec3{40 * scale * sample.displacement, 0, 0};
    lateral.samples.push_back(sample);
  }
  site.paths = {normal, lateral};
  return site;
}

inline Curves press_all(const Body& body, const std::vector<std::int32_t>& vertices,
                        const Field& field) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  curves.depth = kDepth;
  curves.lateral_travel = kTravel;
  for (const std::int32_t vertex : vertices) curves.sites.push_back(press(body, vertex, field));
  return curves;
}

inline FitSettings interpolating() {
  FitSettings settings;
  settings.relative_tolerance = 3e-3;
  settings.absolute_tolerance = 1e-4;
  settings.interpolate = true;
  return settings;
}

inline double deepest_force(const Library& library, std::size_t vertex) {
  return runtime::CompiledCurve(library.responses[vertex].normal).force(kDepth);
}

inline double law(double scale) {
  return 500 * scale * std::pow(kDepth, 1.5);
}

}  // namespace palpate::fitting
