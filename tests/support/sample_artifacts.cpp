// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/sample_artifacts.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "format/edge.hpp"

namespace palpate::samples {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Vec3 vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  Vec3 direction() {
    Vec3 v{};
    while (norm(v) < 0.1) v = vector(1);
    return (1 / norm(v)) * v;
  }

 private:
  std::mt19937 engine_;
};

ProvenanceStep step(const std::string& stage) {
  return {stage,
          "0.1.0",
          "0123456789ab-dirty",
          "2026-01-31T12:00:00Z",
          "# the case as understood\nname = \"Blöckchen\"\n[tool]\nradius = 0.005\n",
          {{"skin.off", std::string(64, 'a')}, {"skin.off", std::string(64, '7')}},
          {{"CGAL", "5.5"}, {"BLAS kernel", "Haswell"}, {"empty", ""}}};
}

constexpr int kCells = 3;
constexpr double kCell = 0.01;  // m

std::int32_t grid_node(int x, int y, int z) {
  return (z * (kCells + 1) + y) * (kCells + 1) + x;
}

/// Six tetrahedra around the diagonal of a cell, one for each order of the axes.
void add_cell(Body& body, Random& random, int x, int y, int z) {
  std::array<int, 3> axes{0, 1, 2};
  do {
    std::array<int, 3> at{x, y, z};
    Tetrahedron corners{};
    corners[0] = grid_node(at[0], at[1], at[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      ++at[static_cast<std::size_t>(axes[i])];
      corners[i + 1] = grid_node(at[0], at[1], at[2]);
    }
    const auto node = [&](std::size_t i) {
      return body.nodes[static_cast<std::size_t>(corners[i])];
    };
    if (dot(cross(node(1) - node(0), node(2) - node(0)), node(3) - node(0)) < 0) {
      std::swap(corners[2], corners[3]);
    }
    body.tetrahedra.push_back(corners);
    body.tetrahedron_region.push_back(random.integer(0, 1));
  } while (std::next_permutation(axes.begin(), axes.end()));
}

/// Facets that belong to one tetrahedron only, seen from outside.
std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<std::set<std::int32_t>, std::vector<Triangle>> facets;
  for (const Tetrahedron& t : tetrahedra) {
    for (const Triangle& facet : {Triangle{t[0], t[2], t[1]}, Triangle{t[0], t[1], t[3]},
                                  Triangle{t[0], t[3], t[2]}, Triangle{t[1], t[2], t[3]}}) {
      facets[{facet[0], facet[1], facet[2]}].push_back(facet);
    }
  }
  std::vector<Triangle> boundary;
  for (const auto& [key, owners] : facets) {
    if (owners.size() == 1) boundary.push_back(owners.front());
  }
  return boundary;
}

void add_response_surface(Body& body, Random& random) {
  std::map<std::int32_t, std::int32_t> vertex_of;
  for (const Triangle& facet : body.boundary) {
    for (const std::int32_t node : facet) vertex_of[node] = 0;
  }
  for (auto& [node, vertex] : vertex_of) {
    vertex = static_cast<std::int32_t>(body.response.node.size());
    body.response.node.push_back(node);
    body.response.inward.push_back(random.direction());
    const auto row = static_cast<std::size_t>(node);
    body.response.is_site.push_back(body.nodes[row][2] > kCell / 2 ? 1 : 0);
  }
  for (const Triangle& facet : body.boundary) {
    body.response.triangles.push_back(
        {vertex_of[facet[0]], vertex_of[facet[1]], vertex_of[facet[2]]});
  }
}

ResponseCurve response_curve(Random& random) {
  ResponseCurve curve{{0.0F}, {0.0F}};
  const int count = random.integer(2, 12);
  while (static_cast<int>(curve.knot.size()) < count) {
    curve.knot.push_back(curve.knot.back() + static_cast<float>(random.between(1e-4, 2e-3)));
    curve.slope.push_back(static_cast<float>(random.between(0, 900)));
  }
  return curve;
}

/// What only a solver knows becomes unknown, what only a measurement has becomes known.
void make_measured(CurvePath& path, Random& random) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  path.repeats = random.integer(1, 9);
  path.contact_uncertainty = random.between(0, 1e-4);
  for (CurveSample& sample : path.samples) {
    sample.strain_energy = sample.min_jacobian = unknown;
    sample.penetration = sample.contact_area = unknown;
    sample.contact_energy = sample.tension = unknown;
    sample.facets_in_contact = sample.mesh_difference = sample.mesh_error = unknown;
    sample.volume_change = unknown;
    sample.force_uncertainty = random.between(0, 0.1);
    if (path.repeats > 1) sample.force_scatter = random.between(0, 0.1);
  }
}

CurvePath curve_path(Random& random, PathKind kind) {
  CurvePath path{kind, kind == PathKind::Lateral ? 0.003 : 0, random.direction(), {}};
  double travel = 0;
  for (int i = random.integer(1, 12); i > 0; --i) {
    path.samples.push_back({travel, random.vector(3), random.between(0, 1), random.between(0, 1),
                            random.between(0.2, 1), random.between(-1e-5, 1e-5),
                            random.between(0, 1e-4), random.integer(1, 20)});
    path.samples.back().contact_energy = random.between(-1e-6, 1e-6);
    path.samples.back().tension = random.between(0, 1);
    path.samples.back().facets_in_contact = random.between(0, 9);
    path.samples.back().mesh_difference = random.between(-0.1, 0.1);
    path.samples.back().mesh_error = random.between(0, 0.1);
    path.samples.back().volume_change = random.between(-1e-8, 1e-8);
    travel += random.between(1e-5, 1e-3);
  }
  if (path.samples.size() % 2 == 0) make_measured(path, random);
  return path;
}

class Dump {
 public:
  Dump() { text_ << std::hexfloat; }
  template <class T>
  Dump& operator<<(const T& value) {
    text_ << value << '\n';
    return *this;
  }
  template <class T, std::size_t N>
  Dump& operator<<(const std::array<T, N>& values) {
    for (const T& value : values) text_ << value << ' ';
    text_ << '\n';
    return *this;
  }
  template <class T>
  Dump& operator<<(const std::vector<T>& values) {
    text_ << values.size() << ":\n";
    for (const T& value : values) *this << value;
    return *this;
  }
  Dump& operator<<(std::uint8_t value) { return *this << static_cast<int>(value); }
  Dump& operator<<(const ResponseCurve& curve) { return *this << curve.knot << curve.slope; }
  Dump& operator<<(const Provenance& provenance) {
    for (const ProvenanceStep& s : provenance.steps) {
      *this << s.stage << s.version << s.git_revision << s.utc << s.resolved_case;
      for (const InputDigest& input : s.inputs) *this << input.name << input.sha256;
      for (const auto& [name, value] : s.facts) *this << name << value;
    }
    return *this;
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

}  // namespace

Body body(unsigned seed) {
  Random random(seed);
  Body body;
  body.name = "Blöckchen";
  body.region_names = {"matrix", "nodule"};
  for (int z = 0; z <= kCells; ++z) {
    for (int y = 0; y <= kCells; ++y) {
      for (int x = 0; x <= kCells; ++x) {
        if (z == 0) body.fixed_nodes.push_back(static_cast<std::int32_t>(body.nodes.size()));
        body.nodes.push_back(Vec3{x * kCell, y * kCell, z * kCell} + random.vector(kCell / 20));
      }
    }
  }
  for (int z = 0; z < kCells; ++z) {
    for (int y = 0; y < kCells; ++y) {
      for (int x = 0; x < kCells; ++x) add_cell(body, random, x, y, z);
    }
  }
  body.boundary = boundary_of(body.tetrahedra);
  add_response_surface(body, random);
  body.provenance.steps = {step("mesh")};
  return body;
}

Body sprung_body(unsigned seed) {
  Random random(seed);
  Body sprung = body(seed);
  for (std::int32_t facet = 1; facet < 12; facet += 3)
    sprung.foundation.push_back({facet, random.between(0, 1e6), random.between(0, 1e5)});
  return sprung;
}

Body curved_body(unsigned seed) {
  Random random(seed);
  Body curved = sprung_body(seed);
  std::set<Edge> edges;
  for (const Triangle& facet : curved.boundary) edges.insert(edge_between(facet[0], facet[1]));
  for (const Edge& ends : edges) {
    const Vec3 a = curved.nodes[static_cast<std::size_t>(ends[0])];
    const Vec3 b = curved.nodes[static_cast<std::size_t>(ends[1])];
    curved.curved_edges.push_back({ends, 0.5 * (a + b) + random.vector(0.1 * norm(b - a))});
  }
  return curved;
}

Body measured_body(unsigned seed) {
  Body measured = body(seed);
  measured.tetrahedra.clear();
  measured.tetrahedron_region.clear();
  measured.region_names.clear();
  measured.fixed_nodes.clear();
  return measured;
}

Curves curves(unsigned seed) {
  Random random(seed);
  Curves curves;
  curves.tool = {"disc", random.between(1e-3, 1e-2), "frictionless", random.between(0, 1e-3),
                 random.between(0, 1e-2)};
  curves.depth = random.between(1e-3, 1e-2);
  curves.lateral_travel = random.between(1e-3, 1e-2);
  curves.body_sha256 = std::string(64, 'b');
  curves.mesh_error_confidence = random.between(0, 1);
  for (std::int32_t vertex = 0; vertex < 20; ++vertex) {
    SiteCurves site{vertex * 3, SiteStatus::Complete, "", random.between(0, 100), {}};
    if (vertex % 5 == 3) site.status = SiteStatus::Partial, site.reason = "line search failed";
    if (vertex % 5 == 4) site.status = SiteStatus::Failed, site.reason = "inverted at touch, χ < 0";
    if (site.status != SiteStatus::Failed) {
      site.paths.push_back(curve_path(random, PathKind::Normal));
      site.paths.push_back(curve_path(random, PathKind::Lateral));
      site.paths.push_back({PathKind::Lateral, 0.004, random.direction(), {}});
    }
    curves.sites.push_back(std::move(site));
  }
  curves.provenance.steps = {step("mesh"), step("precompute")};
  return curves;
}

Curves relaxing_curves(unsigned seed) {
  Curves relaxing = curves(seed);
  Random random(seed + 1);
  relaxing.relaxation = {{0.1, random.between(1, 2), 30},
                         {{random.between(0, 0.3), 0.2, 0.1}, {0, 0, random.between(0, 0.5)}}};
  for (SiteCurves& site : relaxing.sites)
    for (CurvePath& path : site.paths)
      for (CurveSample& sample : path.samples)
        sample.isochoric_energy = {random.between(0, 1), random.between(0, 1)};
  return relaxing;
}

Library library(unsigned seed) {
  Random random(seed);
  const Body source = body(seed);
  Library library;
  library.name = source.name;
  library.tool_shape = "sphere";
  library.tool_radius = random.between(1e-3, 1e-2);
  for (const std::int32_t node : source.response.node) {
    library.positions.push_back(source.nodes[static_cast<std::size_t>(node)]);
    library.responses.push_back({ResponseStatus::Fitted, response_curve(random),
                                 response_curve(random), random.between(0, 1e-2),
                                 random.between(0, 1e-2)});
  }
  library.inward = source.response.inward;
  library.triangles = source.response.triangles;
  library.responses[3].status = ResponseStatus::Interpolated;
  library.responses[5] = NodeResponse{};
  Certificate& certificate = library.certificate;
  certificate = {0.3, 0.006, 912.5, 1530.25, 953.5, 1400.5, 7, "slope of vertex 12",
                 "",  1,     1,     {},      {}};
  for (std::size_t i = 0; i < library.triangles.size(); ++i) {
    certificate.triangles.push_back({random.between(0, 900), random.between(0, 1500),
                                     random.between(0, 30), random.between(0.5, 1),
                                     random.integer(0, 1) == 1});
  }
  certificate.basis = "simulated shape, measured scale";
  certificate.triangles[2].slip = std::numeric_limits<double>::infinity();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  certificate.devices = {
      {"Phantom Premium", 0.0048, 637.5, 3.2, 9.6, 0.04, 2e-4, 3e-5, 1e-3, 850, 4e-5},
      {"somebody's own", unknown, unknown, unknown, unknown}};
  library.provenance.steps = {step("mesh"), step("precompute"), step("fit"), step("certify")};
  return library;
}

Library coupled_library(unsigned seed) {
  Random random(seed + 1000);
  Library coupled = library(seed);
  coupled.kind = ResponseKind::Coupled;
  for (NodeResponse& node : coupled.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    node.coupling = {static_cast<float>(random.between(0.1, 1)), response_curve(random)};
  }
  return coupled;
}

Library relaxing_library(unsigned seed) {
  Random random(seed + 2000);
  Library relaxing = seed % 2 == 0 ? library(seed) : coupled_library(seed);
  relaxing.relaxation_times = {random.between(0.01, 0.1), random.between(0.2, 1)};
  relaxing.tool_radius = 0.004;
  relaxing.certificate.relaxation_rate = random.between(1, 30);
  for (NodeResponse& node : relaxing.responses)
    if (node.status != ResponseStatus::Hole)
      node.relaxation = {static_cast<float>(random.between(0, 0.4)),
                         static_cast<float>(random.between(0, 0.4))};
  return relaxing;
}

Library leaning_library(unsigned seed) {
  Random random(seed + 3000);
  Library leaning = seed % 3 == 0   ? relaxing_library(seed)
                    : seed % 3 == 1 ? coupled_library(seed)
                                    : library(seed);
  for (NodeResponse& node : leaning.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    for (float& component : node.lean) component = static_cast<float>(random.between(-0.2, 0.2));
    if (leaning.kind == ResponseKind::Decoupled) continue;
    node.coupling.curve.slope.back() = 0;  // w ends, so that w sigma has a bound
    const double most = node.coupling.largest();
    for (float& component : node.lean) component /= static_cast<float>(most);
  }
  return leaning;
}

Library soft_library(unsigned seed) {
  Random random(seed + 4000);
  Library soft = seed % 3 == 0   ? leaning_library(seed)  // and relaxing or not
                 : seed % 3 == 1 ? coupled_library(seed)
                                 : relaxing_library(2 * seed + 1);
  if (soft.kind == ResponseKind::Decoupled) soft = coupled_library(seed);
  for (NodeResponse& node : soft.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    for (float& component : node.soft_axis)
      component = static_cast<float>(random.between(-0.3, 0.3));
  }
  return soft;
}

Recording recording(unsigned seed) {
  Random random(seed);
  Recording recording;
  recording.device = "simulated";
  recording.library_sha256 = std::string(64, 'c');
  recording.rate = 1000;
  recording.friction = 0.3;
  for (int i = 0; i < 5000; ++i) {
    recording.steps.push_back(
        {std::int64_t{1000000} * i, random.vector(0.1), random.vector(1), random.vector(5),
         random.vector(0.1), random.between(0, 0.01), random.between(0, 0.01),
         random.between(0, 0.001), random.between(0, 0.1), random.between(0, 0.005),
         random.between(-1e-9, 1), random.integer(-1, 500),
         static_cast<std::uint32_t>(random.integer(0, 511)), random.integer(1000, 90000)});
  }
  recording.settings = {
      5e-3, 300, 100, {0.1, 0, -0.2}, true, 0.5, 0.02, std::numeric_limits<double>::infinity(), 3};
  recording.steps[17].position[1] = std::numeric_limits<double>::quiet_NaN();
  recording.steps[17].velocity[2] = std::numeric_limits<double>::infinity();
  recording.provenance.steps = {step("mesh"), step("precompute"), step("fit"), step("run")};
  return recording;
}

static std::vector<Vec3> springs_of(const Body& body) {
  std::vector<Vec3> rows;
  for (const SprungFacet& f : body.foundation)
    rows.push_back({static_cast<double>(f.facet), f.normal_stiffness, f.tangential_stiffness});
  return rows;
}

static std::vector<Vec3> bulges_of(const Body& body) {
  std::vector<Vec3> rows;
  for (const CurvedEdge& e : body.curved_edges) {
    rows.push_back({static_cast<double>(e.ends[0]), static_cast<double>(e.ends[1]), 0});
    rows.push_back(e.middle);
  }
  return rows;
}

std::string dump(const Body& body) {
  const ResponseSurface& r = body.response;
  return (Dump() << body.name << body.nodes << body.tetrahedra << body.tetrahedron_region
                 << body.region_names << body.boundary << body.fixed_nodes << r.node << r.inward
                 << r.triangles << r.is_site << springs_of(body) << bulges_of(body)
                 << body.provenance)
      .text();
}

std::string dump(const Curves& curves) {
  Dump out;
  out << curves.tool.shape << curves.tool.radius << curves.tool.friction << curves.tool.edge_radius
      << curves.tool.length << curves.depth << curves.lateral_travel << curves.body_sha256;
  for (const SiteCurves& site : curves.sites) {
    out << site.vertex << static_cast<int>(site.status) << site.reason << site.cpu_seconds
        << site.paths.size();
    for (const CurvePath& path : site.paths) {
      out << static_cast<int>(path.kind) << path.lateral_depth << path.direction
          << path.samples.size() << path.repeats << path.contact_uncertainty;
      for (const CurveSample& s : path.samples) {
        out << s.displacement << s.force << s.strain_energy << s.tool_work << s.min_jacobian
            << s.penetration << s.contact_area << s.iterations << s.force_scatter
            << s.force_uncertainty << s.contact_energy << s.tension << s.facets_in_contact
            << s.mesh_difference << s.mesh_error << s.volume_change;
        for (const double energy : s.isochoric_energy) out << energy;
      }
    }
  }
  for (const double time : curves.relaxation.times_s) out << time;
  for (const std::vector<double>& region : curves.relaxation.fractions)
    for (const double fraction : region) out << fraction;
  return (out << curves.provenance).text();
}

std::string dump(const Library& library) {
  Dump out;
  out << static_cast<int>(library.kind);
  out << library.name << library.tool_shape << library.tool_radius << library.positions
      << library.inward << library.triangles;
  for (const NodeResponse& r : library.responses) {
    out << static_cast<int>(r.status) << r.normal << r.lateral << r.normal_error << r.lateral_error;
    out << static_cast<double>(r.coupling.base) << r.coupling.curve;
    for (const float fraction : r.relaxation) out << static_cast<double>(fraction);
    for (const float component : r.lean) out << static_cast<double>(component);
    for (const float component : r.soft_axis) out << static_cast<double>(component);
  }
  for (const double time : library.relaxation_times) out << time;
  const Certificate& c = library.certificate;
  out << c.friction << c.depth << c.stick << c.slip << c.min_lipschitz_bound << c.lipschitz_bound
      << c.worst_triangle << c.limited_by << c.basis << c.holes << c.interpolated
      << c.relaxation_rate;
  for (const TriangleCertificate& t : c.triangles) {
    out << t.stick << t.slip << t.kappa << t.cos_theta << t.sliding_passive;
  }
  for (const DeviceCertificate& d : c.devices) {
    out << d.device << d.damping << d.lowest_rate << d.linear_limit << d.no_delay_limit
        << d.coulomb_friction << d.delay << d.position_resolution << d.force_resolution
        << d.published_rate << d.largest_position_step;
  }
  return (out << library.provenance).text();
}

std::string dump(const Recording& recording) {
  Dump out;
  out << recording.device << recording.library_sha256 << recording.rate << recording.friction;
  const SessionSettings& set = recording.settings;
  out << set.tank_cap << set.lipschitz_bound << set.search_rate << set.body_position
      << int{set.guarded} << set.ramp << set.watchdog << set.max_force << set.max_speed;
  for (const RecordedStep& s : recording.steps) {
    out << s.time_ns << s.position << s.velocity << s.force << s.contact_point << s.depth
        << s.lateral << s.offset << s.energy << s.tank << s.absorbed << s.element << s.status
        << s.latency_ns;
  }
  return (out << recording.provenance).text();
}

}  // namespace palpate::samples
