// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/bounded_depth.hpp"

#include <cmath>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_bound.hpp"
#include "fitting/certificate/slide_search.hpp"

namespace palpate::fitting {
namespace {

constexpr int kDepthBisections = 6;
constexpr int kStateHalvingsPerVisit = 500,
              kMaxStateHalvings = 5000;  // of sets of states of one triangle

/// Whether the slides over a triangle have a bound; false where the search does not find one.
bool has_bound(const Library& library, std::size_t triangle, double depth, double friction) {
  const ContactElement element = contact_element(library, triangle, depth, friction);
  if (std::isfinite(slide_bound(element).total)) return true;
  if (!(friction > 0)) return false;
  SlideSearch search(element);
  while (search.spent() < kMaxStateHalvings) {
    const int before = search.spent();
    search.advance(kStateHalvingsPerVisit, 0);
    if (std::isinf(search.attained())) return false;
    if (std::isfinite(search.bound())) return true;
    if (search.spent() == before) break;
  }
  return false;
}

}  // namespace

double bounded_depth(const Library& library, const std::vector<TriangleBounds>& bounds,
                     double depth, double friction) {
  double common = depth;  // the states of a smaller depth are among those of a larger one
  for (std::size_t m = 0; m < bounds.size() && common > 0; ++m) {
    if (std::isfinite(bounds[m].certificate.slip)) continue;
    if (common < depth && has_bound(library, m, common, friction)) continue;
    double low = 0, high = common;
    for (int i = 0; i < kDepthBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (has_bound(library, m, middle, friction) ? low : high) = middle;
    }
    common = low;
  }
  return common;
}

}  // namespace palpate::fitting
