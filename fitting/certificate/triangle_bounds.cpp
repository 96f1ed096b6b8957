// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/triangle_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <queue>

#include "fitting/certificate/slide_bound.hpp"
#include "fitting/certificate/slide_search.hpp"

namespace palpate::fitting {
namespace {

// Budgets of the searches, in halvings of sets of states, some microseconds each.
constexpr int kHalvingsPerVisit = 1000, kMaxHalvings = 30000;  // of one triangle
// For a library: a constant, and more for each of its triangles.
constexpr long kHalvings = 300000, kHalvingsPerTriangle = 200;

TriangleBounds bound_triangle(const Library& library, std::size_t index, double depth,
                              double friction) {
  const TriangleFrame frame = triangle_frame(library, index);
  TriangleBounds bounds;
  bounds.certificate.kappa = frame.kappa;
  bounds.certificate.cos_theta = frame.cos_theta;
  // Without a response at a vertex there is no local model, hence nothing to bound.
  if (!has_responses(library, library.triangles[index])) return bounds;
  const ContactElement element = contact_element(library, index, depth, friction);
  const SlideBound slide = slide_bound(element);
  bounds.causes = slide.causes;
  bounds.certificate.stick = stick_bound(element);
  bounds.min_lipschitz_bound = min_lipschitz_bound(element);
  bounds.certificate.slip = slide.total;
  bounds.certificate.sliding_passive = slide_lowers_energy(element);
  return bounds;
}

/// Triangles in descending order of their bounds, then ascending order of their numbers.
class WorstFirst {
 public:
  struct Entry {
    double bound = 0;
    std::size_t triangle = 0;
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound < other.bound : triangle > other.triangle;
    }
  };

  explicit WorstFirst(const std::vector<TriangleBounds>& bounds) {
    for (std::size_t m = 0; m < bounds.size(); ++m) put(bounds, m);
  }
  void put(const std::vector<TriangleBounds>& bounds, std::size_t triangle) {
    entries_.push({bounds[triangle].certificate.slip, triangle});
  }
  bool empty() const { return entries_.empty(); }
  double bound() const { return entries_.top().bound; }
  std::size_t take() {
    const std::size_t triangle = entries_.top().triangle;
    entries_.pop();
    return triangle;
  }

 private:
  std::priority_queue<Entry> entries_;
};

double largest_stick(const std::vector<TriangleBounds>& bounds) {
  double largest = 0;
  for (const TriangleBounds& b : bounds) largest = std::max(largest, b.certificate.stick);
  return largest;
}

/// Tightens the slip bounds that determine the bound of the library, the largest first, until the
/// largest is within SlideSearch::kNearEnough of a value that a slide attains. Without friction the
/// direction of a slide is undetermined and (10) remains.
void tighten(const Library& library, double depth, double friction,
             std::vector<TriangleBounds>& bounds) {
  if (!(friction > 0)) return;
  WorstFirst worst(bounds);
  double attained = largest_stick(bounds);
  std::map<std::size_t, SlideSearch> searches;
  long left = kHalvings + kHalvingsPerTriangle * static_cast<long>(bounds.size());
  while (left > 0 && !worst.empty() && worst.bound() > SlideSearch::kNearEnough * attained) {
    const std::size_t m = worst.take();
    auto found = searches.find(m);
    if (found == searches.end())
      found = searches.try_emplace(m, contact_element(library, m, depth, friction)).first;
    SlideSearch& search = found->second;
    const int before = search.spent();
    search.advance(kHalvingsPerVisit, attained);
    const int spent = search.spent() - before;
    left -= spent;
    if (search.bound() < bounds[m].certificate.slip) {
      bounds[m].causes = search.causes();
      bounds[m].certificate.slip = search.bound();
    }
    if (std::isinf(search.attained())) continue;  // a state without a bound: no search helps
    attained = std::max(attained, search.attained());
    // A bound that does not converge is given up after kMaxHalvings.
    if (spent == kHalvingsPerVisit && search.spent() < kMaxHalvings) worst.put(bounds, m);
  }
}

}  // namespace

std::vector<TriangleBounds> triangle_bounds(const Library& library, double depth, double friction) {
  std::vector<TriangleBounds> bounds;
  for (std::size_t m = 0; m < library.triangles.size(); ++m)
    bounds.push_back(bound_triangle(library, m, depth, friction));
  tighten(library, depth, friction, bounds);
  return bounds;
}

}  // namespace palpate::fitting
