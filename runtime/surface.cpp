// SPDX-License-Identifier: Apache-2.0
#include "runtime/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "format/origin_distance.hpp"

namespace palpate::runtime {
namespace {

constexpr std::size_t kMostKnots = 65535;
constexpr double kLeastDirection =
    0.5;  // |sum n_l u_l| below this: directions contradict each other

std::string triangle_name(std::size_t m) {
  return "library triangle " + std::to_string(m);
}

/// Positions of the points along a space-filling curve, on which near points are mostly near each
/// other (Z order; G. M. Morton 1966).
std::vector<std::size_t> along_a_curve(const std::vector<Vec3>& points, const Vec3& low,
                                       const Vec3& high) {
  constexpr std::size_t kBits = 20;  // an axis
  std::vector<std::pair<std::uint64_t, std::size_t>> place;
  place.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    std::uint64_t code = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double extent = std::max(high[i] - low[i], 1e-12);
      const auto cell =
          static_cast<std::uint64_t>((points[v][i] - low[i]) / extent * ((1U << kBits) - 1));
      for (std::size_t bit = 0; bit < kBits; ++bit) code |= ((cell >> bit) & 1U) << (3 * bit + i);
    }
    place.emplace_back(code, v);
  }
  std::sort(place.begin(), place.end());
  std::vector<std::size_t> order;
  order.reserve(place.size());
  for (const auto& [code, v] : place) order.push_back(v);
  return order;
}

/// Pieces are as many as knots; a hole has none.
CurveSizes sizes_of(const Library& library, std::size_t v) {
  const NodeResponse& r = library.responses[v];
  if (r.status == ResponseStatus::Hole) return {};
  const bool coupled = library.kind == ResponseKind::Coupled;
  const std::size_t coupling = coupled ? r.coupling.curve.knot.size() : 0;
  if (std::max({r.normal.knot.size(), r.lateral.knot.size(), coupling}) > kMostKnots) {
    throw Error(ErrorKind::Configuration, "library vertex " + std::to_string(v),
                "a response has more than " + std::to_string(kMostKnots) + " knots",
                "fit with fewer");
  }
  return {static_cast<std::uint16_t>(r.normal.knot.size()),
          static_cast<std::uint16_t>(r.lateral.knot.size()), static_cast<std::uint16_t>(coupling)};
}

NodeRelaxation relaxation_of(const Library& library, std::size_t v) {
  NodeRelaxation node;
  const std::vector<float>& stored = library.responses[v].relaxation;
  for (std::size_t i = 0; i < stored.size(); ++i)
    node.fractions[i / 2][i % 2] = static_cast<double>(stored[i]);
  return node;
}

/// What was read from a file has been checked already.
void check_soft_axes(const Library& library) {
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const double length = norm(vec3_of(library.responses[v].soft_axis));
    if (length == 0 || (length <= kMostSoftAxis && library.kind == ResponseKind::Coupled)) continue;
    throw Error(ErrorKind::Configuration, "library vertex " + std::to_string(v),
                "its soft axis is too long, or its responses are not coupled",
                "fit the curves again");
  }
}

void check_relaxation(const Library& library) {
  const std::size_t times = library.relaxation_times.size();
  const bool counts =
      std::all_of(library.responses.begin(), library.responses.end(), [&](const NodeResponse& r) {
        return r.relaxation.size() == times || r.status == ResponseStatus::Hole;
      });
  if (times <= kMaxRelaxationTimes && counts && library.tool_radius > 0) return;
  throw Error(ErrorKind::Configuration, "library",
              "its relaxation needs at most " + std::to_string(kMaxRelaxationTimes) +
                  " times, a fraction for each at every vertex, and a radius of the tool",
              "fit the curves again");
}

bool all_relax_alike(const Library& library) {
  const std::vector<float>* first = nullptr;
  for (const NodeResponse& response : library.responses) {
    if (response.status == ResponseStatus::Hole) continue;
    if (first == nullptr) first = &response.relaxation;
    if (response.relaxation != *first) return false;
  }
  return true;
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
  relaxation_times_ = library.relaxation_times;
  tool_radius_ = library.tool_radius;
  inverse_tool_radius_ = tool_radius_ > 0 ? 1 / tool_radius_ : 0;
  if (library.relaxes()) {
    check_relaxation(library);
    relaxes_alike_ = all_relax_alike(library);
    ++curves_at_;
  }
  leans_ = library.leans();
  has_soft_axes_ = library.has_soft_axes();
  if (has_soft_axes_) check_soft_axes(library);
  if (has_axes()) ++curves_at_;
  const std::vector<std::int32_t> record = build_nodes(library);
  for (std::size_t m = 0; m < elements_.size(); ++m) build_element(library, record, m);
  if (std::none_of(elements_.begin(), elements_.end(), [](const Element& e) { return e.active; })) {
    throw Error(ErrorKind::Configuration, "library",
                "no triangle has responses at its three vertices", "fit more sites");
  }
  connect();
}

/// Where the record of each vertex begins.
std::vector<std::int32_t> Surface::build_nodes(const Library& library) {
  if (library.positions.empty()) {
    throw Error(ErrorKind::Configuration, "library", "it has no vertices", "build it again");
  }
  low_ = high_ = library.positions.front();
  for (const Vec3& p : library.positions) {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], p[i]);
      high_[i] = std::max(high_[i], p[i]);
    }
  }
  const std::vector<std::size_t> order = along_a_curve(library.positions, low_, high_);
  std::vector<std::int32_t> record(order.size());
  std::size_t lines = 0;
  for (const std::size_t v : order) {
    record[v] = static_cast<std::int32_t>(lines);
    lines += curves_at_ + NodeCurves::lines(sizes_of(library, v));
    if (lines > std::numeric_limits<std::int32_t>::max()) {
      throw Error(ErrorKind::Configuration, "library", "its responses take more than 128 GB",
                  "fit with fewer knots");
    }
  }
  records_.resize(lines);
  for (const std::size_t v : order)
    build_node(library, v, &records_[static_cast<std::size_t>(record[v])]);
  return record;
}

void Surface::build_node(const Library& library, std::size_t v, CacheLine* memory) {
  const NodeResponse& response = library.responses[v];
  SurfaceNode node{library.positions[v], library.inward[v], {}};
  if (response.status != ResponseStatus::Hole) {
    const CompiledCurve normal(response.normal);
    const bool coupled = library.kind == ResponseKind::Coupled;
    node.curves = NodeCurves::write(memory + curves_at_, normal, CompiledCurve(response.lateral),
                                    coupled ? coupling_of(response, v) : CompiledCurve());
    deepest_ = std::max(deepest_, normal.last_knot());
  }
  new (memory) SurfaceNode(node);
  if (library.relaxes()) new (memory + 1) NodeRelaxation(relaxation_of(library, v));
  if (has_axes())
    new (memory + curves_at_ - 1) NodeAxes{vec3_of(response.lean), vec3_of(response.soft_axis)};
}

void Surface::build_element(const Library& library, const std::vector<std::int32_t>& record,
                            std::size_t m) {
  Element& e = elements_[m];
  e.active = true;
  for (std::size_t l = 0; l < 3; ++l) {
    const auto v = static_cast<std::size_t>(library.triangles[m][l]);
    if (v >= record.size()) {  // a negative index is a huge one
      throw Error(ErrorKind::Configuration, triangle_name(m), "vertex index out of range",
                  "build it again");
    }
    e.vertices[l] = record[v];
    e.active = e.active && library.responses[v].status != ResponseStatus::Hole;
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
  if (e.active) check_directions(library, m);
}

void Surface::check_directions(const Library& library, std::size_t m) const {
  const Element& e = elements_[m];
  const char* remedy = "refine the response surface there or smooth the press directions";
  for (std::size_t l = 0; l < 3; ++l) {
    if (!(dot(inward(e, l), e.facet_normal) > 0)) {
      throw Error(ErrorKind::Geometry, triangle_name(m),
                  "the press direction of vertex " + std::to_string(library.triangles[m][l]) +
                      " does not point to its inner side",
                  remedy);
    }
  }
  if (origin_to_triangle(inward(e, 0), inward(e, 1), inward(e, 2)) < kLeastDirection) {
    throw Error(ErrorKind::Geometry, triangle_name(m),
                "its press directions differ too much to be interpolated", remedy);
  }
}

void Surface::connect() {
  struct Side {
    std::int32_t from, to;  // the edge as this triangle traverses it
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

void Surface::prefetch_around(std::int32_t m, const NodeCurves::InUse& in_use) const noexcept {
  const Element& e = element(m);
  for (std::size_t l = 0; l < 3; ++l) {
    if (e.neighbour[l] == kNoElement) continue;
    prefetch_opposite(e, l, in_use);
    for (const std::int32_t beyond : element(e.neighbour[l]).neighbour) {
      if (beyond == kNoElement || beyond == m) continue;
      const auto* lines = reinterpret_cast<const CacheLine*>(&element(beyond));
      __builtin_prefetch(lines);
      __builtin_prefetch(lines + 1);
    }
  }
}

void Surface::prefetch_beyond(std::int32_t m, const NodeCurves::InUse& in_use) const noexcept {
  for (const std::int32_t next : element(m).neighbour) {
    if (next == kNoElement) continue;
    const Element& e = element(next);
    for (std::size_t l = 0; l < 3; ++l) {
      if (e.neighbour[l] != kNoElement && e.neighbour[l] != m) prefetch_opposite(e, l, in_use);
    }
  }
}

/// The vertex of the neighbour across edge l that the element does not have.
void Surface::prefetch_opposite(const Element& e, std::size_t l,
                                const NodeCurves::InUse& in_use) const noexcept {
  // The sum of the three less the shared two, all as bits: sums of three may be large.
  const auto bits = [](std::int32_t v) { return static_cast<std::uint32_t>(v); };
  const auto& theirs = element(e.neighbour[l]).vertices;
  const std::uint32_t v = bits(theirs[0]) + bits(theirs[1]) + bits(theirs[2]) -
                          bits(e.vertices[(l + 1) % 3]) - bits(e.vertices[(l + 2) % 3]);
  const CacheLine* const record = &records_[v];
  __builtin_prefetch(record);
  const CacheLine* const curves = record + curves_at_;
  for (std::size_t k = 0; k < in_use.knots; ++k) __builtin_prefetch(curves + k);
  __builtin_prefetch(curves + in_use.normal);
  __builtin_prefetch(curves + in_use.lateral);
  if (in_use.coupling > 0) __builtin_prefetch(curves + in_use.coupling);
  if (!relaxes_alike_) __builtin_prefetch(record + 1);
  if (has_axes()) __builtin_prefetch(curves - 1);
}

Lanes Surface::fractions(const SurfacePoint& p) const noexcept {
  const Element& e = element(p.element);
  const auto relaxation = [&](std::size_t l) {
    const CacheLine* const record = &records_[static_cast<std::size_t>(e.vertices[l])];
    return reinterpret_cast<const NodeRelaxation*>(record + 1)->fractions;
  };
  const Pair* const nodes[3] = {relaxation(0), relaxation(1), relaxation(2)};
  Lanes sum;
  for (std::size_t i = 0; i < pairs_of(relaxation_times_.size()); ++i)
    for (std::size_t l = 0; l < 3; ++l) sum.pair[i] += p.natural[l] * nodes[l][i];
  return sum;
}

}  // namespace palpate::runtime
