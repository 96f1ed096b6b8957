// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/round_cap.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "format/to_index.hpp"
#include "tests/support/prism_body.hpp"

namespace palpate::test {

namespace {

Vec3 unit(const Vec3& x) {
  return (1 / norm(x)) * x;
}

/// Where the tool is pressed.
std::vector<fem::PressPoint> points(const RoundCap& cap, const Body& body, double near) {
  const bool curved = !body.curved_edges.empty();
  std::vector<fem::PressPoint> points;
  for (const Triangle& facet : body.boundary) {
    std::array<Vec3, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = body.nodes[to_index(facet[c])];
    const Vec3 centroid = (1.0 / 3) * (x[0] + x[1] + x[2]);
    if (norm(centroid - Vec3{0, 0, cap.radius}) > near) continue;
    for (const Vec3& flat : {x[0], 0.5 * (x[0] + x[1]), centroid})
      points.push_back({curved ? cap.radius * unit(flat) : flat, -1 * unit(flat)});
  }
  return points;
}

}  // namespace

Body cap_of(const RoundCap& cap, const std::vector<double>& angles, int sectors,
            const std::vector<double>& depths) {
  const int layers = static_cast<int>(depths.size()) - 1;
  const Triangulation base = rings(angles, sectors);
  Body body = make_prisms(base, layers, [&](const Vec3& x, int layer) {
    const double angle = norm(x), r = cap.radius - depths[to_index(layer)];
    const double across = angle > 0 ? r * std::sin(angle) / angle : 0;
    return Vec3{across * x[0], across * x[1], r * std::cos(angle)};
  });
  const auto inside = static_cast<std::int32_t>(base.points.size());
  for (std::int32_t i = 0; i < inside; ++i) body.fixed_nodes.push_back(i);
  return body;
}

Body even_cap(const RoundCap& cap, double size) {
  std::vector<double> angles, depths;
  const int count = static_cast<int>(std::ceil(cap.radius * cap.half_angle / size));
  for (int i = 1; i <= count; ++i) angles.push_back(cap.half_angle * i / count);
  const int layers = static_cast<int>(std::ceil(cap.thickness / size));
  for (int i = layers; i >= 0; --i) depths.push_back(cap.thickness * i / layers);
  return cap_of(cap, angles, count, depths);
}

Body curved_cap(double size) {
  const RoundCap cap;
  Body body = even_cap(cap, size);
  curve_onto_sphere(cap.radius, body);
  std::int32_t pole = 0;
  for (std::size_t v = 0; v < body.nodes.size(); ++v)
    if (body.nodes[v][2] > body.nodes[to_index(pole)][2]) pole = static_cast<std::int32_t>(v);
  body.response.node = {pole};
  body.response.inward = {{0, 0, -1}};
  body.response.is_site = {1};
  return body;
}

std::vector<Spread> spread_of_force(const RoundCap& cap, const Body& body,
                                    const fem::IndentationSettings& press, double near) {
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {cap.young, cap.poisson}}};
  settings.indentation = press;
  settings.indentation.lateral_depths.clear();
  settings.indentation.lateral_travel = 0;
  settings.threads = 2;
  settings.points = points(cap, body, near);
  fem::CampaignReport report;
  const Curves curves = fem::run_campaign(body, settings, report);
  std::vector<Spread> spread(to_index(press.increments));
  const auto count = static_cast<double>(curves.sites.size());
  for (std::size_t i = 0; i < spread.size(); ++i) {
    double sum = 0, squares = 0;
    for (const SiteCurves& site : curves.sites) {
      if (site.status != SiteStatus::Complete) throw std::runtime_error(site.reason);
      const double force = -dot(site.paths[0].samples[i + 1].force,
                                unit(settings.points[to_index(site.vertex)].position));
      sum += force;
      squares += force * force;
    }
    spread[i] = {sum / count, std::sqrt(squares * count / (sum * sum) - 1)};
  }
  return spread;
}

}  // namespace palpate::test
