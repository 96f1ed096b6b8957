// SPDX-License-Identifier: Apache-2.0
// curves.h5: raw force-deflection curves, a status per site. Normative page:
// format/schema/curves.md. A simulated and a measured curve are the same record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "format/provenance.hpp"
#include "format/relaxation.hpp"
#include "format/vec3.hpp"

namespace palpate {

inline constexpr int kCurvesSchema = 2;

enum class SiteStatus : std::uint8_t {
  Complete = 0,  ///< every path reached its end
  Partial = 1,   ///< a path stopped early; its samples are valid, the reason is recorded
  Failed = 2     ///< no usable sample
};

enum class PathKind : std::uint8_t {
  Normal = 0,  ///< along the press direction, from touch
  Lateral = 1  ///< along `direction`, at a constant depth, without slip
};

/// One converged state of the tool on a path. The first sample of a normal path is the touch
/// (displacement 0, force 0); the first of a lateral path is the state at the lateral depth before
/// the travel (displacement 0). Energies, Jacobian, penetration and area are NaN in a measured
/// sample, scatter and uncertainty in a simulated one.
struct CurveSample {
  double displacement = 0;   ///< m, of the tool along the path
  Vec3 force{};              ///< N, of the tool ON the body
  double strain_energy = 0;  ///< J, since the touch: of body and foundation, less gravity's work
  double tool_work = 0;      ///< J, integral of force . d(displacement) since the touch, as solved
  double min_jacobian = 1;   ///< smallest det F over the body
  double penetration = 0;    ///< m, deepest violation of the contact constraint
  double contact_area = 0;   ///< m^2, reference area in contact
  std::int32_t iterations = 0;
  /// N, sample standard deviation of the force along the path between repeats; NaN when unknown.
  double force_scatter = std::numeric_limits<double>::quiet_NaN();
  /// N, standard uncertainty of the force along the path; NaN when unknown.
  double force_uncertainty = std::numeric_limits<double>::quiet_NaN();
  /// J, stored in the springs that enforce the contact; NaN when unknown. With it the balance is
  /// complete: tool_work = strain_energy + contact_energy.
  double contact_energy = std::numeric_limits<double>::quiet_NaN();
  /// N, sum over bonded facets of tensile normal forces, which an unbonded contact cannot carry;
  /// NaN when unknown.
  double tension = std::numeric_limits<double>::quiet_NaN();
  /// How many boundary facets the contact covers, in parts of facets: the resolution of the contact
  /// by the mesh. NaN when unknown.
  double facets_in_contact = std::numeric_limits<double>::quiet_NaN();
  /// N, the response_force that a finer mesh lets expect, less this one: at sites that were
  /// pressed on a finer mesh too; NaN elsewhere.
  double mesh_difference = std::numeric_limits<double>::quiet_NaN();
  /// N, bound of the error that the mesh leaves in the response_force, with the confidence of the
  /// curves;
  /// NaN when unknown.
  double mesh_error = std::numeric_limits<double>::quiet_NaN();
  /// m^3, of the body since the touch: negative where the press compresses it. NaN when unknown.
  double volume_change = std::numeric_limits<double>::quiet_NaN();
  /// J, isochoric strain energy of each region of the body, at once after a step; empty where the
  /// tissue is elastic. By the envelope theorem it is m_r dE/dm_r, E the stored energy at a
  /// position of the tool and m_r all isochoric moduli of region r together. What remains of
  /// strain_energy, volumetric and of the foundation, does not relax.
  std::vector<double> isochoric_energy = {};
};

/// The displacement of its samples begins at 0 and never decreases.
struct CurvePath {
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;  ///< m, depth at which a lateral path was run; 0 for a normal path
  Vec3 direction{};          ///< unit; inward for a normal path, tangential for a lateral one
  std::vector<CurveSample> samples;
  std::int32_t repeats = 0;  ///< presses that were averaged; 0 for a simulated path
  /// m, standard uncertainty of where the displacement begins; NaN when it is exact.
  double contact_uncertainty = std::numeric_limits<double>::quiet_NaN();
};

/// N, the force of a sample along its path; on a lateral path less that of the start.
double response_force(const CurvePath& path, const CurveSample& sample);

/// All paths run at one response vertex.
struct SiteCurves {
  std::int32_t vertex = -1;  ///< index into the response surface of the body
  SiteStatus status = SiteStatus::Failed;
  std::string reason;  ///< empty when complete; otherwise those of all its paths, joined by "; "
  double cpu_seconds = 0;
  std::vector<CurvePath> paths;
};

/// How the curves were obtained: what a reader needs to interpret them.
struct ToolDescription {
  std::string shape;       ///< "sphere", "disc" or "cylinder"
  double radius = 0;       ///< m
  std::string friction;    ///< of the normal path: "frictionless" or "no-slip"
  double edge_radius = 0;  ///< m, fillet of the edge of a disc
  double length = 0;       ///< m, of a cylinder, between the centres of its rounded ends
};

struct Curves {
  ToolDescription tool;
  double depth = 0;           ///< m, requested end of the normal paths
  double lateral_travel = 0;  ///< m, requested end of the lateral paths
  std::string body_sha256;    ///< of the body.h5 the vertices refer to
  /// The series of the regions of the body, in its order; empty for elastic tissue. The curves are
  /// those at once after a step.
  RegionRelaxation relaxation;
  /// Probability that CurveSample::mesh_error bounds the error of a sample; NaN when unknown.
  double mesh_error_confidence = std::numeric_limits<double>::quiet_NaN();
  std::vector<SiteCurves> sites;  ///< in strictly ascending order of vertex
  Provenance provenance;
};

void write_curves(const std::filesystem::path& path, const Curves& curves);  ///< see write_body
Curves read_curves(const std::filesystem::path& path);                       ///< see read_body

}  // namespace palpate
