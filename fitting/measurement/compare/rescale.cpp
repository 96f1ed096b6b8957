// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/compare/rescale.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"

namespace palpate::compare {
namespace {

SiteScale scale_of(const CurveComparison& curve) {
  double mm = 0, mr = 0, largest = 0;
  for (const ComparedPoint& p : curve.points) {
    mm += p.model * p.model;
    mr += p.model * p.reference;
    largest = std::max(largest, std::abs(p.reference));
  }
  SiteScale scale;
  scale.vertex = curve.vertex;
  scale.factor = mr / mm;
  double squares = 0;
  for (const ComparedPoint& p : curve.points) {
    const double e = p.reference - scale.factor * p.model;
    squares += e * e;
  }
  const auto n = static_cast<double>(curve.points.size());
  scale.misfit = std::sqrt(squares / n) / largest;
  scale.uncertainty = std::sqrt(squares / std::max(1.0, n - 1) / mm);
  return scale;
}

void multiply(Curves& curves, double factor) {
  for (SiteCurves& site : curves.sites) {
    for (CurvePath& path : site.paths) {
      for (CurveSample& sample : path.samples) {
        sample.force = factor * sample.force;
        sample.strain_energy *= factor;
        for (double& energy : sample.isochoric_energy) energy *= factor;
        sample.tool_work *= factor;
        sample.contact_energy *= factor;
        sample.tension *= factor;
      }
    }
  }
}

}  // namespace

Rescaling rescale(const Curves& simulated, const Curves& measured,
                  const CompareSettings& settings) {
  const Comparison comparison = compare(set_of(measured, "the measured curves"),
                                        set_of(simulated, "the simulated curves"), settings);
  Rescaling result;
  std::vector<double> factors;
  double stated = 0;
  for (const CurveComparison& curve : comparison.curves) {
    if (curve.kind != PathKind::Normal) continue;
    result.sites.push_back(scale_of(curve));
    const SiteScale& site = result.sites.back();
    if (!(site.factor > 0)) {
      throw Error(ErrorKind::Configuration, "site " + std::to_string(site.vertex),
                  "its measured force opposes the simulated one", "check the measurement");
    }
    factors.push_back(site.factor);
    stated += site.uncertainty * site.uncertainty;
  }
  if (factors.empty()) {
    throw Error(ErrorKind::Configuration, "the measured curves", "no normal path is common",
                "measure presses at sites of the campaign");
  }
  const auto n = static_cast<double>(factors.size());
  result.factor = measured::mean(factors);
  result.uncertainty = std::max(std::sqrt(stated) / n, measured::deviation(factors) / std::sqrt(n));
  result.curves = simulated;
  multiply(result.curves, result.factor);
  return result;
}

}  // namespace palpate::compare
