// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/certify.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/certificate/bounded_depth.hpp"
#include "fitting/certificate/range.hpp"
#include "fitting/certificate/triangle_bounds.hpp"
#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "format/number_text.hpp"
#include "format/position_text.hpp"

namespace palpate::fitting {
namespace {

constexpr double kReferencePeriod = 1e-3;  // s: stiffness limits of a device are stated at 1 kHz

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
    const ResponseStatus status = library.responses[static_cast<std::size_t>(v)].status;
    if (status == ResponseStatus::Hole) ++certificate.holes;
    if (status == ResponseStatus::Interpolated) ++certificate.interpolated;
  }
}

/// Reason why the slide has no bound.
std::string cause_unbounded(const TriangleCertificate& triangle, double depth) {
  const double tilt = std::acos(triangle.cos_theta) * 57.29577951308232;
  const std::string off =
      "up to " + std::to_string(std::lround(tilt)) + " degrees off the facet normal";
  if (depth * triangle.kappa < triangle.cos_theta)
    return "no bound of the slide: the lateral response is too flat at the slip limit for the "
           "change of the responses and press directions " +
           off;
  return "no bound of the slide: pressed " + length_text(depth) +
         " deep where the press directions turn with a radius of " +
         length_text(1 / triangle.kappa) + ", " + off;
}

std::string remedy_unbounded(const std::string& first) {
  return " (try " + (first.empty() ? "" : first + ", ") +
         "a smaller patch spacing, a rounder edge or a smaller depth)";
}

std::string cause(const TriangleBounds& bounds, double depth, const std::string& slide_remedy) {
  if (kRoundingFactor * bounds.certificate.stick >= bounds.certificate.slip) {
    return "the stiffest response, at a fixed contact point";
  }
  if (std::isinf(bounds.certificate.slip))
    return cause_unbounded(bounds.certificate, depth) + remedy_unbounded(slide_remedy);
  const SlideCauses& slide = bounds.causes;
  const double turning = std::max(slide.slant, slide.curvature);
  const double of_axes = std::max(slide.lean, slide.softening);
  if (slide.stiffness >= std::max({slide.variation, turning, of_axes}))
    return "the stiffest response, while sliding";
  if (slide.variation >= std::max(turning, of_axes))
    return "the change of the responses over the surface, while sliding";
  if (of_axes >= turning)
    return slide.lean >= slide.softening ? "the lean of the responses, while sliding"
                                         : "the soft axes of the responses, while sliding";
  return slide.slant >= slide.curvature ? "press directions oblique to the facet, while sliding"
                                        : "the curvature of the normals, while sliding";
}

std::string largest_bound_text(const Library& library, std::size_t index,
                               const TriangleBounds& bounds, double depth,
                               const std::string& slide_remedy) {
  const Triangle& triangle = library.triangles[index];
  Vec3 centre{};
  for (const std::int32_t v : triangle) {
    centre = centre + (1.0 / 3) * library.positions[static_cast<std::size_t>(v)];
  }
  const std::string where =
      "triangle " + std::to_string(index) + " near " + position_text(centre) + ": ";
  const double bound = std::max(bounds.certificate.stick, bounds.certificate.slip);
  const std::string size = std::isfinite(bound) ? lipschitz_bound_text(bound) + " in " : "";
  return size + (where + cause(bounds, depth, slide_remedy));
}

/// How much of the library has no bound, and down to which depth all of it has one.
std::string where_bounded(const Library& library, const std::vector<TriangleBounds>& bounds,
                          const Certificate& certificate) {
  const auto unbounded =
      std::count_if(certificate.triangles.begin(), certificate.triangles.end(),
                    [](const TriangleCertificate& t) { return std::isinf(t.slip); });
  if (unbounded == 0) return {};
  std::string text;
  if (unbounded > 1) {
    text = "; " + std::to_string(unbounded) + " of " + std::to_string(bounds.size()) +
           " triangles have no bound";
  }
  const double depth = bounded_depth(library, bounds, certificate.depth, certificate.friction);
  if (!(depth > 0)) return text + "; at no depth have all slides a bound";
  constexpr double kRoundedDown = 0.995;  // three digits never state more than was found
  return text + "; down to " + length_text(kRoundedDown * depth) + " every slide has a bound";
}

/// The factor of L in (C10): the lateral force changes by itself and with the limit of friction.
double change_factor(double friction) {
  const double square = friction * friction;
  return 1 + square / 2 + friction * std::sqrt(1 + square / 4);
}

/// K of (C9), 1/s, with the friction at which m_mu counts the lean.
double relaxation_rate(const Library& library, double friction) {
  double largest = 0, lean = 0;
  for (const NodeResponse& response : library.responses) {
    const auto& [x, y, z] = response.lean;
    const double length =
        std::hypot(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    if (length > 0)
      lean = std::max(lean, library.kind == ResponseKind::Coupled
                                ? response.coupling.largest() * length
                                : length);
    double rate = 0;
    for (std::size_t i = 0; i < response.relaxation.size(); ++i)
      rate += static_cast<double>(response.relaxation[i]) / library.relaxation_times[i];
    largest = std::max(largest, rate);
  }
  return change_factor(friction * (1 + lean * lean)) * largest;
}

void add_devices(Certificate& certificate, const CertifySettings& settings) {
  const double bound = certified_lipschitz_bound(certificate);
  const RenderedForce force = rendered_force(certificate, bound);
  for (const DeviceProfile& device : settings.devices) {
    if (std::isinf(device.damping) || device.damping <= 0) {
      throw Error(ErrorKind::Configuration, "device profile '" + device.name + "'",
                  "the damping is not positive",
                  "give the smallest damping in N s/m, or omit it if unknown");
    }
    const DeviceConstants constants = device.constants();
    certificate.devices.push_back(
        {device.name, device.damping, lowest_rate(constants, force),
         2 * device.damping / (3 * kReferencePeriod), 2 * device.damping / kReferencePeriod,
         device.coulomb_friction, device.delay, device.position_resolution, device.force_resolution,
         published_rate(device.damping, bound), largest_position_step(constants, bound)});
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
    throw Error(ErrorKind::Configuration, "certify settings",
                "the friction coefficient is not a number >= 0",
                "give a friction coefficient, for example 0.3");
  }
  Certificate certificate;
  certificate.friction = settings.friction;
  certificate.depth = deepest_knot(library);
  if (!(certificate.depth > 0)) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "no vertex has a response", "fit the curves first");
  }
  const std::vector<TriangleBounds> bounds =
      triangle_bounds(library, certificate.depth, settings.friction);
  double largest = 0;
  certificate.min_lipschitz_bound = 0;
  for (std::size_t m = 0; m < bounds.size(); ++m) {
    const TriangleCertificate& triangle = bounds[m].certificate;
    certificate.triangles.push_back(triangle);
    certificate.stick = std::max(certificate.stick, triangle.stick);
    certificate.slip = std::max(certificate.slip, triangle.slip);
    certificate.min_lipschitz_bound =
        std::max(certificate.min_lipschitz_bound, bounds[m].min_lipschitz_bound);
    const double both = std::max(triangle.stick, triangle.slip);
    if (both > largest) {
      largest = both;
      certificate.worst_triangle = static_cast<std::int32_t>(m);
      certificate.limited_by =
          largest_bound_text(library, m, bounds[m], certificate.depth, settings.slide_remedy);
    }
  }
  if (certificate.worst_triangle < 0) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "every triangle touches a hole", "fill the holes or compute more sites");
  }
  certificate.limited_by += where_bounded(library, bounds, certificate);
  certificate.relaxation_rate = relaxation_rate(library, settings.friction);
  certificate.basis = basis_of(library.provenance);
  count_vertices(library, certificate);
  certificate.lipschitz_bound = settings.enforced_bound;
  certificate.lipschitz_bound = enforced_lipschitz_bound(certificate);
  add_devices(certificate, settings);
  library.certificate = certificate;
}

}  // namespace palpate::fitting
