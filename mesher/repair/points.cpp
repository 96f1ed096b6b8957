// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/points.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace palpate::mesher {
namespace {

using Polygon = std::vector<std::size_t>;
using SoupEdge = std::pair<std::size_t, std::size_t>;

// Points nearer than this fraction of the extent are one point whose copies differ by noise.
constexpr double kNoise = 5e-5;
// Merging must not collapse the mesh: points of edges shorter than this multiple stay apart.
constexpr double kShortestEdge = 4;

/// Number of polygons at each undirected edge.
std::map<SoupEdge, int> edge_counts(const Soup& soup) {
  std::map<SoupEdge, int> count;
  for (const Polygon& corners : soup.polygons)
    for (std::size_t k = 0; k < corners.size(); ++k)
      ++count[std::minmax(corners[k], corners[(k + 1) % corners.size()])];
  return count;
}

/// The points of edges with one polygon, by their first coordinate.
std::vector<std::size_t> border_points(const Soup& soup, const std::map<SoupEdge, int>& edges) {
  std::vector<std::size_t> points;
  for (const auto& [edge, count] : edges)
    if (count == 1) points.insert(points.end(), {edge.first, edge.second});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(soup.points[a][0], a) < std::pair(soup.points[b][0], b);
  });
  return points;
}

double shortest_edge(const Soup& soup, const std::map<SoupEdge, int>& edges) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [edge, count] : edges) {
    const double length = norm(soup.points[edge.first] - soup.points[edge.second]);
    if (length > 0) shortest = std::min(shortest, length);
  }
  return shortest;
}

/// Pairs (point, earlier point nearer than `apart`) of `border`, which is sorted.
std::map<std::size_t, std::size_t> near_pairs(const Soup& soup,
                                              const std::vector<std::size_t>& border,
                                              double apart) {
  std::map<std::size_t, std::size_t> target;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Vec3& x = soup.points[border[i]];
    if (target.contains(border[i])) continue;
    for (std::size_t k = i + 1; k < border.size(); ++k) {
      const Vec3& y = soup.points[border[k]];
      if (y[0] - x[0] > apart) break;
      if (norm(x - y) <= apart) target.emplace(border[k], border[i]);
    }
  }
  return target;
}

/// Points of `border` in the interior of the edge from a to b, in this order.
class EdgePoints {
 public:
  EdgePoints(const Soup& soup, const std::vector<std::size_t>& border, double apart)
      : soup_(soup), border_(border), apart_(apart) {}

  std::vector<std::size_t> between(std::size_t a, std::size_t b) const {
    const Vec3 &p = soup_.points[a], &q = soup_.points[b];
    const Vec3 d = q - p;
    const double length2 = dot(d, d);
    if (length2 == 0) return {};
    const double first = std::min(p[0], q[0]) - apart_, last = std::max(p[0], q[0]) + apart_;
    std::vector<std::pair<double, std::size_t>> found;
    for (auto v = std::lower_bound(
             border_.begin(), border_.end(), first,
             [&](std::size_t point, double x) { return soup_.points[point][0] < x; });
         v != border_.end() && soup_.points[*v][0] <= last; ++v) {
      if (*v == a || *v == b) continue;
      const Vec3 r = soup_.points[*v] - p;
      const double t = dot(r, d) / length2;
      if (t <= 1e-6 || t >= 1 - 1e-6) continue;
      if (norm(r - t * d) <= apart_) found.emplace_back(t, *v);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> result;
    for (const auto& [t, v] : found) result.push_back(v);
    return result;
  }

 private:
  const Soup& soup_;
  const std::vector<std::size_t>& border_;
  double apart_;
};

}  // namespace

void merge_near_points(Soup& soup, double extent, Steps& steps) {
  const auto edges = edge_counts(soup);
  const double apart = std::min(kNoise * extent, shortest_edge(soup, edges) / kShortestEdge);
  const auto target = near_pairs(soup, border_points(soup, edges), apart);
  if (target.empty()) return;
  for (Polygon& corners : soup.polygons)
    for (std::size_t& v : corners)
      if (const auto found = target.find(v); found != target.end()) v = found->second;
  steps.push_back(text("merged ", counted(target.size(), "point"), " less than ",
                       millimetres(apart), " apart"));
}

void split_t_junctions(Soup& soup, double extent, Steps& steps) {
  const auto edges = edge_counts(soup);
  const std::vector<std::size_t> border = border_points(soup, edges);
  const EdgePoints points(soup, border, kNoise * extent);
  std::size_t split = 0;
  for (Polygon& corners : soup.polygons) {
    Polygon result;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::size_t a = corners[k], b = corners[(k + 1) % corners.size()];
      result.push_back(a);
      if (edges.at(std::minmax(a, b)) != 1) continue;
      const std::vector<std::size_t> inside = points.between(a, b);
      result.insert(result.end(), inside.begin(), inside.end());
      split += inside.size();
    }
    corners = std::move(result);
  }
  if (split > 0) steps.push_back("split " + counted(split, "T-junction"));
}

}  // namespace palpate::mesher
