// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/relaxation_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "format/error.hpp"

namespace palpate::fitting {
namespace {

const CurvePath& normal_path(const SiteCurves& site) {
  const auto path = std::find_if(site.paths.begin(), site.paths.end(),
                                 [](const CurvePath& p) { return p.kind == PathKind::Normal; });
  if (path == site.paths.end() || path->samples.empty())
    throw Error(ErrorKind::Internal, "site at vertex " + std::to_string(site.vertex),
                "no normal path", "fit usable sites only");
  return *path;
}

std::vector<double> fractions_at(const CurveSample& sample, const RegionRelaxation& relaxation,
                                 std::int32_t vertex) {
  if (sample.isochoric_energy.size() != relaxation.fractions.size())
    refuse("site at vertex " + std::to_string(vertex),
           "a sample lacks the strain energy of the regions, which relaxation needs",
           "compute the site again: palpate precompute");
  std::vector<double> fractions(relaxation.times_s.size());
  if (!(sample.strain_energy > 0)) return fractions;
  for (std::size_t r = 0; r < relaxation.fractions.size(); ++r)
    for (std::size_t i = 0; i < fractions.size(); ++i)
      fractions[i] +=
          relaxation.fractions[r][i] * sample.isochoric_energy[r] / sample.strain_energy;
  return fractions;
}

}  // namespace

std::vector<float> relaxation_fractions(const SiteCurves& site,
                                        const RegionRelaxation& relaxation) {
  const std::vector<double> fractions =
      fractions_at(normal_path(site).samples.back(), relaxation, site.vertex);
  return {fractions.begin(), fractions.end()};
}

double largest_fraction_error(const SiteCurves& site, const RegionRelaxation& relaxation) {
  const std::vector<CurveSample>& samples = normal_path(site).samples;
  const std::vector<double> chosen = fractions_at(samples.back(), relaxation, site.vertex);
  double largest = 0;
  for (const CurveSample& sample : samples) {
    const std::vector<double> here = fractions_at(sample, relaxation, site.vertex);
    double difference = 0;
    for (std::size_t i = 0; i < here.size(); ++i) difference += here[i] - chosen[i];
    const double weight = sample.strain_energy / samples.back().strain_energy;
    if (weight > 0) largest = std::max(largest, weight * std::abs(difference));
  }
  return largest;
}

}  // namespace palpate::fitting
