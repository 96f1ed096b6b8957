// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/slab.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/campaign/indentation.hpp"
#include "fem/specimen/grid_body.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::fem {

namespace {

constexpr int kSlabSectors = 12;  ///< of the whole slab
/// Cells under the tool, over its radius; they grow outside.
constexpr double kFine = 0.12, kFineDeep = 0.15, kSlabGrowth = 1.4;
/// Half the width of the slab: so many radii and thicknesses.
constexpr double kRadii = 8, kThicknesses = 2;
/// Stiffness of the planes of symmetry, over the shear modulus and the radius.
constexpr double kSlabPlanes = 1e5;

void check(const SlabPress& press) {
  const std::string where = "press of a slab";
  if (press.tool.shape != ToolShape::Sphere)
    refuse(where, "the tool is no sphere", "slabs are pressed by spheres");
  if (press.depths.empty() || !std::is_sorted(press.depths.begin(), press.depths.end()) ||
      !(press.depths.front() > 0))
    refuse(where, "the depths do not ascend from above 0", "give ascending depths");
  if (!(press.depths.back() < press.thickness))
    refuse(where,
           "a slab of " + length_text(press.thickness) + " is pressed by " +
               length_text(press.depths.back()),
           "press less than the thickness");
}

Body sector(const SlabPress& press, double shear_modulus) {
  const double R = press.tool.radius, H = press.thickness,
               angle = 2 * std::numbers::pi / kSlabSectors;
  const double deepest = press.depths.back();
  const double contact = std::sqrt(deepest * std::max(2 * R - deepest, R));
  const double border = kRadii * R + kThicknesses * H;
  CellGrid grid{graded_cells(border, 1.3 * contact, kFine * contact, kSlabGrowth),
                {0, angle},
                graded_cells(H, contact, kFineDeep * contact, kSlabGrowth)};
  // From the base up, with the fine cells at the surface.
  std::reverse(grid.third.begin(), grid.third.end());
  for (double& z : grid.third) z = H - z;
  Body body = grid_body(grid, [](const Vec3& x) {
    return Vec3{x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]};
  });
  const double near = 1e-9 * border;
  fix_where(body, [&](const Vec3& x) { return x[2] < near; });
  const double stiffness = kSlabPlanes * shear_modulus / R;
  slide_where(
      body, [&](const Vec3& x) { return x[1] < near; }, stiffness);
  slide_where(
      body,
      [&](const Vec3& x) {
        return std::abs(x[0] * std::sin(angle) - x[1] * std::cos(angle)) < near;
      },
      stiffness);
  return body;
}

bool is_among(double depth, const std::vector<double>& depths) {
  return std::any_of(depths.begin(), depths.end(),
                     [&](double d) { return std::abs(d - depth) < 1e-9 * d; });
}

}  // namespace

SlabForces press_slab(const SlabPress& press) {
  check(press);
  check_law(press.law, "law of the slab");
  const Body body = sector(press, rest_moduli(press.law).mu());
  CampaignSettings settings;
  settings.materials = {{body.region_names.front(), press.law}};
  settings.indentation.tool = press.tool;
  settings.indentation.friction = press.friction;
  settings.points = {{{0, 0, press.thickness}, {0, 0, -1}}};
  settings.indentation.depth = press.depths.back();
  settings.indentation.increments = 1;
  settings.indentation.lateral_depths = press.depths;  // the depths that the path passes
  settings.indentation.azimuths.clear();               // no lateral paths
  // The stiff springs of the planes make every other solver slow, and the factor is small.
  const CampaignContext context(body, settings, Engine::Direct);
  const SiteCurves curves = solve_site(context, 0, nullptr);
  SlabForces forces;
  forces.reason = curves.reason;
  for (const CurveSample& sample : curves.paths.front().samples)
    if (is_among(sample.displacement, press.depths))
      forces.force.push_back(-kSlabSectors * sample.force[2]);
  return forces;
}

}  // namespace palpate::fem
