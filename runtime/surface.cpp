// SPDX-License-Identifier: Apache-2.0
#include "runtime/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "format/error.hpp"

namespace palpate::runtime {
namespace {

constexpr std::size_t kMostKnots = 65535;
constexpr double kLeastDirection =
    0.5;  // |sum n_l u_l| below this: directions contradict each other

std::string triangle_name(std::size_t m) {
  return "library triangle " + std::to_string(m);
}

constexpr std::size_t kLine = 64;  // bytes that the processor fetches at once

void prefetch(const void* what, std::size_t bytes) noexcept {
  for (std::size_t i = 0; i < bytes; i += kLine) {
    __builtin_prefetch(static_cast<const char*>(what) + i);
  }
}

/// Distance of the origin from the segment a b.
double origin_to_segment(const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length2 = dot(edge, edge);
  const double s = length2 > 0 ? std::clamp(-dot(a, edge) / length2, 0.0, 1.0) : 0.0;
  return norm(a + s * edge);
}

/// Distance of the origin from the triangle a b c: the least |sum n_l u_l| over an element.
double origin_to_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double to_edges =
      std::min({origin_to_segment(a, b), origin_to_segment(b, c), origin_to_segment(c, a)});
  const Vec3 n = cross(b - a, c - a);
  const double length2 = dot(n, n);
  if (length2 <= 0) return to_edges;
  const Vec3 foot = (dot(a, n) / length2) * n;
  const bool inside = dot(cross(b - a, foot - a), n) >= 0 && dot(cross(c - b, foot - b), n) >= 0 &&
                      dot(cross(a - c, foot - c), n) >= 0;
  return inside ? norm(foot) : to_edges;
}

CompiledCurve coupling_of(const NodeResponse& response, std::size_t vertex) {
  const double base = static_cast<double>(response.coupling.base);
  if (!(std::isfinite(base) && base > 0)) {
    throw Error(ErrorKind::Configuration, "library vertex " + std::to_string(vertex),
                "the coupling does not start above 0", "fit the curves again");
  }
  return {response.coupling.curve, base};
}

}  // namespace

Surface::Surface(const Library& library) : elements_(library.triangles.size()) {
  const std::size_t count = library.positions.size();
  if (library.inward.size() != count || library.responses.size() != count) {
    throw Error(ErrorKind::Configuration, "library",
                "positions, directions and responses differ in number", "build it again");
  }
  build_nodes(library);
  for (std::size_t m = 0; m < elements_.size(); ++m) build_element(library, m);
  if (std::none_of(elements_.begin(), elements_.end(), [](const Element& e) { return e.active; })) {
    throw Error(ErrorKind::Configuration, "library",
                "no triangle has responses at its three vertices", "fit more sites");
  }
  connect();
  low_ = high_ = nodes_.front().position;
  for (const Vec3& p : library.positions) {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], p[i]);
      high_[i] = std::max(high_[i], p[i]);
    }
  }
}

void Surface::build_nodes(const Library& library) {
  struct Count {
    std::size_t normal = 0, lateral = 0, coupling = 0;
  };
  std::vector<Count> counts(library.responses.size());
  const auto append = [&](const CompiledCurve& curve) {
    for (const CompiledCurve::Piece& piece : curve.pieces()) pieces_.push_back(pack(piece));
    return curve.pieces().size();
  };
  for (std::size_t v = 0; v < counts.size(); ++v) {
    const NodeResponse& response = library.responses[v];
    if (response.status == ResponseStatus::Hole) continue;
    const CompiledCurve normal(response.normal);
    counts[v].normal = append(normal);
    counts[v].lateral = append(CompiledCurve(response.lateral));
    if (library.kind == ResponseKind::Coupled)
      counts[v].coupling = append(coupling_of(response, v));
    if (std::max({counts[v].normal, counts[v].lateral, counts[v].coupling}) > kMostKnots) {
      throw Error(ErrorKind::Configuration, "library vertex " + std::to_string(v),
                  "a response has more than " + std::to_string(kMostKnots) + " knots",
                  "fit with fewer");
    }
    deepest_ = std::max(deepest_, normal.last_knot());
  }
  nodes_.resize(counts.size());
  const PackedPiece* next = pieces_.data();
  for (std::size_t v = 0; v < counts.size(); ++v) {
    const auto [normal, lateral, coupling] = counts[v];
    nodes_[v] = {
        library.positions[v], library.inward[v],
        NodeCurves(next, static_cast<std::uint16_t>(normal), static_cast<std::uint16_t>(lateral),
                   static_cast<std::uint16_t>(coupling))};
    next += normal + lateral + coupling;
  }
}

void Surface::build_element(const Library& library, std::size_t m) {
  Element& e = elements_[m];
  e.vertices = library.triangles[m];
  e.active = true;
  for (const std::int32_t v : e.vertices) {
    if (v < 0 || static_cast<std::size_t>(v) >= nodes_.size()) {
      throw Error(ErrorKind::Configuration, triangle_name(m), "vertex index out of range",
                  "build it again");
    }
    e.active =
        e.active && library.responses[static_cast<std::size_t>(v)].status != ResponseStatus::Hole;
  }
  const Vec3 outward = cross(vertex(e, 1) - vertex(e, 0), vertex(e, 2) - vertex(e, 0));
  const double twice_area = norm(outward);
  const double longest =
      std::max({norm(vertex(e, 1) - vertex(e, 0)), norm(vertex(e, 2) - vertex(e, 1)),
                norm(vertex(e, 0) - vertex(e, 2))});
  if (!(twice_area > 1e-9 * longest * longest)) {
    throw Error(ErrorKind::Geometry, triangle_name(m), "it has no area",
                "remesh the response surface");
  }
  e.facet_normal = (-1.0 / twice_area) * outward;
  for (std::size_t l = 0; l < 3; ++l) {
    const Vec3 edge = vertex(e, (l + 2) % 3) - vertex(e, (l + 1) % 3);
    e.gradient[l] = (1.0 / twice_area) * cross(edge, e.facet_normal);
  }
  if (e.active) check_directions(m);
}

void Surface::check_directions(std::size_t m) const {
  const Element& e = elements_[m];
  const char* remedy = "refine the response surface there or smooth the inward directions";
  for (std::size_t l = 0; l < 3; ++l) {
    if (!(dot(inward(e, l), e.facet_normal) > 0)) {
      throw Error(ErrorKind::Geometry, triangle_name(m),
                  "the inward direction of vertex " + std::to_string(e.vertices[l]) +
                      " does not point to its inner side",
                  remedy);
    }
  }
  if (origin_to_triangle(inward(e, 0), inward(e, 1), inward(e, 2)) < kLeastDirection) {
    throw Error(ErrorKind::Geometry, triangle_name(m),
                "its inward directions differ too much to be interpolated", remedy);
  }
}

void Surface::connect() {
  struct Side {
    std::int32_t from, to;  // the edge as this triangle goes along it
    std::int32_t element;
    std::uint8_t opposite;  // local vertex
    auto edge() const { return std::pair(from, to); }
  };
  std::vector<Side> sides;
  sides.reserve(3 * elements_.size());
  for (std::size_t m = 0; m < elements_.size(); ++m) {
    for (std::size_t l = 0; l < 3; ++l) {
      const auto& v = elements_[m].vertices;
      sides.push_back({v[(l + 1) % 3], v[(l + 2) % 3], static_cast<std::int32_t>(m),
                       static_cast<std::uint8_t>(l)});
    }
  }
  const auto before = [](const Side& a, const Side& b) {
    return std::pair(a.edge(), a.element) < std::pair(b.edge(), b.element);
  };
  std::sort(sides.begin(), sides.end(), before);
  const auto same = [](const Side& a, const Side& b) { return a.edge() == b.edge(); };
  const auto twice = std::adjacent_find(sides.begin(), sides.end(), same);
  if (twice != sides.end()) {
    throw Error(ErrorKind::Geometry, triangle_name(static_cast<std::size_t>((twice + 1)->element)),
                "an edge is shared by three triangles or the orientation flips across it",
                "repair the response surface");
  }
  for (const Side& side : sides) {
    const Side wanted{side.to, side.from, -1, 0};
    const auto across = std::lower_bound(sides.begin(), sides.end(), wanted, before);
    if (across == sides.end() || across->edge() != wanted.edge()) continue;
    if (!element(across->element).active) continue;
    elements_[static_cast<std::size_t>(side.element)].neighbour[side.opposite] = across->element;
  }
}

void Surface::prefetch_around(std::int32_t m) const noexcept {
  const Element& e = element(m);
  for (std::size_t l = 0; l < 3; ++l) {
    if (e.neighbour[l] == kNoElement) continue;
    const Element& next = element(e.neighbour[l]);
    for (const std::int32_t beyond : next.neighbour) {
      if (beyond == kNoElement || beyond == m) continue;
      prefetch(&element(beyond), sizeof(Element));
    }
    const std::int32_t v = opposite_vertex(e, l);
    if (v >= 0) prefetch(&nodes_[static_cast<std::size_t>(v)], sizeof(SurfaceNode));
  }
}

void Surface::prefetch_curves_around(std::int32_t m) const noexcept {
  const Element& e = element(m);
  for (std::size_t l = 0; l < 3; ++l) {
    const std::int32_t v = opposite_vertex(e, l);
    if (v >= 0) nodes_[static_cast<std::size_t>(v)].curves.prefetch();
  }
}

/// The vertex of the neighbour across edge l that the element does not have; -1 at a border.
std::int32_t Surface::opposite_vertex(const Element& e, std::size_t l) const noexcept {
  if (e.neighbour[l] == kNoElement) return -1;
  const auto& theirs = element(e.neighbour[l]).vertices;
  // The sum of the three less the shared two.
  return theirs[0] + theirs[1] + theirs[2] - e.vertices[(l + 1) % 3] - e.vertices[(l + 2) % 3];
}

}  // namespace palpate::runtime
