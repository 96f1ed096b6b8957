// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/slab_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "format/error.hpp"
#include "format/numbers.hpp"

namespace palpate::app {
namespace {

constexpr double kFarModulus = 1e3;  ///< from its start, to either side

// Indices of the constants, and the number of those that all sites share.
constexpr std::size_t kStiffening = 0, kInverseThickness = 1, kShared = 2;

class SlabModel : public PressModel {
 public:
  SlabModel(const SlabTable& table, const Curves& measured) : table_(table) {
    for (const SiteCurves& site : measured.sites)
      for (const CurvePath& path : site.paths)
        if (path.kind == PathKind::Normal && path.samples.size() >= 3)
          deepest_.emplace(site.vertex, std::pair(path.samples.back().displacement,
                                                  dot(path.samples.back().force, path.direction)));
  }

  std::vector<calibrate::Constant> constants(const PressPlan& plan) const override {
    const SlabTableSettings& s = table_.settings();
    const double low = 1 / s.thickness_high, high = 1 / s.thickness_low;
    std::vector<calibrate::Constant> constants{
        {s.law.stiffening, "1", 0.5 * (s.law.low + s.law.high), s.law.low, s.law.high},
        {"inverse thickness", "1/m", 0.5 * (low + high), low, high}};
    for (const std::int32_t vertex : plan.vertices) {
      const double start = modulus_start(plan, vertex, constants[0].start, constants[1].start);
      constants.push_back({fmt::format("shear modulus of site {}", vertex), "Pa", start,
                           start / kFarModulus, start * kFarModulus, /*may_vanish=*/false,
                           /*logarithm=*/false, /*linear=*/true});
    }
    return constants;
  }

  std::size_t profiled(const PressPlan&) const override { return kShared; }

  /// A thin soft slab and a thick stiff one may fit alike: all corners are tried.
  std::vector<std::vector<double>> starts(const PressPlan& plan) const override {
    const std::vector<calibrate::Constant> middle = constants(plan);
    std::vector<std::vector<double>> starts;
    for (const double c : {0.2, 0.8})
      for (const double s : {0.2, 0.8}) {
        std::vector<double> start{middle[0].low + c * (middle[0].high - middle[0].low),
                                  middle[1].low + s * (middle[1].high - middle[1].low)};
        for (const std::int32_t vertex : plan.vertices)
          start.push_back(modulus_start(plan, vertex, start[0], start[1]));
        starts.push_back(std::move(start));
      }
    return starts;
  }

  bool forces(const PressPlan& plan, const std::vector<double>& at,
              std::vector<fem::SiteSensitivity>& sites, std::string&) override {
    std::vector<SlabTable::Force> unit;
    for (std::size_t d = 0; d < plan.depths.size(); ++d)
      unit.push_back(table_.at(d, at[kStiffening], at[kInverseThickness]));
    sites.resize(plan.vertices.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      sites[i].vertex = plan.vertices[i];
      sites[i].samples.resize(unit.size());
      const double modulus = at[kShared + i];
      for (std::size_t d = 0; d < unit.size(); ++d) {
        fem::ForceSensitivity& sample = sites[i].samples[d];
        sample.depth = plan.depths[d];
        sample.force = modulus * unit[d].value;
        sample.slope.assign(at.size(), 0.0);
        sample.slope[kStiffening] = modulus * unit[d].by_stiffening;
        sample.slope[kInverseThickness] = modulus * unit[d].by_inverse_thickness;
        sample.slope[kShared + i] = unit[d].value;
      }
    }
    return true;
  }

 private:
  /// From the deepest sample of the site, by Hertz's power between the depths of the table.
  double modulus_start(const PressPlan& plan, std::int32_t vertex, double stiffening,
                       double inverse_thickness) const {
    const auto [depth, force] = deepest_.at(vertex);
    const double of_table = table_.at(plan.depths.size() - 1, stiffening, inverse_thickness).value *
                            std::pow(depth / plan.depths.back(), 1.5);
    return std::max(force, 1e-12) / of_table;
  }

  const SlabTable& table_;
  std::map<std::int32_t, std::pair<double, double>> deepest_;  ///< m and N, by vertex
};

/// An end at the bound is none: the range of the table ends there, not the profile.
Identified identified(const calibrate::Estimate& e, double low, double high) {
  const double near = 1e-9 * (high - low);
  Identified result{e.value, e.profile_low, e.profile_high, false, false};
  result.no_low = !(result.low > low + near);
  result.no_high = !(result.high < high - near);
  if (result.no_low) result.low = low;
  if (result.no_high) result.high = high;
  return result;
}

/// The median of what is known; unknown where nothing is, as the correlation with a constant at its
/// bound.
double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return kUnknown;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

std::vector<double> compared_depths(const Curves& measured, int depths) {
  double deepest = 0;
  for (const SiteCurves& site : measured.sites)
    for (const CurvePath& path : site.paths)
      if (path.kind == PathKind::Normal && path.samples.size() >= 3)
        deepest = std::max(deepest, path.samples.back().displacement);
  if (!(deepest > 0))
    refuse("measured curves", "they hold no normal path", "import presses of a slab");
  std::vector<double> at;
  for (int i = 1; i <= depths; ++i) at.push_back(deepest * i / depths);
  return at;
}

SlabFit fit_slab(const Curves& measured, const SlabTable& table, const PressFitSettings& settings) {
  SlabModel model(table, measured);
  PressFitSettings own = settings;
  own.depths = static_cast<int>(table.settings().depths.size());
  own.profiles = Profiles::All;
  own.profile = {.of = {}, .closeness = 1e-3, .between = 4, .at_bounds = true};
  SlabFit result;
  result.fit = fit_presses({&measured, 1}, model, own, "calibration of a slab");
  const calibrate::Calibration& found = result.fit.calibration;
  const SlabTableSettings& s = table.settings();
  result.stiffening = identified(found.estimates[kStiffening], s.law.low, s.law.high);
  const Identified inverse =
      identified(found.estimates[kInverseThickness], 1 / s.thickness_high, 1 / s.thickness_low);
  result.thickness = {1 / inverse.value, 1 / inverse.high, 1 / inverse.low, inverse.no_high,
                      inverse.no_low};
  std::vector<double> moduli, by_thickness, by_stiffening;
  for (std::size_t i = 0; i < result.fit.paths.size(); ++i) {
    moduli.push_back(found.estimates[kShared + i].value);
    by_thickness.push_back(found.correlation[kShared + i][kInverseThickness]);
    by_stiffening.push_back(found.correlation[kShared + i][kStiffening]);
  }
  result.median_modulus = median(moduli);
  result.least_modulus = *std::min_element(moduli.begin(), moduli.end());
  result.largest_modulus = *std::max_element(moduli.begin(), moduli.end());
  result.modulus_thickness = median(by_thickness);
  result.modulus_stiffening = median(by_stiffening);
  return result;
}

Curves fitted_curves(const Curves& measured, const PressFit& fit) {
  Curves curves;
  curves.tool = measured.tool;
  curves.body_sha256 = measured.body_sha256;
  curves.provenance = measured.provenance;
  std::map<std::int32_t, Vec3> direction;
  for (const SiteCurves& site : measured.sites)
    for (const CurvePath& path : site.paths)
      if (path.kind == PathKind::Normal) direction.emplace(site.vertex, path.direction);
  for (const FittedPath& fitted : fit.paths) {
    if (fitted.kind != PathKind::Normal) continue;
    CurvePath path;
    path.direction = direction.at(fitted.vertex);
    path.samples.emplace_back();
    for (std::size_t i = 0; i < fitted.depth.size(); ++i) {
      CurveSample& sample = path.samples.emplace_back();
      sample.displacement = fitted.depth[i];
      sample.force = fitted.fitted[i] * path.direction;
    }
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
      CurveSample& sample = path.samples[i];
      sample.strain_energy = sample.min_jacobian = sample.penetration = sample.contact_area =
          kUnknown;
      if (i == 0) continue;
      const CurveSample& before = path.samples[i - 1];
      sample.tool_work = before.tool_work + 0.5 * dot(before.force + sample.force, path.direction) *
                                                (sample.displacement - before.displacement);
    }
    curves.depth = std::max(curves.depth, path.samples.back().displacement);
    curves.sites.push_back({fitted.vertex, SiteStatus::Complete, "", 0, {path}});
  }
  return curves;
}

}  // namespace palpate::app
