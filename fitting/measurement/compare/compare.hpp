// SPDX-License-Identifier: AGPL-3.0-or-later
// Two sets of responses at the same sites, curve by curve: simulated against measured, a library
// against either, or two libraries. Figures and their definitions: docs/measured.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/numbers.hpp"

namespace palpate::compare {

/// One curve: force along its path over displacement, with its uncertainty where that is known.
struct ComparedCurve {
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;               ///< m, lateral only
  Vec3 direction{};                       ///< lateral only
  std::vector<double> displacement;       ///< m, ascending
  std::vector<double> force;              ///< N
  std::vector<double> uncertainty;        ///< N, standard; NaN where unknown
  std::vector<double> scatter;            ///< N, between repeats; NaN where unknown
  double contact_uncertainty = kUnknown;  ///< m
};

/// A vertex of a library, whose curve along any path is the one that is rendered there.
struct RenderedVertex {
  NodeResponse response;
  ResponseKind kind = ResponseKind::Decoupled;
  int steps = 0;  ///< of a curve
};

/// One site of a set.
struct ComparedSite {
  std::int32_t vertex = -1;
  Vec3 position{kUnknown, kUnknown, kUnknown};  ///< m, where known
  std::vector<ComparedCurve> curves;
  std::optional<RenderedVertex> rendered{};  ///< of a library
};

struct ComparedSet {
  std::string name;
  std::string body_sha256;  ///< empty when unknown
  std::vector<ComparedSite> sites;
  std::string tool_shape;         ///< empty when unknown
  double tool_radius = kUnknown;  ///< m
  std::string tool_friction;      ///< empty when unknown
};

/// The curves of a campaign or of a measurement; of a lateral path the force less that at its
/// start.
ComparedSet set_of(const Curves& curves, std::string name);
/// What a library renders, on `steps` even steps up to the last knot: along the paths of what it is
/// compared with; along a straight press and a drag at its deepest point where that is a library
/// too. Holes are left out.
ComparedSet set_of(const Library& library, std::string name, int steps = 48);

struct CompareSettings {
  double jnd = 0.07;         ///< just noticeable relative difference of force [Pang et al. 1991]
  double jnd_floor = 0.005;  ///< N, least noticeable difference near zero force
  double confidence = 0.95;  ///< of the limits of agreement and of "within the uncertainty"
  double site_tolerance = 0.002;      ///< m, sites of different bodies are one within it
  double depth_tolerance = 0.1;       ///< relative, of lateral depths
  double direction_tolerance = 0.26;  ///< rad, of lateral directions
  std::vector<double> depths;  ///< m, where the stiffness is compared; empty: thirds of the range
};

/// The floor of the just noticeable difference, N: 5 mN, or `jnd` times the largest force of the
/// reference where that is less, since the forces of a small body are felt enlarged.
double jnd_floor_of(const ComparedSet& reference, double jnd);

/// Sites of different bodies are one within this distance, m: 2 mm, or twice the radius of the tool
/// where that is known and less.
double site_tolerance_of(const ComparedSet& reference);

/// Force and difference at one displacement of the reference.
struct ComparedPoint {
  double displacement = 0;          ///< m
  double reference = 0, model = 0;  ///< N
  double uncertainty = kUnknown,
         scatter = kUnknown;  ///< N, standard, joint of both; of the reference
  double jnd = 0;             ///< difference in just noticeable differences
};

struct StiffnessAt {
  double displacement = 0;          ///< m
  double reference = 0, model = 0;  ///< N/m, slope of the force
};

/// One curve against another.
struct CurveComparison {
  std::int32_t vertex = -1;  ///< of the reference
  std::int32_t model_vertex = -1;
  double distance = 0;  ///< m, between the two sites
  Vec3 position{kUnknown, kUnknown, kUnknown};
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;
  double range = 0;  ///< m, common to both
  std::vector<ComparedPoint> points;
  double rmse = 0;             ///< N
  double normalised_rmse = 0;  ///< over the largest reference force
  double r2 = 0;               ///< 1 - residual over total sum of squares of the reference
  double bias = 0;             ///< N, mean of model less reference
  ComparedPoint worst;
  double jnd_rms = 0;                    ///< root mean square, in just noticeable differences
  double noticeable = 0;                 ///< fraction of points beyond one of them
  double within_uncertainty = kUnknown;  ///< fraction of points within the confidence interval
  double mean_scatter = kUnknown;        ///< N, root mean square scatter of the reference
  double mean_uncertainty = kUnknown;    ///< N
  double energy_reference = 0, energy_model = 0;  ///< J, integral over the range
  std::vector<StiffnessAt> stiffness;
};

/// Over all points of one kind of path.
struct Summary {
  PathKind kind = PathKind::Normal;
  std::size_t curves = 0, points = 0;
  double rmse = 0, normalised_rmse = 0, bias = 0;
  double agreement_low = 0, agreement_high = 0;  ///< N, bias -+ 1.96 standard deviations
                                                 ///< [Bland & Altman 1986]
  double jnd_rms = 0, noticeable = 0;
  double within_uncertainty = kUnknown;
  double mean_scatter = kUnknown;
  std::int32_t worst_vertex = -1;
  ComparedPoint worst;
};

struct Comparison {
  std::string reference, model;
  std::vector<CurveComparison> curves;
  std::vector<Summary> summaries;      ///< normal, then lateral, where there are curves
  std::vector<std::string> unmatched;  ///< what has no partner, one line each
};

/// Model against reference at the displacements of the reference, up to the range both have; the
/// model is interpolated by a monotone cubic between its samples [Fritsch & Carlson 1980].
/// Sites are matched by vertex when both refer to one body, by position otherwise.
/// The uncertainty of a difference joins those of both curves where known, and the uncertainty of
/// the contact point times the stiffness of the other.
/// @throws Error(Configuration) when no curve has a partner; for tools of different shapes, or of
///   radii that differ by more than 1 % (by which the force of a sphere differs by 0.5 %).
Comparison compare(const ComparedSet& reference, const ComparedSet& model,
                   const CompareSettings& settings);

/// Monotone cubic through samples, the first at the origin; constant slope beyond. Exposed for its
/// tests.
class MonotoneCubic {
 public:
  MonotoneCubic(std::vector<double> x, std::vector<double> y);
  double value(double x) const;
  double slope(double x) const;
  double integral(double end) const;  ///< from the first sample

 private:
  std::size_t piece(double x) const;
  std::vector<double> x_, y_, m_;
};

}  // namespace palpate::compare
