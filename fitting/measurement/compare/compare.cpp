// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/compare/compare.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"
#include "fitting/response/leaning_response.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/tangent_frame.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::compare {
namespace {

std::string path_name(PathKind kind, double lateral_depth) {
  if (kind == PathKind::Normal) return "normal path";
  return "lateral path at " + length_text(lateral_depth);
}

ComparedCurve curve_of(const CurvePath& path) {
  ComparedCurve curve;
  curve.kind = path.kind;
  curve.lateral_depth = path.lateral_depth;
  curve.direction = path.direction;
  curve.contact_uncertainty = path.contact_uncertainty;
  const Vec3 start = path.kind == PathKind::Lateral ? path.samples.front().force : Vec3{};
  for (const CurveSample& sample : path.samples) {
    if (!curve.displacement.empty() && sample.displacement <= curve.displacement.back()) continue;
    curve.displacement.push_back(sample.displacement);
    curve.force.push_back(dot(sample.force - start, path.direction));
    curve.uncertainty.push_back(sample.force_uncertainty);
    curve.scatter.push_back(sample.force_scatter);
  }
  return curve;
}

/// Along the path of another curve.
ComparedCurve curve_along(const ComparedCurve& path, const RenderedVertex& vertex) {
  ComparedCurve curve;
  curve.kind = path.kind;
  curve.lateral_depth = path.lateral_depth;
  curve.direction = path.direction;
  const bool normal = path.kind == PathKind::Normal;
  const NodeResponse& node = vertex.response;
  const runtime::CompiledCurve g(node.normal);
  const fitting::LeaningResponse leaning(node, vertex.kind);
  const double end = (normal ? node.normal : node.lateral).knot.back();
  for (int i = 0; i <= vertex.steps; ++i) {
    const double d = end * i / vertex.steps;
    curve.displacement.push_back(d);
    curve.force.push_back(normal ? g.force(d) + leaning.normal_force(d)
                                 : leaning.drag_force(path.lateral_depth, d, path.direction));
    curve.uncertainty.push_back(kUnknown);
    curve.scatter.push_back(kUnknown);
  }
  return curve;
}

bool same_path(const ComparedCurve& a, const ComparedCurve& b, const CompareSettings& settings) {
  if (a.kind != b.kind) return false;
  if (a.kind == PathKind::Normal) return true;
  const double deeper = std::max(a.lateral_depth, b.lateral_depth);
  if (std::abs(a.lateral_depth - b.lateral_depth) > settings.depth_tolerance * deeper) return false;
  return dot(a.direction, b.direction) > std::cos(settings.direction_tolerance);
}

/// The curves of a site, of a library on the paths that its partner has.
std::vector<ComparedCurve> curves_beside(const ComparedSite& site, const ComparedSite& other) {
  if (!site.rendered || other.rendered) return site.curves;
  std::vector<ComparedCurve> curves;
  for (const ComparedCurve& path : other.curves)
    curves.push_back(curve_along(path, *site.rendered));
  return curves;
}

/// The first curve of a site along the path of another; nothing where there is none.
std::optional<ComparedCurve> partner_on(const ComparedCurve& path, const ComparedSite& site,
                                        const CompareSettings& settings) {
  if (site.rendered) return curve_along(path, *site.rendered);
  const auto found = std::find_if(
      site.curves.begin(), site.curves.end(),
      [&](const ComparedCurve& candidate) { return same_path(path, candidate, settings); });
  return found == site.curves.end() ? std::nullopt : std::optional(*found);
}

const ComparedSite* partner_of(const ComparedSite& site, const ComparedSet& set, bool by_vertex,
                               double tolerance) {
  const ComparedSite* nearest = nullptr;
  double least = tolerance;
  for (const ComparedSite& other : set.sites) {
    if (by_vertex) {
      if (other.vertex == site.vertex) return &other;
      continue;
    }
    const double distance = norm(other.position - site.position);
    if (!(distance <= least)) continue;  // also false for unknown positions
    least = distance;
    nearest = &other;
  }
  return nearest;
}

/// NaN counts as unknown: it adds nothing, unless all are unknown.
double joint(std::initializer_list<double> parts) {
  double squares = 0;
  bool any = false;
  for (const double part : parts) {
    if (!std::isfinite(part)) continue;
    squares += part * part;
    any = true;
  }
  return any ? std::sqrt(squares) : kUnknown;
}

double interpolated(const ComparedCurve& curve, const std::vector<double>& values, double x) {
  const auto above = std::lower_bound(curve.displacement.begin(), curve.displacement.end(), x);
  if (above == curve.displacement.end()) return values.back();
  const auto i = static_cast<std::size_t>(above - curve.displacement.begin());
  if (i == 0) return values.front();
  const double t =
      (x - curve.displacement[i - 1]) / (curve.displacement[i] - curve.displacement[i - 1]);
  return (1 - t) * values[i - 1] + t * values[i];
}

struct Pair {
  const ComparedCurve& reference;
  const ComparedCurve& model;
  MonotoneCubic reference_curve, model_curve;
  double range;

  Pair(const ComparedCurve& r, const ComparedCurve& m)
      : reference(r),
        model(m),
        reference_curve(r.displacement, r.force),
        model_curve(m.displacement, m.force),
        range(std::min(r.displacement.back(), m.displacement.back())) {}
};

ComparedPoint point_at(const Pair& pair, double x, const CompareSettings& settings) {
  ComparedPoint point;
  point.displacement = x;
  point.reference = pair.reference_curve.value(x);
  point.model = pair.model_curve.value(x);
  // A measured force_uncertainty holds its own contact point; only an uncertain depth of a curve
  // that states no uncertainty of force is added.
  const auto uncertainty_of = [&](const ComparedCurve& curve, const MonotoneCubic& cubic) {
    const double force = interpolated(curve, curve.uncertainty, x);
    return std::isfinite(force) ? force : std::abs(cubic.slope(x)) * curve.contact_uncertainty;
  };
  point.uncertainty = joint({uncertainty_of(pair.reference, pair.reference_curve),
                             uncertainty_of(pair.model, pair.model_curve)});
  point.scatter = interpolated(pair.reference, pair.reference.scatter, x);
  const double noticeable = std::max(settings.jnd * std::abs(point.reference), settings.jnd_floor);
  point.jnd = (point.model - point.reference) / noticeable;
  return point;
}

void add_stiffness(const Pair& pair, const CompareSettings& settings, CurveComparison& out) {
  std::vector<double> depths = settings.depths;
  if (depths.empty()) depths = {pair.range / 3, 2 * pair.range / 3, pair.range};
  for (const double depth : depths) {
    if (depth > pair.range * (1 + 1e-9)) continue;
    out.stiffness.push_back(
        {depth, pair.reference_curve.slope(depth), pair.model_curve.slope(depth)});
  }
}

void add_figures(const CompareSettings& settings, CurveComparison& out) {
  const double q = measured::normal_quantile(settings.confidence);
  const auto n = static_cast<double>(out.points.size());
  double squares = 0, mean = 0, total = 0, largest = 0, jnd = 0, scatter = 0, variance = 0;
  std::size_t noticeable = 0, within = 0, with_uncertainty = 0, with_scatter = 0;
  for (const ComparedPoint& p : out.points) mean += p.reference / n;
  for (const ComparedPoint& p : out.points) {
    const double e = p.model - p.reference;
    squares += e * e / n;
    out.bias += e / n;
    total += (p.reference - mean) * (p.reference - mean) / n;
    largest = std::max(largest, std::abs(p.reference));
    jnd += p.jnd * p.jnd / n;
    if (std::abs(p.jnd) > 1) ++noticeable;
    if (std::abs(e) >= std::abs(out.worst.model - out.worst.reference)) out.worst = p;
    if (std::isfinite(p.uncertainty)) {
      ++with_uncertainty;
      variance += p.uncertainty * p.uncertainty;
      if (std::abs(e) <= q * p.uncertainty) ++within;
    }
    if (std::isfinite(p.scatter)) {
      ++with_scatter;
      scatter += p.scatter * p.scatter;
    }
  }
  out.rmse = std::sqrt(squares);
  out.normalised_rmse = largest > 0 ? out.rmse / largest : kUnknown;
  out.r2 = total > 0 ? 1 - squares / total : kUnknown;
  out.jnd_rms = std::sqrt(jnd);
  out.noticeable = static_cast<double>(noticeable) / n;
  if (with_uncertainty > 0) {
    out.within_uncertainty = static_cast<double>(within) / static_cast<double>(with_uncertainty);
    out.mean_uncertainty = std::sqrt(variance / static_cast<double>(with_uncertainty));
  }
  if (with_scatter > 0) out.mean_scatter = std::sqrt(scatter / static_cast<double>(with_scatter));
}

CurveComparison compare_curves(const ComparedSite& site, const ComparedSite& other,
                               const Pair& pair, const CompareSettings& settings) {
  CurveComparison out;
  out.vertex = site.vertex;
  out.model_vertex = other.vertex;
  const double distance = norm(site.position - other.position);
  out.distance = std::isfinite(distance) ? distance : 0;
  out.position = std::isfinite(site.position[0]) ? site.position : other.position;
  out.kind = pair.reference.kind;
  out.lateral_depth = pair.reference.lateral_depth;
  out.range = pair.range;
  for (const double x : pair.reference.displacement) {
    // The first sample is the touch, or the start of a lateral path: no force on either side.
    if (x > 0 && x <= pair.range * (1 + 1e-9)) out.points.push_back(point_at(pair, x, settings));
  }
  if (out.points.empty()) out.points.push_back(point_at(pair, pair.range, settings));
  add_figures(settings, out);
  add_stiffness(pair, settings, out);
  out.energy_reference = pair.reference_curve.integral(pair.range);
  out.energy_model = pair.model_curve.integral(pair.range);
  return out;
}

Summary summarize(const std::vector<CurveComparison>& curves, PathKind kind) {
  Summary s;
  s.kind = kind;
  double squares = 0, jnd = 0, largest = 0, within = 0, with_uncertainty = 0, scatter = 0,
         with_scatter = 0, noticeable = 0;
  std::vector<double> differences;
  for (const CurveComparison& curve : curves) {
    if (curve.kind != kind) continue;
    ++s.curves;
    const auto n = static_cast<double>(curve.points.size());
    if (std::isfinite(curve.within_uncertainty)) {
      within += n * curve.within_uncertainty;
      with_uncertainty += n;
    }
    if (std::isfinite(curve.mean_scatter)) {
      scatter += n * curve.mean_scatter * curve.mean_scatter;
      with_scatter += n;
    }
    noticeable += n * curve.noticeable;
    for (const ComparedPoint& p : curve.points) {
      const double e = p.model - p.reference;
      differences.push_back(e);
      squares += e * e;
      jnd += p.jnd * p.jnd;
      largest = std::max(largest, std::abs(p.reference));
    }
    if (s.worst_vertex < 0 || std::abs(curve.worst.model - curve.worst.reference) >
                                  std::abs(s.worst.model - s.worst.reference)) {
      s.worst_vertex = curve.vertex;
      s.worst = curve.worst;
    }
  }
  s.points = differences.size();
  if (s.points == 0) return s;
  const auto n = static_cast<double>(s.points);
  s.rmse = std::sqrt(squares / n);
  s.normalised_rmse = largest > 0 ? s.rmse / largest : kUnknown;
  s.bias = measured::mean(differences);
  const double spread = 1.96 * measured::deviation(differences);
  s.agreement_low = s.bias - spread;
  s.agreement_high = s.bias + spread;
  s.jnd_rms = std::sqrt(jnd / n);
  s.noticeable = noticeable / n;
  if (with_uncertainty > 0) s.within_uncertainty = within / with_uncertainty;
  if (with_scatter > 0) s.mean_scatter = std::sqrt(scatter / with_scatter);
  return s;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)), m_(x_.size(), 0.0) {
  const std::size_t n = x_.size();
  if (n < 2) return;
  std::vector<double> secant(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) secant[i] = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
  m_.front() = secant.front();
  m_.back() = secant.back();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = secant[i - 1], b = secant[i];
    const double h = x_[i] - x_[i - 1], k = x_[i + 1] - x_[i];
    // Parabola through three samples, cut back where it would overshoot.
    const double slope = (a * k + b * h) / (h + k);
    const double least = 3 * std::min(std::abs(a), std::abs(b));
    m_[i] = a * b <= 0 ? 0 : std::copysign(std::min(std::abs(slope), least), a);
  }
  // The ends likewise, from the parabola of the first and the last three samples.
  if (n < 3) return;
  const auto end_slope = [&](double near, double far, double h, double k) {
    const double slope = near + (near - far) * h / (h + k);
    if (slope * near <= 0) return 0.0;
    return std::copysign(std::min(std::abs(slope), 3 * std::abs(near)), near);
  };
  m_.front() = end_slope(secant[0], secant[1], x_[1] - x_[0], x_[2] - x_[1]);
  m_.back() = end_slope(secant[n - 2], secant[n - 3], x_[n - 1] - x_[n - 2], x_[n - 2] - x_[n - 3]);
}

std::size_t MonotoneCubic::piece(double x) const {
  const auto above = std::upper_bound(x_.begin(), x_.end(), x);
  const auto i = static_cast<std::size_t>(above - x_.begin());
  return std::clamp<std::size_t>(i, 1, x_.size() - 1) - 1;
}

double MonotoneCubic::value(double x) const {
  if (x_.size() < 2) return y_.empty() ? 0 : y_.front();
  if (x > x_.back()) return y_.back() + m_.back() * (x - x_.back());
  const std::size_t i = piece(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  const double u = 1 - t;
  return u * u * (1 + 2 * t) * y_[i] + t * u * u * h * m_[i] + t * t * (3 - 2 * t) * y_[i + 1] -
         t * t * u * h * m_[i + 1];
}

double MonotoneCubic::slope(double x) const {
  if (x_.size() < 2) return 0;
  if (x > x_.back()) return m_.back();
  const std::size_t i = piece(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  return 6 * t * (1 - t) * (y_[i + 1] - y_[i]) / h + (1 - t) * (1 - 3 * t) * m_[i] +
         t * (3 * t - 2) * m_[i + 1];
}

double MonotoneCubic::integral(double end) const {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x_.size() && x_[i] < end; ++i) {
    const double a = x_[i], b = std::min(end, x_[i + 1]), middle = 0.5 * (a + b);
    sum += (b - a) / 6 * (value(a) + 4 * value(middle) + value(b));  // exact for a cubic
  }
  return sum;
}

namespace {

double radius_or_unknown(double radius) {
  return radius > 0 ? radius : kUnknown;
}

void check_tools(const ComparedSet& reference, const ComparedSet& model) {
  constexpr double kSameRadius = 0.01;
  const char* const remedy = "compare results of one tool";
  if (!reference.tool_shape.empty() && !model.tool_shape.empty() &&
      reference.tool_shape != model.tool_shape) {
    refuse(model.name,
           "its tool is a " + model.tool_shape + ", that of " + reference.name + " a " +
               reference.tool_shape,
           remedy);
  }
  const double a = reference.tool_radius, b = model.tool_radius;
  if (!(std::abs(a - b) > kSameRadius * std::max(a, b))) return;
  refuse(model.name,
         "its tool has a radius of " + length_text(b) + ", that of " + reference.name + " " +
             length_text(a),
         remedy);
}

}  // namespace

ComparedSet set_of(const Curves& curves, std::string name) {
  ComparedSet set{.name = std::move(name),
                  .body_sha256 = curves.body_sha256,
                  .sites = {},
                  .tool_shape = curves.tool.shape,
                  .tool_radius = radius_or_unknown(curves.tool.radius),
                  .tool_friction = curves.tool.friction};
  for (const SiteCurves& site : curves.sites) {
    ComparedSite out;
    out.vertex = site.vertex;
    for (const CurvePath& path : site.paths) {
      if (path.samples.size() >= 2) out.curves.push_back(curve_of(path));
    }
    if (!out.curves.empty()) set.sites.push_back(std::move(out));
  }
  return set;
}

ComparedSet set_of(const Library& library, std::string name, int steps) {
  ComparedSet set{.name = std::move(name),
                  .body_sha256 = "",
                  .sites = {},
                  .tool_shape = library.tool_shape,
                  .tool_radius = radius_or_unknown(library.tool_radius),
                  .tool_friction = ""};
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const NodeResponse& response = library.responses[v];
    if (response.status == ResponseStatus::Hole) continue;
    ComparedSite site{static_cast<std::int32_t>(v),
                      library.positions[v],
                      {},
                      RenderedVertex{response, library.kind, steps}};
    ComparedCurve path;
    site.curves.push_back(curve_along(path, *site.rendered));
    path.kind = PathKind::Lateral;
    path.lateral_depth = static_cast<double>(response.normal.knot.back());
    path.direction = tangent_frame(library.inward[v])[0];
    site.curves.push_back(curve_along(path, *site.rendered));
    set.sites.push_back(std::move(site));
  }
  return set;
}

double jnd_floor_of(const ComparedSet& reference, double jnd) {
  double largest = 0;
  for (const ComparedSite& site : reference.sites)
    for (const ComparedCurve& curve : site.curves)
      for (const double force : curve.force) largest = std::max(largest, std::abs(force));
  return std::min(CompareSettings{}.jnd_floor, jnd * largest);
}

double site_tolerance_of(const ComparedSet& reference) {
  const double usual = CompareSettings{}.site_tolerance;
  return reference.tool_radius > 0 ? std::min(usual, 2 * reference.tool_radius) : usual;
}

Comparison compare(const ComparedSet& reference, const ComparedSet& model,
                   const CompareSettings& settings) {
  check_tools(reference, model);
  Comparison out{reference.name, model.name, {}, {}, {}};
  // Without positions on both sides the numbers of the vertices are all there is.
  const auto placed = [](const ComparedSet& set) {
    return !set.sites.empty() && std::isfinite(set.sites.front().position[0]);
  };
  const bool by_vertex = !placed(reference) || !placed(model);
  if (by_vertex && !reference.body_sha256.empty() && !model.body_sha256.empty() &&
      reference.body_sha256 != model.body_sha256) {
    throw Error(ErrorKind::Configuration, model.name,
                "it was made on another body than " + reference.name,
                "compare results of one body.h5, or give the bodies so that sites are matched by "
                "position");
  }
  for (const ComparedSite& site : reference.sites) {
    const std::string where = "site " + std::to_string(site.vertex) + " of " + reference.name;
    const ComparedSite* other = partner_of(site, model, by_vertex, settings.site_tolerance);
    if (other == nullptr) {
      out.unmatched.push_back(where + " has no partner");
      continue;
    }
    for (const ComparedCurve& curve : curves_beside(site, *other)) {
      if (const auto partner = partner_on(curve, *other, settings))
        out.curves.push_back(compare_curves(site, *other, Pair(curve, *partner), settings));
      else
        out.unmatched.push_back(where + ": its " + path_name(curve.kind, curve.lateral_depth) +
                                " has no partner");
    }
  }
  if (out.curves.empty()) {
    throw Error(
        ErrorKind::Configuration, reference.name + " and " + model.name,
        "they have no curve in common",
        "check that sites, lateral depths and directions are the same within the tolerances");
  }
  for (const PathKind kind : {PathKind::Normal, PathKind::Lateral}) {
    const Summary summary = summarize(out.curves, kind);
    if (summary.curves > 0) out.summaries.push_back(summary);
  }
  return out;
}

}  // namespace palpate::compare
