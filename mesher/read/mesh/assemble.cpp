// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/read/body_size.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/mesh/mid_nodes.hpp"
#include "mesher/read/mesh/separate_sheets.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

/// A tetrahedron of less volume, in parts of the cube of its longest edge, has no orientation.
constexpr double kFlatTetrahedron = 1e-12;

void check_shapes(const MeshEntities& entities, const std::string& where) {
  if (!entities.other_solids.empty()) {
    std::string list;
    for (const auto& [shape, count] : entities.other_solids)
      list += text(list.empty() ? "" : ", ", count, " ", shape);
    refuse_geometry(where, text("volume elements that are no tetrahedra: ", list),
                    "mesh the body with tetrahedra, or split them (ParaView: Tetrahedralize)");
  }
  if (entities.tetrahedra.empty()) {
    refuse_geometry(where, "the file has no tetrahedra",
                    "give a volume mesh; a surface belongs in [surface]");
  }
}

void scale_to_metres(MeshEntities& entities, double unit, const std::string& where,
                     const Log& log) {
  for (std::size_t i = 0; i < entities.nodes.size(); ++i) {
    const Vec3& x = entities.nodes[i];
    if (is_finite(x)) continue;
    refuse_geometry(where,
                    text("node ", entities.node_numbers[i],
                         " has a coordinate that is not finite (NaN or Inf)"),
                    "correct the coordinates or export the file again");
  }
  std::vector<Vec3> corners;
  for (const ListedTetrahedron& t : entities.tetrahedra)
    for (std::size_t k = 0; k < 4; ++k) corners.push_back(entities.nodes[to_index(t.nodes[k])]);
  check_body_size(largest_dimension(corners), unit, where, log);
  for (Vec3& x : entities.nodes) x = unit * x;
}

Tetrahedron corners_of(const ListedTetrahedron& t) {
  return {t.nodes[0], t.nodes[1], t.nodes[2], t.nodes[3]};
}

Vec3 centroid(const MeshEntities& entities, const ListedTetrahedron& t) {
  Vec3 sum{};
  for (std::size_t k = 0; k < 4; ++k) sum = sum + entities.nodes[to_index(t.nodes[k])];
  return 0.25 * sum;
}

double longest_edge(const MeshEntities& entities, const ListedTetrahedron& t) {
  double longest = 0;
  for (const auto& [a, b] : kTetrahedronEdges)
    longest = std::max(
        longest, norm(entities.nodes[to_index(t.nodes[a])] - entities.nodes[to_index(t.nodes[b])]));
  return longest;
}

/// Exchanges corners 1 and 2, and the mid-nodes with them.
void turn(ListedTetrahedron& t) {
  std::swap(t.nodes[1], t.nodes[2]);
  std::swap(t.nodes[4], t.nodes[6]);
  std::swap(t.nodes[8], t.nodes[9]);
}

void orient(MeshEntities& entities, const std::string& where, const Log& log) {
  std::size_t turned = 0;
  for (ListedTetrahedron& t : entities.tetrahedra) {
    const double longest = longest_edge(entities, t);
    const double size = volume(entities.nodes, corners_of(t));
    if (!(std::abs(size) > kFlatTetrahedron * longest * longest * longest)) {
      refuse_geometry(where,
                      text("tetrahedron ", t.number, " at ", position_text(centroid(entities, t)),
                           " has no volume"),
                      "remove degenerate elements or mesh the body again");
    }
    if (size > 0) continue;
    turn(t);
    ++turned;
  }
  if (turned > 0) {
    note(log, text(where, ": turned ", counted(turned, "tetrahedron", "tetrahedra"),
                   " of negative volume"));
  }
}

void check_repetition(const MeshEntities& entities, const std::string& where) {
  std::vector<std::pair<Tetrahedron, std::size_t>> sorted;
  for (std::size_t i = 0; i < entities.tetrahedra.size(); ++i) {
    Tetrahedron corners = corners_of(entities.tetrahedra[i]);
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::size_t repeated = 0, first = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first && repeated++ == 0) first = i;
  if (repeated == 0) return;
  const ListedTetrahedron& t = entities.tetrahedra[sorted[first].second];
  refuse_geometry(
      where,
      text(counted(repeated, "tetrahedron", "tetrahedra"), " listed twice: first number ", t.number,
           ", a copy of ", entities.tetrahedra[sorted[first - 1].second].number, ", at ",
           position_text(centroid(entities, t))),
      "remove the copies; an element in several groups belongs in one region only");
}

bool has_coincident_nodes(const MeshEntities& entities) {
  std::vector<std::int32_t> used;
  for (const ListedTetrahedron& t : entities.tetrahedra)
    used.insert(used.end(), t.nodes.begin(), t.nodes.begin() + 4);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Vec3> places;
  for (const std::int32_t node : used) places.push_back(entities.nodes[to_index(node)]);
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) != places.end();
}

void check_parts(const MeshEntities& entities, const Adjacency& joined, const std::string& where) {
  if (joined.parts == 1) return;
  std::vector<std::size_t> size(to_index(joined.parts), 0), first(size);
  for (std::size_t t = joined.part.size(); t-- > 0;) {
    ++size[to_index(joined.part[t])];
    first[to_index(joined.part[t])] = t;
  }
  const auto smallest =
      static_cast<std::size_t>(std::min_element(size.begin(), size.end()) - size.begin());
  refuse_geometry(
      where,
      text("the tetrahedra form ", joined.parts,
           " parts that no common face joins; the smallest has ",
           counted(size[smallest], "tetrahedron", "tetrahedra"), ", at ",
           position_text(centroid(entities, entities.tetrahedra[first[smallest]]))),
      has_coincident_nodes(entities)
          ? "merge the nodes of equal coordinates (Gmsh: Coherence Mesh; meshes that share faces)"
          : "keep one part for each file");
}

/// @return the boundary facets
std::vector<Triangle> checked_boundary(const MeshEntities& entities, const std::string& where,
                                       const Log& log) {
  std::vector<Tetrahedron> tetrahedra;
  for (const ListedTetrahedron& t : entities.tetrahedra) tetrahedra.push_back(corners_of(t));
  const Adjacency joined = adjacency(tetrahedra);
  const auto place = [&](std::int32_t node) {
    return position_text(entities.nodes[to_index(node)]);
  };
  if (joined.overlap) {
    refuse_geometry(where,
                    text("tetrahedra overlap at ", counted(joined.overlaps, "face"),
                         ", the first at ", place((*joined.overlap)[0])),
                    "mesh the body again: a face separates at most two elements");
  }
  check_parts(entities, joined, where);
  if (const Pinches found = pinches(joined.boundary); !found.nodes.empty()) {
    refuse_geometry(
        where,
        text("the boundary is not manifold: sheets meet in ", counted(found.edges.size(), "edge"),
             " and in ", counted(found.points, "point"), ", the first at ",
             place(found.nodes.front())),
        "add elements there, or mesh the body again");
  }
  if (const std::size_t shells = components(joined.boundary); shells > 1) {
    note(log, text(where, ": the body has ", counted(shells - 1, "cavity", "cavities")));
  }
  return joined.boundary;
}

/// Nodes that are corners, in the order of the file: the new index of each node, or -1.
std::vector<std::int32_t> keep_corners(const MeshEntities& entities, VolumeMesh& mesh) {
  std::vector<std::int32_t> kept(entities.nodes.size(), -1);
  for (const ListedTetrahedron& t : entities.tetrahedra)
    for (std::size_t k = 0; k < 4; ++k) kept[to_index(t.nodes[k])] = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] < 0) continue;
    kept[i] = static_cast<std::int32_t>(mesh.nodes.size());
    mesh.nodes.push_back(entities.nodes[i]);
  }
  return kept;
}

/// Regions that have elements, in the order in which the file names them.
void set_regions(const MeshEntities& entities, VolumeMesh& mesh) {
  std::vector<std::int32_t> kept(entities.region_names.size(), -1);
  for (const ListedTetrahedron& t : entities.tetrahedra) kept[to_index(t.region)] = 0;
  for (std::size_t r = 0; r < kept.size(); ++r) {
    if (kept[r] < 0) continue;
    kept[r] = static_cast<std::int32_t>(mesh.region_names.size());
    mesh.region_names.push_back(entities.region_names[r]);
  }
  for (const ListedTetrahedron& t : entities.tetrahedra)
    mesh.region.push_back(kept[to_index(t.region)]);
}

void sort_set(std::vector<std::int32_t>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

void set_node_sets(const MeshEntities& entities, const std::vector<std::int32_t>& kept,
                   VolumeMesh& mesh, const std::string& where, const Log& log) {
  for (const auto& [name, listed] : entities.node_sets) {
    std::vector<std::int32_t> nodes;
    for (const std::int32_t node : listed)
      if (kept[to_index(node)] >= 0) nodes.push_back(kept[to_index(node)]);
    sort_set(nodes);
    if (nodes.empty()) {
      note(log, text(where, ": no corner of a tetrahedron is in the set '", name, "'; dropped"));
    } else {
      mesh.node_sets.emplace(name, std::move(nodes));
    }
  }
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    if (mesh.node_sets.contains(mesh.region_names[r])) continue;
    auto& nodes = mesh.node_sets[mesh.region_names[r]];
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      if (to_index(mesh.region[t]) == r)
        nodes.insert(nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
    sort_set(nodes);
  }
}

std::string summary(const MeshEntities& entities, const VolumeMesh& mesh) {
  const auto quadratic = std::count_if(entities.tetrahedra.begin(), entities.tetrahedra.end(),
                                       [](const ListedTetrahedron& t) { return t.quadratic; });
  std::string line = text(counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra"), " (",
                          quadratic, " quadratic), ", counted(mesh.nodes.size(), "corner node"),
                          ", ", counted(mesh.curved_edges.size(), "curved edge"), "; regions:");
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r)
    line += text(r == 0 ? " " : ", ", mesh.region_names[r], " (",
                 std::count(mesh.region.begin(), mesh.region.end(), static_cast<int>(r)), ")");
  line += "; sets:";
  for (const auto& [name, nodes] : mesh.node_sets)
    line += text(" ", name, " (", counted(nodes.size(), "node"), ")");
  return line;
}

}  // namespace

VolumeMesh assemble(MeshEntities entities, double unit, const std::string& where, const Log& log) {
  check_shapes(entities, where);
  scale_to_metres(entities, unit, where, log);
  orient(entities, where, log);
  check_repetition(entities, where);
  separate_sheets(entities, where, log);
  const std::vector<Triangle> boundary = checked_boundary(entities, where, log);
  VolumeMesh mesh;
  mesh.curved_edges = curved_boundary_edges(entities, boundary, where, log);
  const std::vector<std::int32_t> kept = keep_corners(entities, mesh);
  for (const ListedTetrahedron& t : entities.tetrahedra) {
    Tetrahedron corners = corners_of(t);
    for (std::int32_t& node : corners) node = kept[to_index(node)];
    mesh.tetrahedra.push_back(corners);
  }
  // The order of the nodes stays, so ascending ends stay ascending.
  for (CurvedEdge& edge : mesh.curved_edges)
    for (std::int32_t& node : edge.ends) node = kept[to_index(node)];
  set_regions(entities, mesh);
  set_node_sets(entities, kept, mesh, where, log);
  note(log, text(where, ": ", summary(entities, mesh)));
  return mesh;
}

}  // namespace palpate::mesher
