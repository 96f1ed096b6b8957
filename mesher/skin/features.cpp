// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/features.hpp"

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <cmath>
#include <map>
#include <numbers>

#include "mesher/geometry/union_find.hpp"

namespace palpate::mesher {
namespace {

double length(const Mesh& mesh, Mesh::Edge_index edge) {
  const auto h = mesh.halfedge(edge);
  return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
}

/// Unflags connected fragments of sharp edges shorter than `shortest`. Returns the edges unflagged.
std::size_t drop_short_features(const Mesh& mesh, EdgeFlags sharp, double shortest) {
  UnionFind joined(mesh.number_of_vertices());
  const auto root = [&](Mesh::Edge_index e) {
    return joined.root(mesh.source(mesh.halfedge(e)).idx());
  };
  for (const auto e : mesh.edges()) {
    if (!sharp[e]) continue;
    const auto h = mesh.halfedge(e);
    joined.join(mesh.source(h).idx(), mesh.target(h).idx());
  }
  std::map<std::size_t, double> total;
  for (const auto e : mesh.edges()) {
    if (sharp[e]) total[root(e)] += length(mesh, e);
  }
  std::size_t dropped = 0;
  for (const auto e : mesh.edges()) {
    if (sharp[e] && total[root(e)] < shortest) {
      sharp[e] = false;
      ++dropped;
    }
  }
  return dropped;
}

}  // namespace

EdgeFlags flag_sharp_edges(Mesh& mesh, double angle, double spacing, std::size_t& dropped) {
  EdgeFlags sharp = mesh.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
  CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, angle * 180 / std::numbers::pi, sharp);
  dropped = drop_short_features(mesh, sharp, kShortestFeature * spacing);
  return sharp;
}

}  // namespace palpate::mesher
