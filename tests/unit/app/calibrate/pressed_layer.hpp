// SPDX-License-Identifier: AGPL-3.0-or-later
// A layer whose forces are a formula, and curves that a robot would have measured on it.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "app/calibrate/slab_fit.hpp"

namespace palpate::app::samples {

inline constexpr double kRadius = 0.004;

/// An incompressible layer on its base [Dimitriadis et al. 2002, eq. 13], times a stiffening: N per
/// Pa of the shear modulus.
inline double layer_force(double depth, double stiffening, double thickness) {
  const double chi = std::sqrt(kRadius * depth) / thickness;
  const double bonded =
      1 + 1.133 * chi + 1.283 * chi * chi + 0.769 * std::pow(chi, 3) + 0.0975 * std::pow(chi, 4);
  return 16.0 / 3.0 * std::sqrt(kRadius) * std::pow(depth, 1.5) * bonded *
         std::exp(stiffening * depth / kRadius);
}

inline SlabTableSettings table_settings() {
  SlabTableSettings settings;
  settings.law = {"demiray-fung", "b", 0, 4};
  settings.tool.radius = kRadius;
  for (int i = 1; i <= 10; ++i) settings.depths.push_back(0.0003 * i);
  settings.thickness_low = 0.005;
  settings.thickness_high = 0.06;
  return settings;
}

inline SlabTable layer_table() {
  const SlabTableSettings settings = table_settings();
  return {settings, [&settings](double stiffening, double thickness) {
            std::vector<double> force;
            for (const double depth : settings.depths)
              force.push_back(layer_force(depth, stiffening, thickness));
            return force;
          }};
}

/// Presses of sites of several moduli, with noise of a known deviation over the force.
inline Curves pressed_sites(double stiffening, double thickness, double noise, unsigned seed,
                            int sites = 8) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Curves curves;
  curves.tool = {"sphere", kRadius, "frictionless"};
  for (int site = 0; site < sites; ++site) {
    CurvePath path;
    path.direction = {0, 0, -1};
    path.repeats = 1;
    path.samples.emplace_back();
    path.samples.back().force_uncertainty = 0;
    for (const double depth : table_settings().depths) {
      CurveSample& sample = path.samples.emplace_back();
      const double force = 400 * (1 + 0.2 * site) * layer_force(depth, stiffening, thickness);
      sample.displacement = depth;
      sample.force = (force + noise * normal(random)) * path.direction;
      sample.force_uncertainty = noise;
    }
    curves.sites.push_back({site, SiteStatus::Complete, "", 0, {path}});
  }
  return curves;
}

}  // namespace palpate::app::samples
