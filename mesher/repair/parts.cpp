// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/union_find.hpp"

namespace palpate::mesher {
namespace {

// Parts whose area is less than this fraction of the largest are negligible.
constexpr double kNegligibleArea = 0.01;

struct Part {
  Surface surface;
  double size = 0;  ///< m, its largest dimension
  double area = 0;  ///< m^2
};

/// The connected parts, the largest area first.
std::vector<Part> parts_of(const Surface& surface) {
  UnionFind joined(surface.points.size());
  for (const Triangle& t : surface.triangles) {
    joined.join(to_index(t[0]), to_index(t[1]));
    joined.join(to_index(t[0]), to_index(t[2]));
  }
  std::map<std::size_t, Surface> surfaces;
  std::vector<std::int32_t> number(surface.points.size());
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    Surface& part = surfaces[joined.root(v)];
    number[v] = static_cast<std::int32_t>(part.points.size());
    part.points.push_back(surface.points[v]);
  }
  for (const Triangle& t : surface.triangles)
    surfaces[joined.root(to_index(t[0]))].triangles.push_back(
        {number[to_index(t[0])], number[to_index(t[1])], number[to_index(t[2])]});
  std::vector<Part> parts;
  for (auto& [root, part] : surfaces) {
    if (part.triangles.empty()) continue;  // a point of no triangle
    const double size = largest_dimension(part.points), faces = area(part);
    parts.push_back({std::move(part), size, faces});
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.area > b.area; });
  return parts;
}

bool is_open(const Surface& surface) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[std::minmax(t[k], t[(k + 1) % 3])];
  return std::any_of(sides.begin(), sides.end(), [](const auto& side) { return side.second != 2; });
}

std::string described(const Part& p) {
  return text(extent_of(p.surface.points), ", ", 1e6 * p.area, " mm^2, ",
              is_open(p.surface) ? std::string("open")
                                 : text(1e9 * std::abs(signed_volume(p.surface)), " mm^3"));
}

[[noreturn]] void refuse_parts(const std::vector<Part>& parts, const std::string& where) {
  constexpr std::size_t kListed = 4;
  std::string list;
  for (std::size_t i = 0; i < std::min(parts.size(), kListed); ++i)
    list += (i > 0 ? "; " : "") + described(parts[i]);
  FaultyFaces faulty;
  for (std::size_t i = 1; i < parts.size(); ++i)
    for (const Triangle& t : parts[i].surface.triangles)
      faulty.add(parts[i].surface, t, Fault::SeparatePart);
  throw FaultySurface(
      where,
      text("the surface has ", parts.size(), " separate parts, the largest first: ", list,
           parts.size() > kListed ? "; ..." : ""),
      "set surface.parts = \"largest\" or surface.repair = \"wrap\", or keep one part for each "
      "file and give inner parts as inclusions",
      faulty);
}

}  // namespace

double largest_fraction(const Surface& surface) {
  double all = 0, largest = 0;
  for (const Part& p : parts_of(surface)) {
    all += p.area;
    largest = std::max(largest, p.area);
  }
  return all > 0 ? largest / all : 0;
}

std::vector<std::string> describe_parts(const Surface& surface) {
  std::vector<std::string> parts;
  for (const Part& p : parts_of(surface)) parts.push_back(described(p));
  return parts;
}

void keep_parts(Surface& surface, const RepairSettings& settings, double extent,
                const std::string& where, Steps& steps) {
  std::vector<Part> kept;
  std::size_t removed = 0;
  double largest = 0;
  for (Part& p : parts_of(surface)) {
    const bool is_negligible = !kept.empty() && (p.size < settings.negligible_part * extent ||
                                                 p.area < kNegligibleArea * kept.front().area);
    if (is_negligible || (!kept.empty() && settings.largest_part)) {
      ++removed;
      largest = std::max(largest, p.size);
    } else {
      kept.push_back(std::move(p));
    }
  }
  if (kept.size() > 1) refuse_parts(kept, where);
  if (removed == 0) return;
  surface = std::move(kept.front().surface);
  steps.push_back(text("removed ", counted(removed, "separate part"), ", the largest of ",
                       millimetres(largest)));
}

}  // namespace palpate::mesher
