// SPDX-License-Identifier: Apache-2.0
#include "format/library.hpp"

#include <algorithm>
#include <cmath>

#include "format/artifact.hpp"
#include "format/columns.hpp"
#include "format/number_text.hpp"

namespace palpate {
namespace {

constexpr const char* kLibraryArtifact = "palpate.library";
constexpr const char* kLibraryRemedy = "make it again with 'palpate fit'";

constexpr auto kResponseColumns = std::make_tuple(
    column("status", &NodeResponse::status, "1", "0 fitted, 1 interpolated, 2 hole.",
           rules::up_to(2, "a status (0, 1 or 2)")),
    column("normal_error", &NodeResponse::normal_error, "N",
           "Largest |fit - sample| of the normal curve.", rules::kNonNegative),
    column("lateral_error", &NodeResponse::lateral_error, "N",
           "Largest |fit - sample| of the lateral curve.", rules::kNonNegative));

constexpr auto kTriangleColumns = std::make_tuple(
    column("stick", &TriangleCertificate::stick, "N/m",
           "L_stick, largest Jacobian norm with the contact point fixed.", rules::kBound),
    column("slip", &TriangleCertificate::slip, "N/m",
           "L_slip, Lipschitz bound along the path while sliding.", rules::kBound),
    column("kappa", &TriangleCertificate::kappa, "1/m", "Bound on the turning rate of n.",
           rules::kBound),
    column("cos_theta", &TriangleCertificate::cos_theta, "1",
           "Cosine of the worst angle between n and the facet normal.", rules::kCosine),
    column("sliding_passive", &TriangleCertificate::sliding_passive, "1",
           "1 where sliding needs no energy correction.", rules::kFlag));

constexpr auto kDeviceColumns = std::make_tuple(
    column("damping", &DeviceCertificate::damping, "N s/m",
           "Smallest damping singular value sigma_0(B).", rules::kKnownBound),
    column("lowest_rate", &DeviceCertificate::lowest_rate, "Hz",
           "Rate from which on damping makes up for hold and delay.", rules::kKnownBound),
    column("linear_limit", &DeviceCertificate::linear_limit, "N/m",
           "Stiffest linear wall at 1 kHz with one sample of delay, 2 b/(3 T).",
           rules::kKnownBound),
    column("no_delay_limit", &DeviceCertificate::no_delay_limit, "N/m",
           "Stiffest linear wall at 1 kHz without delay, 2 b/T.", rules::kKnownBound),
    column("coulomb_friction", &DeviceCertificate::coulomb_friction, "N",
           "Smallest dry friction sigma_0(S).", rules::kKnownBound, true),
    column("delay", &DeviceCertificate::delay, "s", "Delay beyond that of the loop.",
           rules::kKnownBound, true),
    column("position_resolution", &DeviceCertificate::position_resolution, "m",
           "Step of the reported position along an axis.", rules::kKnownBound, true),
    column("force_resolution", &DeviceCertificate::force_resolution, "N",
           "Step of the force along an axis.", rules::kKnownBound, true),
    column("published_rate", &DeviceCertificate::published_rate, "Hz",
           "2 L/sigma_0(B), of Mahvash & Hayward 2005, eq. 5.", rules::kKnownBound, true),
    column("largest_position_step", &DeviceCertificate::largest_position_step, "m",
           "Largest position_resolution that dry friction certifies.", rules::kKnownBound, true));

/// Curves of all nodes end to end; node l owns the knots offset[l] .. offset[l+1]-1.
struct FlatCurves {
  std::vector<std::int64_t> offset;
  std::vector<float> knot;
  std::vector<float> slope;
};

/// One of the curves of a node.
using CurveMember = ResponseCurve& (*)(NodeResponse&);
ResponseCurve& normal_of(NodeResponse& node) {
  return node.normal;
}
ResponseCurve& lateral_of(NodeResponse& node) {
  return node.lateral;
}
ResponseCurve& coupling_of(NodeResponse& node) {
  return node.coupling.curve;
}
const ResponseCurve& get(const NodeResponse& node, CurveMember which) {
  return which(const_cast<NodeResponse&>(node));
}

FlatCurves flatten(const std::vector<NodeResponse>& responses, CurveMember which) {
  FlatCurves flat;
  flat.offset.push_back(0);
  for (const NodeResponse& response : responses) {
    const ResponseCurve& curve = get(response, which);
    flat.knot.insert(flat.knot.end(), curve.knot.begin(), curve.knot.end());
    flat.slope.insert(flat.slope.end(), curve.slope.begin(), curve.slope.end());
    flat.offset.push_back(static_cast<std::int64_t>(flat.knot.size()));
  }
  return flat;
}

void write_flat(hdf5::Writer& writer, const std::string& stem, const std::string& which,
                const FlatCurves& flat, const std::string& unit = "N/m") {
  writer.dataset(stem + "offset", flat.offset,
                 {"1", "First knot of each vertex; one row more than vertices."});
  writer.dataset(stem + "knot", flat.knot, {"m", "Knots of the " + which + " curves, from 0."});
  writer.dataset(stem + "slope", flat.slope,
                 {unit, "Slope of the " + which + " curves at each knot."});
}

/// Checks of the offsets come first: the other loops rely on them.
void check_offset(const Checks& checks, const std::string& name,
                  const std::vector<std::int64_t>& offset, std::size_t total) {
  if (offset.front() != 0) checks.fail_row(name, 0, "is not 0");
  for (std::size_t row = 1; row < offset.size(); ++row) {
    if (offset[row] < offset[row - 1]) checks.fail_row(name, row, "is below the row before it");
  }
  checks.require(
      offset.back() == static_cast<std::int64_t>(total), name,
      "ends at " + std::to_string(offset.back()) + ", " + std::to_string(total) + " knots found");
}

void check_flat(const Checks& checks, const std::string& stem, const FlatCurves& flat,
                const std::vector<NodeResponse>& responses) {
  checks.same_size(stem + "slope", flat.slope.size(), flat.knot.size());
  check_offset(checks, stem + "offset", flat.offset, flat.knot.size());
  checks.numbers(stem + "knot", flat.knot, rules::kNonNegative);
  checks.numbers(stem + "slope", flat.slope, rules::kNonNegative);
  for (std::size_t vertex = 0; vertex < responses.size(); ++vertex) {
    const auto first = static_cast<std::size_t>(flat.offset[vertex]);
    const auto last = static_cast<std::size_t>(flat.offset[vertex + 1]);
    const bool may_be_empty = responses[vertex].status == ResponseStatus::Hole;
    if (last - first < 2 && !(may_be_empty && last == first)) {
      checks.fail_row(stem + "offset", vertex, "leaves the curve of this vertex under 2 knots");
    }
    for (std::size_t k = first; k < last; ++k) {
      if (k == first && flat.knot[k] != 0) checks.fail_row(stem + "knot", k, "begins not at 0");
      if (k > first && !(flat.knot[k] > flat.knot[k - 1])) {
        checks.fail_row(stem + "knot", k, "is not above the knot before it");
      }
    }
  }
}

void read_flat(const hdf5::Reader& reader, const std::string& stem,
               std::vector<NodeResponse>& responses, CurveMember which,
               const char* slope_units = "N/m") {
  FlatCurves flat;
  flat.offset = reader.dataset<std::int64_t>(stem + "offset", "1", responses.size() + 1);
  flat.knot = reader.dataset<float>(stem + "knot", "m");
  flat.slope = reader.dataset<float>(stem + "slope", slope_units, flat.knot.size());
  check_flat(Checks(reader), stem, flat, responses);
  for (std::size_t vertex = 0; vertex < responses.size(); ++vertex) {
    const auto first = flat.offset[vertex];
    const auto last = flat.offset[vertex + 1];
    ResponseCurve& curve = which(responses[vertex]);
    curve.knot.assign(flat.knot.begin() + first, flat.knot.begin() + last);
    curve.slope.assign(flat.slope.begin() + first, flat.slope.begin() + last);
  }
}

std::vector<float> coupling_bases(const std::vector<NodeResponse>& responses) {
  std::vector<float> bases;
  bases.reserve(responses.size());
  for (const NodeResponse& response : responses) bases.push_back(response.coupling.base);
  return bases;
}

void read_coupling(const hdf5::Reader& reader, std::vector<NodeResponse>& responses) {
  read_flat(reader, "/response/coupling_", responses, coupling_of, "1/m");
  const auto bases = reader.dataset<float>("/response/coupling_base", "1", responses.size());
  Checks(reader).numbers("/response/coupling_base", bases, rules::kPositive);
  for (std::size_t v = 0; v < bases.size(); ++v) responses[v].coupling.base = bases[v];
}

void check_surface(const Checks& checks, const Library& library) {
  const std::size_t vertices = library.positions.size();
  checks.require(vertices > 0, "/surface/position", "is empty");
  checks.vectors("/surface/position", library.positions, rules::kFinite);
  checks.same_size("/surface/inward", library.inward.size(), vertices);
  checks.vectors("/surface/inward", library.inward, rules::kUnit);
  checks.corners("/surface/triangles", library.triangles, vertices);
  checks.same_size("/response/status", library.responses.size(), vertices);
  checks.require(std::isfinite(library.tool_radius) && library.tool_radius >= 0, "/@tool_radius",
                 "is not finite and not negative");
}

/// A bound below L_min that slides can exceed would be promised and not kept.
void check_enforceable(const Checks& checks, const Certificate& c) {
  const double smallest = std::min(c.min_lipschitz_bound, std::max(c.stick, c.slip));
  if (c.triangles.empty() || std::isinf(c.min_lipschitz_bound) || !(c.lipschitz_bound < smallest))
    return;
  checks.fail("/certificate@lipschitz_bound",
              "is " + number_text(c.lipschitz_bound) +
                  " N/m, below the smallest bound that the runtime can enforce "
                  "(min_lipschitz_bound), " +
                  number_text(c.min_lipschitz_bound) + " N/m: the certificate is false");
}

void check_certificate(const Checks& checks, const Library& library) {
  const Certificate& certificate = library.certificate;
  const auto check = [&](const char* name, double value, const Rule& rule) {
    const bool fits = value >= rule.low && value <= rule.high;
    if (!fits) checks.fail(std::string("/certificate@") + name, std::string("is not ") + rule.text);
  };
  const auto check_if_known = [&](const char* name, double value) {
    if (!std::isnan(value)) check(name, value, rules::kBound);
  };
  const auto triangles = static_cast<double>(library.triangles.size());
  const auto vertices = static_cast<double>(library.positions.size());
  check("friction", certificate.friction, rules::kNonNegative);
  check("depth", certificate.depth, rules::kNonNegative);
  check("stick", certificate.stick, rules::kBound);
  check("slip", certificate.slip, rules::kBound);
  check_if_known("min_lipschitz_bound", certificate.min_lipschitz_bound);
  check_if_known("lipschitz_bound", certificate.lipschitz_bound);
  check_enforceable(checks, certificate);
  check("worst_triangle", certificate.worst_triangle,
        Rule{-1, triangles - 1, false, false, "-1 or a triangle"});
  check("holes", certificate.holes, rules::up_to(vertices, "a number of vertices"));
  check("interpolated", certificate.interpolated, rules::up_to(vertices, "a number of vertices"));
  if (!certificate.triangles.empty()) {
    checks.same_size("/certificate/triangle/stick", certificate.triangles.size(),
                     library.triangles.size());
  }
  check_columns(checks, "/certificate/triangle", certificate.triangles, kTriangleColumns);
  check_columns(checks, "/certificate/device", certificate.devices, kDeviceColumns);
}

void check_for_writing(const Checks& checks, const Library& library) {
  check_surface(checks, library);
  check_columns(checks, "/response", library.responses, kResponseColumns);
  for (std::size_t vertex = 0; vertex < library.responses.size(); ++vertex) {
    for (const CurveMember which : {normal_of, lateral_of, coupling_of}) {
      const ResponseCurve& curve = get(library.responses[vertex], which);
      if (curve.knot.size() != curve.slope.size()) {
        checks.fail_row("/response/status", vertex, "knots and slopes differ in number");
      }
    }
  }
  check_flat(checks, "/response/normal_", flatten(library.responses, normal_of), library.responses);
  check_flat(checks, "/response/lateral_", flatten(library.responses, lateral_of),
             library.responses);
  if (library.kind == ResponseKind::Coupled) {
    check_flat(checks, "/response/coupling_", flatten(library.responses, coupling_of),
               library.responses);
    checks.numbers("/response/coupling_base", coupling_bases(library.responses), rules::kPositive);
  }
  check_certificate(checks, library);
  check_provenance(checks, library.provenance);
}

void write_surface(hdf5::Writer& writer, const Library& library) {
  writer.group("/surface", "The triangulation that carries the responses.");
  writer.dataset("/surface/position", library.positions, {"m", "Position of each vertex."});
  writer.dataset("/surface/inward", library.inward,
                 {"1", "Unit direction u^z at each vertex, into the body."});
  writer.dataset("/surface/triangles", library.triangles,
                 {"1", "Vertices of each triangle, counter-clockwise seen from outside."});
}

void write_responses(hdf5::Writer& writer, const Library& library) {
  writer.group("/response", "Force-deflection curves of each vertex: slopes at knots.");
  write_columns(writer, "/response", library.responses, kResponseColumns);
  write_flat(writer, "/response/normal_", "normal", flatten(library.responses, normal_of));
  write_flat(writer, "/response/lateral_", "lateral", flatten(library.responses, lateral_of));
  if (library.kind == ResponseKind::Decoupled) return;
  writer.dataset("/response/coupling_base", coupling_bases(library.responses),
                 {"1", "w(0) of each vertex; 1 at a hole."});
  write_flat(writer, "/response/coupling_", "coupling", flatten(library.responses, coupling_of),
             "1/m");
}

void write_certificate(hdf5::Writer& writer, const Certificate& certificate) {
  const std::string group = "/certificate";
  writer.group(group, "Bounds for passivity; without rows per triangle until certified.");
  writer.set_real(group, "friction", certificate.friction);
  writer.set_real(group, "depth", certificate.depth);
  writer.set_real(group, "stick", certificate.stick);
  writer.set_real(group, "slip", certificate.slip);
  if (!std::isnan(certificate.min_lipschitz_bound))
    writer.set_real(group, "min_lipschitz_bound", certificate.min_lipschitz_bound);
  if (!std::isnan(certificate.lipschitz_bound))
    writer.set_real(group, "lipschitz_bound", certificate.lipschitz_bound);
  writer.set_integer(group, "worst_triangle", certificate.worst_triangle);
  writer.set_text(group, "limited_by", certificate.limited_by);
  writer.set_text(group, "basis", certificate.basis);
  writer.set_integer(group, "holes", certificate.holes);
  writer.set_integer(group, "interpolated", certificate.interpolated);
  writer.group("/certificate/triangle", "Bounds of each triangle, in the order of the surface.");
  write_columns(writer, "/certificate/triangle", certificate.triangles, kTriangleColumns);
  writer.group("/certificate/device", "What each device profile yields on this library.");
  std::vector<std::string> names;
  for (const DeviceCertificate& device : certificate.devices) names.push_back(device.device);
  writer.texts("/certificate/device/name", names, "Name of the device profile.");
  write_columns(writer, "/certificate/device", certificate.devices, kDeviceColumns);
}

/// A 32-bit number from a 64-bit attribute.
std::int32_t read_int32(const hdf5::Reader& reader, const std::string& object,
                        const std::string& name) {
  const std::int64_t value = reader.integer(object, name);
  if (value < std::numeric_limits<std::int32_t>::min() ||
      value > std::numeric_limits<std::int32_t>::max()) {
    reader.fail(object + "@" + name, "is out of range");
  }
  return static_cast<std::int32_t>(value);
}

/// Names of the attributes of the certificate that schema 1 calls otherwise.
struct CertificateNames {
  const char* min_lipschitz_bound = "min_lipschitz_bound";
  const char* lipschitz_bound = "lipschitz_bound";
  const char* interpolated = "interpolated";
};

CertificateNames certificate_names(std::int64_t schema) {
  return schema == kFirstLibrarySchema ? CertificateNames{"hold", "limit", "filled"}
                                       : CertificateNames{};
}

/// NaN when the file does not say.
double real_if_there(const hdf5::Reader& reader, const std::string& object, const char* name) {
  return reader.has_attribute(object, name) ? reader.real(object, name)
                                            : std::numeric_limits<double>::quiet_NaN();
}

Certificate read_certificate(const hdf5::Reader& reader, const CertificateNames& names) {
  const std::string group = "/certificate";
  Certificate certificate;
  certificate.friction = reader.real(group, "friction");
  certificate.depth = reader.real(group, "depth");
  certificate.stick = reader.real(group, "stick");
  certificate.slip = reader.real(group, "slip");
  certificate.min_lipschitz_bound = real_if_there(reader, group, names.min_lipschitz_bound);
  certificate.lipschitz_bound = real_if_there(reader, group, names.lipschitz_bound);
  certificate.worst_triangle = read_int32(reader, group, "worst_triangle");
  certificate.limited_by = reader.text(group, "limited_by");
  if (reader.has_attribute(group, "basis")) certificate.basis = reader.text(group, "basis");
  certificate.holes = read_int32(reader, group, "holes");
  certificate.interpolated = read_int32(reader, group, names.interpolated);
  certificate.triangles =
      read_columns<TriangleCertificate>(reader, "/certificate/triangle", kTriangleColumns);
  certificate.devices =
      read_columns<DeviceCertificate>(reader, "/certificate/device", kDeviceColumns);
  const std::vector<std::string> devices =
      reader.texts("/certificate/device/name", certificate.devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) certificate.devices[i].device = devices[i];
  return certificate;
}

}  // namespace

double enforced_lipschitz_bound(const Certificate& certificate) {
  const Certificate& c = certificate;
  if (c.triangles.empty()) return std::numeric_limits<double>::infinity();
  if (!std::isnan(c.lipschitz_bound)) return c.lipschitz_bound;
  const double slides = std::min(std::max(c.stick, c.slip), 4 * c.stick);
  return std::isfinite(c.min_lipschitz_bound) ? std::max(slides, c.min_lipschitz_bound) : slides;
}

double certified_lipschitz_bound(const Certificate& certificate) {
  const double limit = enforced_lipschitz_bound(certificate);
  const bool free = limit >= std::max(certificate.stick, certificate.slip);
  return free || limit >= certificate.min_lipschitz_bound ? limit
                                                          : std::numeric_limits<double>::infinity();
}

void write_library(const std::filesystem::path& path, const Library& library) {
  check_for_writing(Checks(path), library);
  hdf5::Writer writer(path);
  const bool coupled = library.kind == ResponseKind::Coupled;
  write_root(writer, kLibraryArtifact, coupled ? kCoupledLibrarySchema : kLibrarySchema,
             "A response library: surface, responses, certificate.");
  writer.set_text("/", "name", library.name);
  writer.set_text("/", "tool_shape", library.tool_shape);
  writer.set_real("/", "tool_radius", library.tool_radius);
  write_surface(writer, library);
  write_responses(writer, library);
  write_certificate(writer, library.certificate);
  write_provenance(writer, library.provenance);
  writer.commit();
}

Library read_library(const std::filesystem::path& path) {
  hdf5::Reader reader(path, kLibraryRemedy);
  Library library;
  const std::int64_t schema = reader.require_artifact(
      kLibraryArtifact, {kFirstLibrarySchema, kLibrarySchema, kCoupledLibrarySchema});
  if (schema == kCoupledLibrarySchema) library.kind = ResponseKind::Coupled;
  library.name = reader.text("/", "name");
  library.tool_shape = reader.text("/", "tool_shape");
  library.tool_radius = reader.real("/", "tool_radius");
  library.positions = reader.dataset<Vec3>("/surface/position", "m");
  library.inward = reader.dataset<Vec3>("/surface/inward", "1", library.positions.size());
  library.triangles = reader.dataset<Triangle>("/surface/triangles", "1");
  library.responses = read_columns(reader, "/response", kResponseColumns, library.positions.size());
  read_flat(reader, "/response/normal_", library.responses, normal_of);
  read_flat(reader, "/response/lateral_", library.responses, lateral_of);
  if (library.kind == ResponseKind::Coupled) read_coupling(reader, library.responses);
  library.certificate = read_certificate(reader, certificate_names(schema));
  library.provenance = read_provenance(reader);
  const Checks checks(reader);
  check_surface(checks, library);
  check_certificate(checks, library);
  return library;
}

}  // namespace palpate
