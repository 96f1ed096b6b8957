// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/region_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/units.hpp"
#include "mesher/checks.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

/// An inclusion is no smaller than this part of the body where a unit is proposed for it.
constexpr double kSmallestInclusion = 0.01;
/// Surfaces that differ by less, in parts of the body, are the same.
constexpr double kSamePlace = 1e-6;

/// Nodes on an area, in those of a square whose side is an edge: equilateral triangles, of which
/// two share a node.
constexpr double kNodesOnArea = 1.15;
/// What is thinner, in parts of element_size, needs elements much smaller than others; and what no
/// element may resolve.
constexpr double kThin = 1.0 / 4, kUnresolved = 1.0 / 10;

std::string size_text(const Bounds& box) {
  const Vec3 span = 1e3 * (box.high - box.low);
  return text(span[0], " x ", span[1], " x ", span[2], " mm");
}

std::string place_text(const Bounds& box) {
  return text(size_text(box), ", from ", position_text(box.low), " to ", position_text(box.high));
}

bool meet(const Bounds& a, const Bounds& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a.high[k] < b.low[k] || b.high[k] < a.low[k]) return false;
  return true;
}

bool is_larger_in_every_direction(const Bounds& a, const Bounds& b) {
  const Vec3 of_a = a.high - a.low, of_b = b.high - b.low;
  return of_a[0] > of_b[0] && of_a[1] > of_b[1] && of_a[2] > of_b[2];
}

/// Whether `outer` contains `inner`, but for a margin.
bool contains(const Bounds& outer, const Bounds& inner, double margin) {
  for (std::size_t k = 0; k < 3; ++k)
    if (inner.low[k] < outer.low[k] - margin || inner.high[k] > outer.high[k] + margin)
      return false;
  return true;
}

double largest_extent(const Bounds& box) {
  return largest_dimension({box.low, box.high});
}

/// "unit = "cm", which makes it 16 x 16 x 16 mm inside the bounds of the body", for each unit that
/// does so; empty where none does.
std::string units_that_fit(const SurfaceFile& file, const Bounds& inclusion, const Bounds& body) {
  std::string fitting;
  for (const Unit& unit : units_of(Dimension::Length)) {
    const double factor = unit.si / file.unit;
    const Bounds scaled{factor * inclusion.low, factor * inclusion.high};
    if (std::abs(factor - 1) < kSamePlace || !contains(body, scaled, 0) ||
        largest_extent(scaled) < kSmallestInclusion * largest_extent(body))
      continue;
    fitting += text(fitting.empty() ? "" : ", or ", "unit = \"", unit.symbol, "\", which makes it ",
                    size_text(scaled), " inside the bounds of the body");
  }
  return fitting;
}

/// Whether the inclusion leaves nothing of the body outside it. Not every such inclusion is found,
/// as where several together leave nothing.
bool encloses(const Surface& inclusion, const Surface& skin) {
  const Bounds body = bounds(skin.points);
  const double margin = kSamePlace * largest_extent(body);
  if (!contains(bounds(inclusion.points), body, margin)) return false;
  if (signed_volume(inclusion) < (1 - kSamePlace) * signed_volume(skin)) return false;
  const SurfaceQuery around(inclusion), within(skin);
  const auto apart = [margin](const SurfaceQuery& query, const Vec3& x) {
    return norm(query.closest(x).point - x) > margin;
  };
  return std::all_of(skin.points.begin(), skin.points.end(),
                     [&](const Vec3& x) { return around.contains(x) || !apart(around, x); }) &&
         std::none_of(inclusion.points.begin(), inclusion.points.end(),
                      [&](const Vec3& x) { return within.contains(x) && apart(within, x); });
}

void check_place(const SurfaceFile& file, const Surface& inclusion, const Surface& skin) {
  const Bounds its = bounds(inclusion.points), body = bounds(skin.points);
  const std::string sizes = text("it is ", place_text(its), "; the body is ", place_text(body));
  const std::string fitting = units_that_fit(file, its, body);
  const std::string remedy = fitting.empty()
                                 ? "export inclusion and body in the same coordinates, and check "
                                   "the units of both"
                                 : text("give ", fitting, "; or check the unit of the body");
  const std::string where = file.path.string();
  if (!meet(its, body))
    refuse_geometry(where, "the inclusion lies outside the body: " + sizes, remedy);
  if (is_larger_in_every_direction(its, body) && !fitting.empty()) {
    refuse_geometry(where, "the inclusion is larger than the body in every direction: " + sizes,
                    remedy + "; what is meant to be cut off by the body may be as large as it");
  }
  if (encloses(inclusion, skin)) {
    refuse_geometry(where,
                    "the inclusion encloses the whole body and leaves nothing around it: " + sizes,
                    "check the units of both, or remove the inclusion");
  }
}

/// Two digits of a count, without an exponent.
std::string rounded(double count) {
  const double step = std::pow(10, std::fmax(0, std::floor(std::log10(count)) - 1));
  return std::to_string(std::lround(std::round(count / step) * step));
}

/// A layer or an inclusion beside the elements.
struct Thin {
  std::string name, where;
  ErrorKind kind;
  double thickness = 0, area = 0;  ///< m; m^2, of all its walls
  std::string remedy;

  double nodes() const { return kNodesOnArea * area / (thickness * thickness); }
};

void check_thin(const Thin& thin, const Settings& settings, double others) {
  const double h = settings.element_size;
  const double nodes = thin.nodes();
  const std::string size =
      text(thin.name, " is ", millimetres(thin.thickness), " thick, element_size ", millimetres(h));
  if (thin.thickness < h && nodes > kMostNodes) {
    const double least = thin.thickness * std::sqrt(nodes / kMostNodes);
    throw Error(thin.kind, thin.where,
                text(size, ": elements as small as it take about ", rounded(nodes),
                     " nodes, more than ", rounded(kMostNodes)),
                text("check its unit, make it thicker than ", number_text(1e3 * least, 2),
                     " mm, or leave it out"));
  }
  if (thin.thickness < kThin * h && nodes > others) {
    warn(settings.log,
         text(size, ": elements as small as it take about ", rounded(nodes), " nodes, and ",
              rounded(others), " all others: meshing and campaign take as much longer; ",
              thin.remedy));
  } else if (thin.thickness < kUnresolved * h) {
    warn(settings.log, text(size,
                            ": it may be lost between the elements; check its unit, or "
                            "reduce element_size below ",
                            number_text(1e3 * thin.thickness / kUnresolved, 2), " mm"));
  }
}

}  // namespace

void check_places(const Settings& settings, const Surface& skin,
                  const std::vector<Surface>& inclusions) {
  for (std::size_t i = 0; i < inclusions.size(); ++i)
    check_place(settings.inclusions[i], inclusions[i], skin);
}

void check_thinness(const Settings& settings, const Surface& skin,
                    const std::vector<Surface>& inclusions) {
  const double others = nodes_of(settings, skin);
  const std::string thicker =
      text("make it thicker than ", number_text(1e3 * kThin * settings.element_size, 2),
           " mm, or leave it out");
  const auto thinnest = std::min_element(
      settings.layers.begin(), settings.layers.end(),
      [](const LayerSettings& a, const LayerSettings& b) { return a.thickness < b.thickness; });
  if (thinnest != settings.layers.end()) {
    const auto walls = static_cast<double>(settings.layers.size() + 1);
    check_thin({text("the layer '", thinnest->region_name, "'"), settings.source().string(),
                ErrorKind::Configuration, thinnest->thickness, walls * area(skin), thicker},
               settings, others);
  }
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    const std::string where = settings.inclusions[i].path.string();
    check_thin({"the inclusion " + where, where, ErrorKind::Geometry, mean_thickness(inclusions[i]),
                area(inclusions[i]), thicker},
               settings, others);
  }
}

}  // namespace palpate::mesher
