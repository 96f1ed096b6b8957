// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/attempts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/faults.hpp"
#include "mesher/volume/interfaces.hpp"
#include "mesher/volume/manifold.hpp"
#include "mesher/volume/refine.hpp"
#include "mesher/volume/triangle_cloud.hpp"

namespace palpate::mesher {
namespace {

constexpr int kMostAttempts = 4;

/// By how much edges grow from the surface inward, per length.
constexpr double kGrowth = 0.3;

/// Bound on the radius of facets and tetrahedra / edge, which gives edges of this length in the
/// mean.
constexpr double kRadius = 0.8;

/// Refinement does not end where surfaces meet at an angle below about this one, degrees: it is
/// relaxed, and with it the demand for a manifold boundary, if refinement is stopped; last to 0.
constexpr std::array<double, 2> kFacetAngles = {25, 12};

/// Between the first nodes, in edges.
constexpr double kSeedSpacing = 2;

/// Between the points at which the mesh is compared with the domain, in edges.
constexpr double kProbeSpacing = 0.5;

/// A point of an interface counts as lost at this distance from the mesh, in edges. The corner of a
/// cube is cut by a tenth.
constexpr double kFar = 0.35;

/// Sizes at faults are reduced by this factor, down to this part of element_size.
constexpr double kFiner = 0.5, kFinest = 1.0 / 16;

/// All sizes are reduced by this factor where the surface cannot be followed more closely.
constexpr double kSmaller = 0.7;

/// Nodes in excess of a uniform mesh at which refinement has gone astray; and, as narrow gaps
/// between walls take more than was expected, in the attempts after one that was stopped.
constexpr double kExcess = 4, kMost = 16;

/// Parts that are connected to the body by no face are dropped up to this fraction of its volume.
constexpr double kNegligible = 0.01;

struct Candidate {
  VolumeMesh mesh;
  Faults faults;
  double volume_change = 0;
  bool cut_short = false;
};

class Attempts {
 public:
  Attempts(MeshRequest request, DelaunayReport& report)
      : request_(std::move(request)), report_(report), volume_(request_.oracle.volume()) {}

  VolumeMesh run() {
    Candidate candidate;
    for (report_.attempts = 1;; ++report_.attempts) {
      candidate = attempt();
      if (is_sound(candidate) || report_.attempts == kMostAttempts) break;
      refine_at(candidate);
    }
    take_apart(candidate);
    measure(candidate);
    check(candidate);
    return std::move(candidate.mesh);
  }

 private:
  double edge(const GradedSize& graded, const Vec3& x) const {
    return std::min(graded.at(x), request_.largest(x));
  }

  Candidate attempt() {
    const GradedSize graded(request_.sizes, kGrowth);
    const SizeField edges = [&](const Vec3& x) { return edge(graded, x); };
    RefineSettings settings;
    settings.facet_size = [&](const Vec3& x) { return kRadius * edges(x); };
    settings.cell_size = settings.facet_size;
    settings.seed_spacing = [&](const Vec3& x) { return kSeedSpacing * edges(x); };
    settings.facet_distance *= distance_factor_;
    settings.most_nodes = node_limit(edges);
    settings.refine_until_manifold = facet_angle_ == kFacetAngles.front();
    settings.smallest_facet_angle = facet_angle_;
    Refinement refined = refine(request_.oracle, settings);
    if (!refined.failure.empty()) note(request_.log, "CGAL: " + refined.failure);

    Candidate candidate{std::move(refined.mesh), {}, -1, refined.cut_short};
    if (candidate.mesh.tetrahedra.empty()) return candidate;
    const auto probes =
        request_.oracle.seeds([&](const Vec3& x) { return kProbeSpacing * edges(x); });
    candidate.faults =
        find_faults(candidate.mesh, probes,
                    {request_.largest_dihedral, [&](const Vec3& x) { return kFar * edges(x); }});
    candidate.volume_change = total_volume(candidate.mesh) / volume_ - 1;
    return candidate;
  }

  static double total_volume(const VolumeMesh& mesh) {
    double sum = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) sum += volume(mesh.nodes, t);
    return sum;
  }

  /// The nodes of a mesh with these edges, and some more.
  std::size_t node_limit(const SizeField& edges) const {
    double nodes = 1000;
    for (const SizeSource& source : request_.sizes) {
      // Each source stands for the square between it and its neighbours.
      const double spacing = kProbeSpacing * std::max(source.size, request_.element_size);
      nodes += std::pow(spacing / edges(source.point), 2);
    }
    nodes += 1.5 * volume_ / std::pow(request_.element_size, 3);
    return static_cast<std::size_t>(
        std::min(excess_ * nodes, static_cast<double>(request_.most_nodes)));
  }

  bool is_sound(const Candidate& c) const {
    return !c.cut_short && !c.mesh.tetrahedra.empty() && c.faults.pinches.empty() &&
           c.faults.islands.empty() && c.faults.flat.empty() && has_volume(c) &&
           (c.faults.lost.empty() || report_.attempts > 1);
  }

  bool has_volume(const Candidate& c) const {
    return std::abs(c.volume_change) <= request_.most_volume_change;
  }

  void refine_at(const Candidate& c) {
    const GradedSize graded(request_.sizes, kGrowth);
    const double finest = kFinest * request_.element_size;
    std::size_t places = 0;
    const auto add = [&](const std::vector<Vec3>& points) {
      for (const Vec3& x : points)
        request_.sizes.push_back({x, std::max(finest, kFiner * edge(graded, x))});
      places += points.size();
    };
    add(c.faults.pinches);
    add(c.faults.islands);
    add(c.faults.flat);
    if (report_.attempts == 1 || !has_volume(c)) add(c.faults.lost);
    adapt_criteria(c);
    note(request_.log,
         text("attempt ", report_.attempts, ": ", counted(c.mesh.nodes.size(), "node"), ", ",
              counted(c.faults.pinches.size(), "node"), " where the boundary touches itself, ",
              counted(c.faults.islands.size(), "tetrahedron", "tetrahedra"), " apart, ",
              c.faults.flat.size(), " flat, ", counted(c.faults.lost.size(), "point"),
              " of the surfaces lost, volume ", 100 * c.volume_change, " %",
              c.cut_short ? ", stopped" : "", "; again with smaller elements at ",
              counted(places, "place")));
  }

  /// Facets that are too far from the interface cost volume: they shall be nearer. Where that has
  /// no end, as at acute edges, elements become smaller everywhere instead; and so where the first
  /// nodes lie too far apart to begin with.
  void adapt_criteria(const Candidate& c) {
    if (c.cut_short) excess_ = kMost;
    if (c.cut_short && distance_factor_ < 1) {
      distance_factor_ = 1;
      shrink_all(kSmaller);
    } else if (!c.cut_short && c.mesh.tetrahedra.empty()) {
      shrink_all(kFiner);
    } else if (c.cut_short) {
      facet_angle_ = facet_angle_ > kFacetAngles[1] ? kFacetAngles[1] : 0;
    } else if (!has_volume(c)) {
      distance_factor_ *= kFiner;
    }
  }

  void shrink_all(double factor) {
    const double finest = kFinest * request_.element_size;
    for (SizeSource& source : request_.sizes)
      source.size = std::max(std::min(source.size, finest), factor * source.size);
  }

  void take_apart(Candidate& c) {
    if (c.mesh.tetrahedra.empty()) return;
    const auto set = adjacency(c.mesh.tetrahedra).part;
    const double before = total_volume(c.mesh);
    keep_set(c.mesh, set, largest_set(c.mesh, set));
    report_.removed_fraction = 1 - total_volume(c.mesh) / before;
    const ManifoldChange change = make_manifold(c.mesh.nodes, c.mesh.tetrahedra);
    for (const std::int32_t t : change.tetrahedron_from)
      c.mesh.region.push_back(std::int32_t(c.mesh.region[to_index(t)]));
    report_.split_nodes = change.copies;
    report_.filled_tips = change.filled_tips;
    if (change.node_from.empty()) return;
    note(request_.log,
         text("the boundary touched itself: ", counted(change.copies, "node"), " separated, ",
              counted(change.halved_edges, "edge"), " halved, the tip of ",
              counted(change.filled_tips, "void"), " filled"));
  }

  void measure(Candidate& c) {
    report_.quality = measure_quality(c.mesh.nodes, c.mesh.tetrahedra);
    report_.volume_of_domain = volume_;
    report_.volume_change = report_.quality.volume / volume_ - 1;
    if (c.mesh.tetrahedra.empty()) return;
    const std::vector<Triangle> facets = interface_facets(c.mesh);
    const auto farther = [](double distance, const Vec3& x, double& largest, Vec3& at) {
      if (distance <= largest) return;
      largest = distance;
      at = x;
    };
    for (const Triangle& t : facets) {
      const Vec3 centre = (1.0 / 3) * (c.mesh.nodes[to_index(t[0])] + c.mesh.nodes[to_index(t[1])] +
                                       c.mesh.nodes[to_index(t[2])]);
      farther(request_.oracle.distance(centre), centre, report_.distance_to_surface,
              report_.distance_to_surface_at);
    }
    const TriangleCloud cloud(c.mesh.nodes, facets);
    const double spacing = kProbeSpacing * request_.element_size;
    for (const Crossing& probe : request_.oracle.seeds([&](const Vec3&) { return spacing; })) {
      farther(norm(cloud.closest(probe.point) - probe.point), probe.point, report_.distance_to_mesh,
              report_.distance_to_mesh_at);
    }
  }

  [[noreturn]] void refuse_mesh(const std::string& problem) const {
    refuse_geometry(request_.where, text("Delaunay refinement: ", problem),
                    "reduce element_size, or repair the surface at this place");
  }

  void check(const Candidate& c) const {
    if (c.mesh.tetrahedra.empty()) refuse_mesh("no tetrahedron lies inside the surface");
    if (c.cut_short) {
      refuse_mesh(text("refinement does not end: stopped with ", c.mesh.nodes.size(), " nodes",
                       c.faults.lost.empty() ? std::string()
                                             : text("; the surface is not yet followed at ",
                                                    request_.place(c.faults.lost.front()))));
    }
    if (report_.removed_fraction > kNegligible) {
      refuse_mesh(text(100 * report_.removed_fraction,
                       " % of the body is connected to the rest by no facet, near ",
                       request_.place(c.faults.islands.front())));
    }
    const auto pinched = pinches(adjacency(c.mesh.tetrahedra).boundary).nodes;
    if (!pinched.empty()) {
      refuse_mesh(text("the boundary of the mesh touches itself at ",
                       counted(pinched.size(), "node"), ", one of them at ",
                       request_.place(c.mesh.nodes[to_index(pinched.front())])));
    }
    if (!(std::abs(report_.volume_change) <= request_.most_volume_change)) {
      refuse_mesh(text("the volume of the mesh differs from that of the surface by ",
                       100 * report_.volume_change, " %; the surface is farthest from it at ",
                       request_.place(report_.distance_to_mesh_at)));
    }
    if (report_.quality.largest_dihedral > request_.largest_dihedral) {
      refuse_mesh(text(
          "a dihedral angle of ", report_.quality.largest_dihedral, " degrees",
          c.faults.flat.empty() ? std::string() : " at " + request_.place(c.faults.flat.front())));
    }
  }

  MeshRequest request_;
  DelaunayReport& report_;
  double volume_;
  double distance_factor_ = 1;  // on the distance of facets from the interface
  double facet_angle_ = kFacetAngles.front();
  double excess_ = kExcess;
};

}  // namespace

VolumeMesh refine_until_sound(MeshRequest request, DelaunayReport& report) {
  return Attempts(std::move(request), report).run();
}

}  // namespace palpate::mesher
