// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/compare/rescale.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/measurement/records/statistics.hpp"
#include "fitting/measurement/relaxation/hereditary.hpp"
#include "fitting/response/relaxation_fraction.hpp"
#include "format/error.hpp"

namespace palpate::compare {
namespace {

struct ForcePair {
  double model, measured;  ///< N
};

/// The least squares factor of measured = factor * model, through the origin.
SiteScale scale_of(std::int32_t vertex, const std::vector<ForcePair>& pairs) {
  double mm = 0, mr = 0, largest = 0;
  for (const ForcePair& p : pairs) {
    mm += p.model * p.model;
    mr += p.model * p.measured;
    largest = std::max(largest, std::abs(p.measured));
  }
  SiteScale scale;
  scale.vertex = vertex;
  scale.factor = mr / mm;
  double squares = 0;
  for (const ForcePair& p : pairs) {
    const double e = p.measured - scale.factor * p.model;
    squares += e * e;
  }
  const auto n = static_cast<double>(pairs.size());
  scale.misfit = std::sqrt(squares / n) / largest;
  scale.uncertainty = std::sqrt(squares / std::max(1.0, n - 1) / mm);
  if (!(scale.factor > 0)) {
    throw Error(ErrorKind::Configuration, "site " + std::to_string(vertex),
                "its measured force opposes the simulated one", "check the measurement");
  }
  return scale;
}

SiteScale scale_of(const CurveComparison& curve) {
  std::vector<ForcePair> pairs;
  for (const ComparedPoint& p : curve.points) pairs.push_back({p.model, p.reference});
  return scale_of(curve.vertex, pairs);
}

/// The simulated press of a site: force by depth, and how it relaxes.
struct RelaxingCurve {
  MonotoneCubic force;
  double deepest;  ///< m
  calibrate::PronySeries<double> series;
};

const ComparedCurve* press_at(const ComparedSet& set, std::int32_t vertex) {
  for (const ComparedSite& site : set.sites) {
    if (site.vertex != vertex) continue;
    for (const ComparedCurve& curve : site.curves)
      if (curve.kind == PathKind::Normal) return &curve;
  }
  return nullptr;
}

RelaxingCurve relaxing_curve(const Curves& simulated, const ComparedSet& set,
                             const measured::SiteHistory& record) {
  const ComparedCurve* press = press_at(set, record.vertex);
  if (press == nullptr) {
    throw Error(ErrorKind::Configuration, record.history.name,
                "the campaign has no press at its vertex " + std::to_string(record.vertex),
                "give the record the vertex or site of a simulated press");
  }
  RelaxingCurve curve{{press->displacement, press->force}, press->displacement.back(), {}};
  if (simulated.relaxation.empty()) return curve;
  const auto site = std::find_if(simulated.sites.begin(), simulated.sites.end(),
                                 [&](const SiteCurves& s) { return s.vertex == record.vertex; });
  const std::vector<float> fractions = fitting::relaxation_fractions(*site, simulated.relaxation);
  curve.series.fraction.assign(fractions.begin(), fractions.end());
  curve.series.time = simulated.relaxation.times_s;
  return curve;
}

/// Times and depths of the record with points between the samples where the tool moves, so that the
/// force is nearly linear from one to the next.
struct Motion {
  std::vector<double> time, depth;  ///< s; m, 0 out of contact
  std::vector<std::size_t> sample;  ///< of each sample of the record, among these
};

Motion motion_of(const measured::History& history, double deepest) {
  constexpr double kPart = 0.01;  // of the deepest simulated sample
  Motion motion;
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    const double t = history.time[i], x = std::max(0.0, history.travel[i]);
    if (i > 0) {
      const double t0 = history.time[i - 1], x0 = motion.depth.back();
      const int parts = static_cast<int>(std::ceil(std::abs(x - x0) / (kPart * deepest)));
      for (int k = 1; k < parts; ++k) {
        motion.time.push_back(t0 + (t - t0) * k / parts);
        motion.depth.push_back(x0 + (x - x0) * k / parts);
      }
    }
    motion.sample.push_back(motion.time.size());
    motion.time.push_back(t);
    motion.depth.push_back(x);
  }
  return motion;
}

SiteScale scale_of(const RelaxingCurve& curve, const measured::SiteHistory& record) {
  const Motion motion = motion_of(record.history, curve.deepest);
  std::vector<double> elastic;
  for (const double x : motion.depth)
    elastic.push_back(curve.force.value(std::min(x, curve.deepest)));
  const std::vector<double> force = calibrate::hereditary_force(motion.time, elastic, curve.series);
  std::vector<ForcePair> pairs;
  for (std::size_t i = 0; i < motion.sample.size(); ++i) {
    const double depth = motion.depth[motion.sample[i]];
    // What has been deeper is remembered: the record ends with the first sample beyond.
    if (depth > curve.deepest) break;
    if (depth > 0)
      pairs.push_back({std::max(0.0, force[motion.sample[i]]), record.history.force[i]});
  }
  if (pairs.size() < 2) {
    throw Error(ErrorKind::Configuration, record.history.name,
                "fewer than two of its samples are in contact and no deeper than the campaign",
                "compute the campaign deeper, or record more samples");
  }
  return scale_of(record.vertex, pairs);
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
        sample.mesh_difference *= factor;
        sample.mesh_error *= factor;
      }
    }
  }
}

/// The mean of the factors, each site alike, and all curves times it.
Rescaling scaled(const Curves& simulated, std::vector<SiteScale> sites) {
  std::vector<double> factors;
  double stated = 0;
  for (const SiteScale& site : sites) {
    factors.push_back(site.factor);
    stated += site.uncertainty * site.uncertainty;
  }
  const auto n = static_cast<double>(factors.size());
  Rescaling result;
  result.factor = measured::mean(factors);
  result.uncertainty = std::max(std::sqrt(stated) / n, measured::deviation(factors) / std::sqrt(n));
  result.sites = std::move(sites);
  result.curves = simulated;
  multiply(result.curves, result.factor);
  return result;
}

}  // namespace

Rescaling rescale(const Curves& simulated, const Curves& measured,
                  const CompareSettings& settings) {
  const Comparison comparison = compare(set_of(measured, "the measured curves"),
                                        set_of(simulated, "the simulated curves"), settings);
  std::vector<SiteScale> sites;
  for (const CurveComparison& curve : comparison.curves)
    if (curve.kind == PathKind::Normal) sites.push_back(scale_of(curve));
  if (sites.empty()) {
    throw Error(ErrorKind::Configuration, "the measured curves", "no normal path is common",
                "measure presses at sites of the campaign");
  }
  return scaled(simulated, std::move(sites));
}

Rescaling rescale_over_time(const Curves& simulated,
                            const std::vector<measured::SiteHistory>& records) {
  const ComparedSet set = set_of(simulated, "the simulated curves");
  std::vector<SiteScale> sites;
  for (const measured::SiteHistory& record : records)
    sites.push_back(scale_of(relaxing_curve(simulated, set, record), record));
  if (sites.empty()) {
    throw Error(ErrorKind::Configuration, "the measured records", "there is none",
                "list records as [[history]] in the sidecar");
  }
  return scaled(simulated, std::move(sites));
}

}  // namespace palpate::compare
