// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/soup.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/error.hpp"
#include "mesher/geometry/soup_edges.hpp"

namespace palpate::mesher {
namespace {

SoupEdge sorted_edge(std::size_t a, std::size_t b) {
  return {std::min(a, b), std::max(a, b)};
}

bool runs_along(const std::vector<std::size_t>& corners, const SoupEdge& edge) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (corners[k] == edge.first && corners[(k + 1) % corners.size()] == edge.second) return true;
  }
  return false;
}

std::size_t merge_equal_points(Soup& soup) {
  std::map<Vec3, std::size_t> first;
  std::vector<std::size_t> target(soup.points.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const auto [entry, is_new] = first.try_emplace(soup.points[i], points.size());
    if (is_new) points.push_back(soup.points[i]);
    target[i] = entry->second;
  }
  const std::size_t merged = soup.points.size() - points.size();
  for (auto& corners : soup.polygons) {
    for (std::size_t& v : corners) v = target[v];
  }
  soup.points = std::move(points);
  return merged;
}

/// Points of edges that have one polygon.
std::vector<std::size_t> border_points(const Soup& soup) {
  std::vector<std::size_t> result;
  for (const auto& [edge, polygons] : polygons_of_edges(soup))
    if (polygons.size() == 1) result.insert(result.end(), {edge.first, edge.second});
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// The rounding error of coordinates printed with six digits or stored as floats.
double rounding(const Soup& soup) {
  constexpr double kDigits = 2e-6;
  double largest = 0;
  for (const Vec3& x : soup.points)
    for (const double coordinate : x) largest = std::max(largest, std::abs(coordinate));
  return kDigits * largest;
}

/// Points of the border that differ by rounding become the first of them: a program that computes a
/// corner twice, once for each side of a seam, need not print it alike. Points inside the surface
/// are left alone, so that a surface without borders stays as it is to the last bit.
std::size_t close_seams(Soup& soup) {
  std::vector<std::size_t> border = border_points(soup);
  const double apart = rounding(soup);
  std::sort(border.begin(), border.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(soup.points[a][0], a) < std::pair(soup.points[b][0], b);
  });
  std::map<std::size_t, std::size_t> target;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Vec3& x = soup.points[border[i]];
    if (target.contains(border[i])) continue;
    for (std::size_t k = i + 1; k < border.size(); ++k) {
      if (soup.points[border[k]][0] - x[0] > apart) break;
      if (norm(soup.points[border[k]] - x) <= apart) target.emplace(border[k], border[i]);
    }
  }
  for (auto& corners : soup.polygons)
    for (std::size_t& v : corners)
      if (const auto found = target.find(v); found != target.end()) v = found->second;
  return target.size();
}

/// Equal corners in a row count once; a polygon left with fewer than three encloses nothing.
std::size_t drop_collapsed_polygons(Soup& soup) {
  for (auto& corners : soup.polygons) {
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  }
  if (!soup.names.empty()) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < soup.polygons.size(); ++p)
      if (soup.polygons[p].size() >= 3) soup.names[count++] = soup.names[p];
    soup.names.resize(count);
  }
  return std::erase_if(soup.polygons, [](const auto& corners) { return corners.size() < 3; });
}

std::size_t drop_unused_points(Soup& soup) {
  constexpr auto unused = static_cast<std::size_t>(-1);
  std::vector<std::size_t> target(soup.points.size(), unused);
  std::vector<Vec3> points;
  for (auto& corners : soup.polygons) {
    for (std::size_t& v : corners) {
      if (target[v] == unused) {
        target[v] = points.size();
        points.push_back(soup.points[v]);
      }
      v = target[v];
    }
  }
  const std::size_t dropped = soup.points.size() - points.size();
  soup.points = std::move(points);
  return dropped;
}

}  // namespace

PolygonsOfEdges polygons_of_edges(const Soup& soup) {
  PolygonsOfEdges result;
  for (std::size_t p = 0; p < soup.polygons.size(); ++p) {
    const auto& corners = soup.polygons[p];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      result[sorted_edge(corners[k], corners[(k + 1) % corners.size()])].push_back(p);
    }
  }
  return result;
}

std::vector<std::size_t> pinched_points(const Soup& soup, const PolygonsOfEdges& edges) {
  std::vector<std::vector<std::size_t>> around(soup.points.size());
  for (std::size_t p = 0; p < soup.polygons.size(); ++p) {
    for (const std::size_t v : soup.polygons[p]) around[v].push_back(p);
  }
  std::vector<std::size_t> pinched;
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    std::vector<std::size_t> fan{around[v].front()};
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const auto& corners = soup.polygons[fan[i]];
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const SoupEdge edge = sorted_edge(corners[k], corners[(k + 1) % corners.size()]);
        if (edge.first != v && edge.second != v) continue;
        for (const std::size_t q : edges.at(edge)) {
          if (std::find(fan.begin(), fan.end(), q) == fan.end()) fan.push_back(q);
        }
      }
    }
    if (fan.size() != around[v].size()) pinched.push_back(v);
  }
  return pinched;
}

std::vector<SoupEdge> discordant_edges(const Soup& soup, const PolygonsOfEdges& edges) {
  std::vector<SoupEdge> result;
  for (const auto& [edge, polygons] : edges)
    if (polygons.size() == 2 && runs_along(soup.polygons[polygons[0]], edge) ==
                                    runs_along(soup.polygons[polygons[1]], edge))
      result.push_back(edge);
  return result;
}

FaultyFaces faces_at_edges(const Soup& soup, const PolygonsOfEdges& edges) {
  FaultyFaces faulty;
  for (const auto& [edge, polygons] : edges) {
    if (polygons.size() == 2) continue;
    const Fault fault = polygons.size() == 1 ? Fault::BorderEdge : Fault::NonManifoldEdge;
    for (const std::size_t p : polygons) faulty.add(soup.points, soup.polygons[p], fault);
  }
  return faulty;
}

FaultyFaces faces_at_points(const Soup& soup, const std::vector<std::size_t>& points) {
  FaultyFaces faulty;
  for (const auto& corners : soup.polygons)
    if (std::find_first_of(corners.begin(), corners.end(), points.begin(), points.end()) !=
        corners.end())
      faulty.add(soup.points, corners, Fault::NonManifoldPoint);
  return faulty;
}

void tidy(Soup& soup, const std::string& where, const Log& log) {
  if (const std::size_t n = merge_equal_points(soup); n > 0) {
    note(log, text(where, ": merged ", counted(n, "duplicate point"), " of equal coordinates"));
  }
  if (const std::size_t n = close_seams(soup); n > 0) {
    note(log, text(where, ": closed a seam: merged ", counted(n, "point"),
                   " of its border with others at most ", millimetres(rounding(soup)), " away"));
  }
  if (const std::size_t n = drop_collapsed_polygons(soup); n > 0) {
    note(log,
         text(where, ": dropped ", counted(n, "face"), " with fewer than three distinct corners"));
  }
  if (const std::size_t n = drop_unused_points(soup); n > 0) {
    note(log, text(where, ": dropped ", counted(n, "point"), " of no face"));
  }
}

void check_entries(const Soup& soup, const std::string& where) {
  if (soup.polygons.empty()) {
    refuse_geometry(where, "the file has no faces",
                    "export the surface again as a triangulated surface");
  }
  std::size_t short_faces = 0, bad_faces = 0, bad_points = 0, first_bad_point = 0;
  for (const auto& corners : soup.polygons) {
    if (corners.size() < 3) ++short_faces;
    if (std::any_of(corners.begin(), corners.end(),
                    [&](std::size_t v) { return v >= soup.points.size(); })) {
      ++bad_faces;
    }
  }
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const Vec3& x = soup.points[i];
    if (is_finite(x)) continue;
    if (bad_points++ == 0) first_bad_point = i;
  }
  if (short_faces > 0) {
    refuse_geometry(where, counted(short_faces, "face") + " with fewer than three indices",
                    "remove them or export the surface again");
  }
  if (bad_faces > 0) {
    refuse_geometry(where,
                    text(counted(bad_faces, "face"), " with an index outside the ",
                         soup.points.size(), " vertices of the file"),
                    "the file is damaged: export the surface again");
  }
  if (bad_points > 0) {
    refuse_geometry(
        where,
        text(counted(bad_points, "point"), " with a coordinate that is not finite (NaN or Inf), ",
             bad_points > 1 ? "the first of them " : "", "number ", first_bad_point + 1,
             " of the file"),
        "correct the coordinates or export the surface again");
  }
}

void check_manifold(const Soup& soup, const std::string& where) {
  const auto edges = polygons_of_edges(soup);
  std::size_t border = 0, crowded = 0;
  for (const auto& [edge, polygons] : edges) {
    if (polygons.size() == 1) ++border;
    if (polygons.size() > 2) ++crowded;
  }
  if (crowded > 0) {
    throw FaultySurface(
        where,
        text("the surface is not manifold: ", counted(crowded, "edge"), " with more than two faces",
             border > 0 ? text(" (and ", counted(border, "border edge"), ")") : ""),
        "remove duplicate and inner faces in a mesh editor", faces_at_edges(soup, edges));
  }
  if (border > 0) {
    throw FaultySurface(
        where, "the surface is not watertight: " + counted(border, "border edge"),
        "close its holes in a mesh editor; where they are seams whose points do not meet, merge "
        "vertices there",
        faces_at_edges(soup, edges));
  }
  if (const auto pinched = pinched_points(soup, edges); !pinched.empty()) {
    throw FaultySurface(
        where,
        text("the surface is not manifold: sheets meet only in ", counted(pinched.size(), "point"),
             ", the first of them at ", position_text(soup.points[pinched.front()])),
        "separate the sheets or join them along an edge in a mesh editor",
        faces_at_points(soup, pinched));
  }
}

void orient(Soup& soup, const std::string& where, const Log& log) {
  const auto edges = polygons_of_edges(soup);
  std::vector<int> side(soup.polygons.size(), 0);  // +1 as listed, -1 to be reversed
  std::size_t parts = 0, turned = 0;
  for (std::size_t seed = 0; seed < side.size(); ++seed) {
    if (side[seed] != 0) continue;
    ++parts;
    side[seed] = 1;
    std::vector<std::size_t> front{seed};
    std::size_t negative = 0;
    for (std::size_t i = 0; i < front.size(); ++i) {
      const std::size_t p = front[i];
      const auto& corners = soup.polygons[p];
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const SoupEdge edge{corners[k], corners[(k + 1) % corners.size()]};
        const auto& pair = edges.at(sorted_edge(edge.first, edge.second));
        const std::size_t q = pair[0] == p ? pair[1] : pair[0];
        // Neighbours agree when they run along their common edge in opposite directions.
        const int wanted = runs_along(soup.polygons[q], edge) ? -side[p] : side[p];
        if (side[q] == 0) {
          side[q] = wanted;
          front.push_back(q);
          if (wanted < 0) ++negative;
        } else if (side[q] != wanted) {
          refuse_geometry(where, "the surface has no consistent orientation (it is one-sided)",
                          "only a surface that encloses a volume can be filled");
        }
      }
    }
    turned += std::min(negative, front.size() - negative);
  }
  if (parts > 1) {
    refuse_geometry(where, text("the surface has ", parts, " separate parts"),
                    "keep one part for each file; give an inner part as an inclusion");
  }
  for (std::size_t p = 0; p < side.size(); ++p) {
    if (side[p] < 0) std::reverse(soup.polygons[p].begin(), soup.polygons[p].end());
  }
  if (turned > 0) {
    note(log, text(where, ": reoriented ", counted(turned, "face"), " to match the others"));
  }
}

}  // namespace palpate::mesher
