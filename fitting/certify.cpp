// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <queue>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/fitting.hpp"
#include "fitting/slide_bound.hpp"
#include "fitting/slide_search.hpp"
#include "format/error.hpp"

namespace palpate::fitting {
namespace {

constexpr double kReferencePeriod = 1e-3;  // s: the limits of a device are stated at 1 kHz
// Of the sets of states of a search: at one look, for one triangle, and for a library, some
// microseconds each.
constexpr int kHalvingsALook = 1000, kMostHalvings = 30000;
constexpr long kHalvings = 300000, kHalvingsATriangle = 200;

/// Bounds of one triangle with what they are made of, for the line that names the limit.
struct TriangleBounds {
  TriangleCertificate certificate;
  SlideCauses causes;
};

const NodeResponse& response(const Library& library, std::int32_t vertex) {
  return library.responses[static_cast<std::size_t>(vertex)];
}

bool has_hole(const Library& library, const Triangle& triangle) {
  return std::any_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
    return response(library, v).status == ResponseStatus::Hole;
  });
}

CurveTriple curves_of(const Library& library, const Triangle& triangle, const TriangleFrame& frame,
                      ResponseCurve NodeResponse::*kind) {
  return {{runtime::CompiledCurve(response(library, triangle[0]).*kind),
           runtime::CompiledCurve(response(library, triangle[1]).*kind),
           runtime::CompiledCurve(response(library, triangle[2]).*kind)},
          frame.gradient};
}

CurveTriple couplings_of(const Library& library, const Triangle& triangle,
                         const TriangleFrame& frame) {
  const auto curve = [&](std::size_t l) {
    const CouplingCurve& coupling = response(library, triangle[l]).coupling;
    return runtime::CompiledCurve(coupling.curve, static_cast<double>(coupling.base));
  };
  return {{curve(0), curve(1), curve(2)}, frame.gradient};
}

ContactElement contact_element(const Library& library, std::size_t index, double depth,
                               double friction) {
  const Triangle& triangle = library.triangles[index];
  const TriangleFrame frame = triangle_frame(library, index);
  ContactElement element{frame, curves_of(library, triangle, frame, &NodeResponse::normal),
                         curves_of(library, triangle, frame, &NodeResponse::lateral), friction,
                         depth};
  if (library.kind == ResponseKind::Coupled)
    element.coupling = couplings_of(library, triangle, frame);
  return element;
}

TriangleBounds bound_triangle(const Library& library, std::size_t index, double depth,
                              double friction) {
  const TriangleFrame frame = triangle_frame(library, index);
  TriangleBounds bounds;
  bounds.certificate.kappa = frame.kappa;
  bounds.certificate.cos_theta = frame.cos_theta;
  // Without a response at a vertex there is no local model: a border, nothing to bound.
  if (has_hole(library, library.triangles[index])) return bounds;
  const ContactElement element = contact_element(library, index, depth, friction);
  const SlideBound slide = slide_bound(element);
  bounds.causes = slide.causes;
  bounds.certificate.stick = stick_bound(element);
  bounds.certificate.slip = slide.total;
  bounds.certificate.sliding_passive = slide_lowers_energy(element);
  return bounds;
}

/// A closer look at the triangles whose slides would set the bound of the library, always at the
/// worst, until what is left is near enough to what a slide does reach. (Without friction the slide
/// has no direction of its own, and (10) stands.)
void tighten(const Library& library, double depth, double friction,
             std::vector<TriangleBounds>& bounds) {
  if (!(friction > 0)) return;
  struct Look {
    double bound = 0;
    std::size_t triangle = 0;
    bool operator<(const Look& other) const {
      return bound != other.bound ? bound < other.bound : triangle > other.triangle;
    }
  };
  std::priority_queue<Look> worst;
  double reached = 0;
  for (std::size_t m = 0; m < bounds.size(); ++m) {
    reached = std::max(reached, bounds[m].certificate.stick);
    worst.push({bounds[m].certificate.slip, m});
  }
  std::map<std::size_t, SlideSearch> searches;
  long left = kHalvings + kHalvingsATriangle * static_cast<long>(bounds.size());
  while (left > 0 && !worst.empty()) {
    const auto [bound, m] = worst.top();
    if (bound <= SlideSearch::kNearEnough * reached) return;
    worst.pop();
    SlideSearch& search =
        searches.try_emplace(m, contact_element(library, m, depth, friction)).first->second;
    const int before = search.spent();
    search.advance(kHalvingsALook, reached);
    left -= search.spent() - before;
    if (search.bound() < bound) {
      bounds[m].causes = search.causes();
      bounds[m].certificate.slip = search.bound();
    }
    if (std::isinf(search.reached())) continue;  // a state without a bound: nothing to look for
    reached = std::max(reached, search.reached());
    // What does not come down is not looked at for ever.
    if (search.spent() < kMostHalvings && search.spent() - before == kHalvingsALook)
      worst.push({bounds[m].certificate.slip, m});
  }
}

double deepest_knot(const Library& library) {
  double depth = 0;
  for (const NodeResponse& node : library.responses) {
    if (node.status != ResponseStatus::Hole) {
      depth = std::max(depth, static_cast<double>(node.normal.knot.back()));
    }
  }
  return depth;
}

void count_vertices(const Library& library, Certificate& certificate) {
  std::set<std::int32_t> used;
  for (const Triangle& triangle : library.triangles) used.insert(triangle.begin(), triangle.end());
  for (const std::int32_t v : used) {
    const ResponseStatus status = response(library, v).status;
    if (status == ResponseStatus::Hole) ++certificate.holes;
    if (status == ResponseStatus::Filled) ++certificate.filled;
  }
}

/// Why the slide itself has no bound, and what gives it one.
std::string cause_unbounded(const TriangleCertificate& triangle, double depth) {
  std::array<char, 256> text{};
  const double lean = std::acos(triangle.cos_theta) * 57.29577951308232;
  if (depth * triangle.kappa < triangle.cos_theta) {
    std::snprintf(text.data(), text.size(),
                  "no bound of the slide: the lateral response is too flat at the slip limit for "
                  "the change of the responses and directions that lean by %.0f degrees",
                  lean);
  } else {
    std::snprintf(text.data(), text.size(),
                  "no bound of the slide: pressed %.3g mm deep where the directions turn with a "
                  "radius of %.3g mm and lean by %.0f degrees",
                  1e3 * depth, 1e3 / triangle.kappa, lean);
  }
  return text.data() + std::string(
                           " (smaller patches, a rounder edge, a shallower depth or "
                           "coupled responses may give one)");
}

std::string cause(const TriangleBounds& bounds, double depth) {
  if (bounds.certificate.stick >= bounds.certificate.slip) {
    return "the stiffest response, with the contact point held";
  }
  if (std::isinf(bounds.certificate.slip)) return cause_unbounded(bounds.certificate, depth);
  const SlideCauses& slide = bounds.causes;
  if (slide.stiffness >= std::max({slide.variation, slide.slant, slide.curvature})) {
    return "the stiffest response, while sliding";
  }
  if (slide.variation >= std::max(slide.slant, slide.curvature)) {
    return "the change of the responses over the surface, while sliding";
  }
  return slide.slant >= slide.curvature
             ? "inward directions that lean against the facet, while sliding"
             : "the curvature of the normals, while sliding";
}

std::string limit_line(const Library& library, std::size_t index, const TriangleBounds& bounds,
                       double depth) {
  const Triangle& triangle = library.triangles[index];
  Vec3 centre{};
  for (const std::int32_t v : triangle) {
    centre = centre + (1.0 / 3) * library.positions[static_cast<std::size_t>(v)];
  }
  std::array<char, 160> place{};
  std::snprintf(place.data(), place.size(), "triangle %zu near (%.4g, %.4g, %.4g) m: ", index,
                centre[0], centre[1], centre[2]);
  const double bound = std::max(bounds.certificate.stick, bounds.certificate.slip);
  std::array<char, 40> size{};
  if (std::isfinite(bound)) std::snprintf(size.data(), size.size(), "%.4g N/m in ", bound);
  return size.data() + (place.data() + cause(bounds, depth));
}

void add_devices(Certificate& certificate, const CertifySettings& settings) {
  const double steepest = std::max(certificate.stick, certificate.slip);
  for (const DeviceProfile& device : settings.devices) {
    if (std::isinf(device.damping) || device.damping <= 0) {
      throw Error(ErrorKind::Configuration, "device profile '" + device.name + "'",
                  "damping is not above zero",
                  "give the smallest damping in N s/m or leave it out");
    }
    // An unknown damping (NaN) makes the whole row unknown.
    certificate.devices.push_back({device.name, device.damping, 2 * steepest / device.damping,
                                   2 * device.damping / (3 * kReferencePeriod),
                                   2 * device.damping / kReferencePeriod});
  }
}

}  // namespace

std::string basis_of(const Provenance& provenance) {
  const auto has = [&](std::string_view stage) {
    return std::any_of(provenance.steps.begin(), provenance.steps.end(),
                       [&](const ProvenanceStep& step) { return step.stage == stage; });
  };
  if (has("rescale")) return "simulated shape, measured scale";
  return has("import") ? "measured" : "simulated";
}

void certify(Library& library, const CertifySettings& settings) {
  if (!std::isfinite(settings.friction) || settings.friction < 0) {
    throw Error(ErrorKind::Configuration, "certify settings", "friction is not a number >= 0",
                "give a friction coefficient, for example 0.3");
  }
  Certificate certificate;
  certificate.friction = settings.friction;
  certificate.depth = deepest_knot(library);
  if (!(certificate.depth > 0)) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "no vertex has a response", "fit the curves first");
  }
  std::vector<TriangleBounds> bounds;
  for (std::size_t m = 0; m < library.triangles.size(); ++m)
    bounds.push_back(bound_triangle(library, m, certificate.depth, settings.friction));
  tighten(library, certificate.depth, settings.friction, bounds);
  double steepest = 0;
  for (std::size_t m = 0; m < bounds.size(); ++m) {
    const TriangleCertificate& triangle = bounds[m].certificate;
    certificate.triangles.push_back(triangle);
    certificate.stick = std::max(certificate.stick, triangle.stick);
    certificate.slip = std::max(certificate.slip, triangle.slip);
    const double both = std::max(triangle.stick, triangle.slip);
    if (both > steepest) {
      steepest = both;
      certificate.worst_triangle = static_cast<std::int32_t>(m);
      certificate.limited_by = limit_line(library, m, bounds[m], certificate.depth);
    }
  }
  if (certificate.worst_triangle < 0) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "every triangle touches a hole", "fill the holes or compute more sites");
  }
  const auto unbounded =
      std::count_if(certificate.triangles.begin(), certificate.triangles.end(),
                    [](const TriangleCertificate& t) { return std::isinf(t.slip); });
  if (unbounded > 1) {
    certificate.limited_by += "; " + std::to_string(unbounded) + " triangles are unbounded";
  }
  certificate.basis = basis_of(library.provenance);
  count_vertices(library, certificate);
  add_devices(certificate, settings);
  library.certificate = certificate;
}

}  // namespace palpate::fitting
