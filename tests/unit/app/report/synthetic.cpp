// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/app/report/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "format/edge.hpp"
#include "format/numbers.hpp"
#include "format/to_index.hpp"
#include "runtime/palpate.h"

namespace palpate::testing {

namespace {

constexpr Vec3 kSpot{0.027, -0.026, 0.018};
constexpr double kSpotWidth = 0.012;
constexpr double kLateralFraction = 0.6;

Vec3 unit(const Vec3& v) {
  return (1 / norm(v)) * v;
}

struct Mesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

Vec3 on_lump(const Vec3& direction) {
  const Vec3 n = unit(direction);
  const double bulge = 0.10 * n[0] + 0.07 * std::sin(3 * n[1]) * n[0] - 0.12 * n[2] * n[2] +
                       0.05 * std::cos(4 * n[0]) * n[1];
  return (0.040 * (1 + bulge)) * n;
}

Mesh icosahedron() {
  const double g = std::numbers::phi;
  Mesh mesh;
  mesh.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  // Faces: the triples of vertices at the edge length 2, turned outwards.
  for (std::int32_t a = 0; a < 12; ++a) {
    for (std::int32_t b = a + 1; b < 12; ++b) {
      for (std::int32_t c = b + 1; c < 12; ++c) {
        const Vec3 &p = mesh.points[to_index(a)], &q = mesh.points[to_index(b)],
                   &r = mesh.points[to_index(c)];
        if (std::max({norm(p - q), norm(q - r), norm(r - p)}) > 2.1) continue;
        const bool outward = dot(cross(q - p, r - p), p) > 0;
        mesh.triangles.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
      }
    }
  }
  for (Vec3& p : mesh.points) p = on_lump(p);
  return mesh;
}

/// Split each triangle in four; the new points go to the lump, the old ones keep their numbers.
void split(Mesh& mesh) {
  std::map<Edge, std::int32_t> middle;
  const auto half = [&](std::int32_t a, std::int32_t b) {
    const auto [entry, fresh] =
        middle.try_emplace(edge_between(a, b), static_cast<std::int32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back(on_lump(mesh.points[to_index(a)] + mesh.points[to_index(b)]));
    return entry->second;
  };
  std::vector<Triangle> finer;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::int32_t ab = half(a, b), bc = half(b, c), ca = half(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(finer);
}

std::vector<Vec3> inward_normals(const Mesh& mesh) {
  std::vector<Vec3> inward(mesh.points.size(), Vec3{});
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 n = cross(mesh.points[to_index(b)] - mesh.points[to_index(a)],
                         mesh.points[to_index(c)] - mesh.points[to_index(a)]);
    for (const std::int32_t v : {a, b, c}) inward[to_index(v)] = inward[to_index(v)] - n;
  }
  for (Vec3& n : inward) n = unit(n);
  return inward;
}

ProvenanceStep step(const char* stage, const char* utc, const char* input) {
  ProvenanceStep s;
  s.stage = stage;
  s.version = "0.1.0";
  s.git_revision = "0123456789ab";
  s.utc = utc;
  s.resolved_case =
      "name = \"lump\"\n\n[surface]\nfile = \"lump.off\"\nunit = \"mm\"\n\n"
      "[[material]]\nregion = \"matrix\"\nlaw = \"neo-hookean\"\nyoung = \"10 kPa\"\npoisson = "
      "0.45\n\n"
      "[[material]]\nregion = \"nodule\"\nlaw = \"neo-hookean\"\nyoung = \"60 kPa\"\npoisson = "
      "0.45\n\n"
      "[tool]\nradius = \"5 mm\"\n";
  s.inputs = {{input, std::string(60, 'a') + "0f1e"}};
  s.facts = {{"blas", "OpenBLAS 0.3.21 SkylakeX"}, {"threads", "2"}};
  return s;
}

Body make_body(int patches, int refinements) {
  Mesh mesh = icosahedron();
  for (int i = 0; i < patches; ++i) split(mesh);
  Body body;
  body.name = "lump";
  body.response.triangles = mesh.triangles;
  body.response.inward = inward_normals(mesh);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    body.response.node.push_back(static_cast<std::int32_t>(v));
    body.response.is_site.push_back(mesh.points[v][2] > -0.018 ? 1 : 0);
  }
  for (int i = 0; i < refinements; ++i) split(mesh);
  body.nodes = mesh.points;
  body.boundary = mesh.triangles;
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    if (body.nodes[n][2] <= -0.018) body.fixed_nodes.push_back(static_cast<std::int32_t>(n));
  }
  const auto centre = static_cast<std::int32_t>(body.nodes.size());
  body.nodes.push_back({0, 0, 0});
  body.region_names = {"matrix", "nodule"};
  for (const auto& [a, b, c] : body.boundary) {
    body.tetrahedra.push_back({centre, a, b, c});
    body.tetrahedron_region.push_back(norm(body.nodes[to_index(a)] - kSpot) < kSpotWidth ? 1 : 0);
  }
  body.provenance.steps = {step("mesh", "2026-01-31T12:00:00Z", "lump.off")};
  return body;
}

Vec3 tangent(const Vec3& inward) {
  return unit(cross(inward, std::abs(inward[2]) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
}

double lateral_stiffness(const Vec3& x) {
  return kLateralFraction * hertz_factor(x) * std::sqrt(kDepth);
}

CurvePath normal_path(std::int32_t vertex, const Vec3& x, const Vec3& inward, double end) {
  CurvePath path;
  path.direction = inward;
  const double c = hertz_factor(x);
  for (std::int32_t i = 0; i <= kSamples; ++i) {
    const double d = kDepth * i / kSamples;
    if (d > end * (1 + 1e-9)) break;
    CurveSample s;
    s.displacement = d;
    s.force = (c * std::pow(d, 1.5)) * inward;
    s.tool_work = c * std::pow(d, 2.5) / 2.5;
    s.strain_energy = s.tool_work * (1 - balance_gap(vertex));
    s.volume_change = kLeastVolumeChange * d * d / (kDepth * kDepth);
    s.min_jacobian = 1 - 0.5 * d / kDepth;
    path.samples.push_back(s);
  }
  return path;
}

CurvePath lateral_path(std::int32_t vertex, const Vec3& x, const Vec3& inward) {
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.lateral_depth = kDepth / 2;
  path.direction = tangent(inward);
  const double k = lateral_stiffness(x);
  const double before = hertz_factor(x) * std::pow(path.lateral_depth, 2.5) / 2.5;
  for (int i = 0; i <= 6; ++i) {
    CurveSample s;
    s.displacement = 0.003 * i / 6;
    s.force = (k * s.displacement) * path.direction;
    s.tool_work = before + 0.5 * k * s.displacement * s.displacement;
    s.strain_energy = s.tool_work * (1 - 0.5 * balance_gap(vertex));
    path.samples.push_back(s);
  }
  return path;
}

/// A hole in the middle of the touchable part, far from the spot.
bool is_hole(const Vec3& x) {
  return norm(unit(x) - unit(Vec3{0.2, -1, 0.75})) < 0.2;
}

SiteCurves make_site(const Body& body, std::int32_t vertex) {
  const Vec3& x = body.nodes[to_index(body.response.node[to_index(vertex)])];
  const Vec3& inward = body.response.inward[to_index(vertex)];
  SiteCurves site;
  site.vertex = vertex;
  site.cpu_seconds = 0.4 + 0.25 * std::abs(std::sin(1.7 * vertex)) + 4 * norm(x);
  if (is_hole(x)) {
    site.reason = "the touch was not found: the tool meets the body elsewhere first";
    return site;
  }
  site.status = vertex % 53 == 17 ? SiteStatus::Partial : SiteStatus::Complete;
  const bool partial = site.status == SiteStatus::Partial;
  if (partial) site.reason = "det F <= 0 at 4.5 mm at the smallest increment";
  site.paths = {normal_path(vertex, x, inward, partial ? 0.75 * kDepth : kDepth),
                lateral_path(vertex, x, inward)};
  return site;
}

Curves make_curves(const Body& body) {
  Curves curves;
  curves.tool = {"sphere", 0.005, "frictionless"};
  curves.depth = kDepth;
  curves.lateral_travel = 0.003;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    if (body.response.is_site[v] != 0)
      curves.sites.push_back(make_site(body, static_cast<std::int32_t>(v)));
  }
  curves.provenance = body.provenance;
  curves.provenance.steps.push_back(step("precompute", "2026-01-31T12:10:00Z", "body.h5"));
  return curves;
}

/// Knots at every third sample, with the slope of the closed form there.
NodeResponse make_response(const Vec3& x) {
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  const double c = hertz_factor(x);
  for (int i = 0; i <= kSamples; i += 3) {
    const double d = kDepth * i / kSamples;
    r.normal.knot.push_back(static_cast<float>(d));
    r.normal.slope.push_back(static_cast<float>(1.5 * c * std::sqrt(d)));
  }
  const auto k = static_cast<float>(lateral_stiffness(x));
  r.lateral = {{0.0F, 0.003F}, {k, k}};
  return r;
}

double force_of(const ResponseCurve& curve, double d) {
  double force = 0;
  for (std::size_t k = 0; k + 1 < curve.knot.size(); ++k) {
    const double a = curve.knot[k], h = curve.knot[k + 1] - curve.knot[k];
    const double t = std::clamp(d - a, 0.0, h);
    force += t * (curve.slope[k] + 0.5 * (curve.slope[k + 1] - curve.slope[k]) * t / h);
  }
  return force;
}

void set_errors(NodeResponse& response, const SiteCurves& site, const Vec3& inward) {
  for (const CurvePath& path : site.paths) {
    const bool normal = path.kind == PathKind::Normal;
    for (const CurveSample& s : path.samples) {
      const double sampled = dot(s.force, normal ? inward : path.direction);
      const double fitted = force_of(normal ? response.normal : response.lateral, s.displacement);
      double& error = normal ? response.normal_error : response.lateral_error;
      error = std::max(error, std::abs(fitted - sampled));
    }
  }
}

void make_certificate(Library& library) {
  Certificate& c = library.certificate;
  c.friction = 0.3;
  c.depth = kDepth;
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    TriangleCertificate t;
    double soft = 1e9;
    for (const std::int32_t v : library.triangles[m]) {
      const NodeResponse& r = library.responses[to_index(v)];
      if (r.status == ResponseStatus::Hole) continue;
      t.stick = std::max(t.stick, static_cast<double>(r.normal.slope.back()));
      soft = std::min(soft, static_cast<double>(r.normal.slope.back()));
    }
    if (t.stick > 0) t.slip = std::sqrt(1 + 0.09) * (t.stick + 0.8 * (t.stick - soft));
    t.kappa = 30;
    t.sliding_passive = t.slip < 300;
    if (t.slip > c.slip) c.worst_triangle = static_cast<std::int32_t>(m);
    c.stick = std::max(c.stick, t.stick);
    c.slip = std::max(c.slip, t.slip);
    c.triangles.push_back(t);
  }
  c.limited_by = "sup g' at the deepest depth, and the stiffness changing along the surface";
  for (const auto& [name, damping] :
       {std::pair{"omega.3", 1.9}, std::pair{"Touch X", 0.6}, std::pair{"unmeasured", kUnknown}}) {
    const double bound = std::max(c.stick, c.slip);
    const DeviceConstants device{damping, 0.1, 0, 1e-5, 1e-3};
    c.devices.push_back({name, damping, lowest_rate(device, {bound, 0}), 2000 * damping / 3,
                         2000 * damping, 0.1, 0, 1e-5, 1e-3, published_rate(damping, bound),
                         largest_position_step(device, bound)});
  }
}

Library make_library(const Body& body, const Curves& curves) {
  Library library;
  library.name = "lump";
  library.tool_shape = "sphere";
  library.tool_radius = 0.005;
  library.inward = body.response.inward;
  for (const std::int32_t n : body.response.node)
    library.positions.push_back(body.nodes[to_index(n)]);
  library.responses.resize(library.positions.size());
  bool filled = false;
  for (const SiteCurves& site : curves.sites) {
    NodeResponse& response = library.responses[to_index(site.vertex)];
    if (site.status == SiteStatus::Failed && filled) continue;
    response = make_response(library.positions[to_index(site.vertex)]);
    if (site.status == SiteStatus::Failed) {
      response.status = ResponseStatus::Interpolated;
      filled = true;
      continue;
    }
    set_errors(response, site, library.inward[to_index(site.vertex)]);
  }
  for (const Triangle& t : body.response.triangles) {
    const auto is_site = [&](std::int32_t v) { return body.response.is_site[to_index(v)] != 0; };
    if (std::all_of(t.begin(), t.end(), is_site)) library.triangles.push_back(t);
  }
  for (const SiteCurves& site : curves.sites) {
    const ResponseStatus status = library.responses[to_index(site.vertex)].status;
    library.certificate.holes += status == ResponseStatus::Hole ? 1 : 0;
    library.certificate.interpolated += status == ResponseStatus::Interpolated ? 1 : 0;
  }
  make_certificate(library);
  library.provenance = curves.provenance;
  library.provenance.steps.push_back(step("fit", "2026-01-31T12:20:00Z", "curves.h5"));
  library.provenance.steps.push_back(step("certify", "2026-01-31T12:20:05Z", "library.h5"));
  return library;
}

Vec3 path_point(double s) {
  const Vec3 a = unit(kSpot), b = unit(cross(a, Vec3{0.3, 0.4, 1}));
  const double angle = 0.9 * (2 * s - 1);
  return on_lump(std::cos(angle) * a + std::sin(angle) * b);
}

/// Two presses that slide across the spot and back; friction takes a tenth of the power.
/// The triangle whose middle is nearest to a point.
std::int32_t nearest_triangle(const Library& library, const Vec3& point) {
  std::int32_t nearest = -1;
  double least = kInfinity;
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    Vec3 middle{};
    for (const std::int32_t v : library.triangles[m])
      middle = middle + (1.0 / 3) * library.positions[static_cast<std::size_t>(v)];
    const double away = norm(middle - point);
    if (away < least) {
      least = away;
      nearest = static_cast<std::int32_t>(m);
    }
  }
  return nearest;
}

Recording make_recording(const Library& library) {
  Recording recording;
  recording.device = "simulated";
  recording.rate = 1000;
  recording.friction = 0.3;
  recording.provenance = library.provenance;
  recording.provenance.steps.push_back(step("simulate", "2026-01-31T12:30:00Z", "library.h5"));
  double before = 0, dissipated = 0;
  std::int32_t element = -1;
  for (std::int64_t i = 0; i < 6000; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const double s = 0.5 - 0.5 * std::cos(t * std::numbers::pi / 3);
    RecordedStep r;
    r.time_ns = i * 1000000;
    r.contact_point = path_point(s);
    r.depth = std::max(0.0, 0.0045 * std::sin(2 * std::numbers::pi * t / 3));
    r.position = r.contact_point - (r.depth > 0 ? r.depth : -0.003) * unit(r.contact_point);
    const double c = hertz_factor(r.contact_point);
    const double magnitude = c * std::pow(r.depth, 1.5);
    r.energy = c * std::pow(r.depth, 2.5) / 2.5;
    dissipated += 0.1 * std::abs(r.energy - before);
    before = r.energy;
    r.absorbed = r.energy + dissipated;
    r.force = magnitude * unit(r.contact_point);
    r.lateral = 0.25 * r.depth;
    if (i % 20 == 0) element = nearest_triangle(library, r.contact_point);
    r.element = r.depth > 0 ? element : -1;
    r.status = r.depth > 0 ? PALPATE_CONTACT | PALPATE_SLIDING : 0U;
    r.latency_ns = 900 + (i * 7919) % 701 + (i % 997 == 3 ? 20000 : 0);
    recording.steps.push_back(r);
  }
  return recording;
}

}  // namespace

double hertz_factor(const Vec3& position) {
  const double away = norm(position - kSpot) / kSpotWidth;
  return 1100 * (1 + 1.5 * std::exp(-away * away) + 3 * position[0] + 2 * position[1]);
}

double balance_gap(std::int32_t vertex) {
  return 0.002 + 0.0015 * std::sin(2.3 * vertex);
}

Synthetic synthetic(int patches, int refinements) {
  Synthetic all;
  all.body = make_body(patches, refinements);
  all.curves = make_curves(all.body);
  all.library = make_library(all.body, all.curves);
  all.recording = make_recording(all.library);
  return all;
}

}  // namespace palpate::testing
