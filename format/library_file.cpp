// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "format/artifact.hpp"
#include "format/columns.hpp"
#include "format/flat_file.hpp"
#include "format/flat_library.hpp"
#include "format/library_checks.hpp"
#include "format/library_columns.hpp"

namespace palpate {
namespace {

constexpr const char* kLibraryArtifact = "palpate.library";
constexpr const char* kLibraryRemedy = "make it again with 'palpate fit'";

void write_flat(hdf5::Writer& writer, const std::string& stem, const std::string& which,
                const FlatCurves& flat, const std::string& unit = "N/m") {
  writer.dataset(stem + "offset", flat.offset,
                 {"1", "First knot of each vertex; one row more than vertices."});
  writer.dataset(stem + "knot", flat.knot, {"m", "Knots of the " + which + " curves, from 0."});
  writer.dataset(stem + "slope", flat.slope,
                 {unit, "Slope of the " + which + " curves at each knot."});
}

void read_flat(const hdf5::Reader& reader, const std::string& stem,
               std::vector<NodeResponse>& responses, CurveMember which,
               const char* slope_units = "N/m") {
  FlatCurves flat;
  flat.offset = reader.dataset<std::int64_t>(stem + "offset", "1", responses.size() + 1);
  flat.knot = reader.dataset<float>(stem + "knot", "m");
  flat.slope = reader.dataset<float>(stem + "slope", slope_units, flat.knot.size());
  check_curves(Checks(reader), stem, flat, responses);
  unflatten(flat, which, responses);
}

void read_coupling(const hdf5::Reader& reader, std::vector<NodeResponse>& responses) {
  read_flat(reader, "/response/coupling_", responses, coupling_of, "1/m");
  const auto bases = reader.dataset<float>("/response/coupling_base", "1", responses.size());
  Checks(reader).numbers("/response/coupling_base", bases, rules::kPositive);
  for (std::size_t v = 0; v < bases.size(); ++v) responses[v].coupling.base = bases[v];
}

void read_relaxation(const hdf5::Reader& reader, Library& library) {
  library.relaxation_times = reader.dataset<double>("/relaxation/time", "s");
  const auto fractions = reader.dataset<float>("/response/relaxation_fraction", "1");
  check_relaxation(Checks(reader), library, fractions);
  set_relaxation_fractions(fractions, library);
}

void read_rows(const hdf5::Reader& reader, const NodeVector& vector, Library& library) {
  set_rows(Checks(reader), reader.dataset<std::array<float, 3>>(vector.name, "1"), vector, library);
}

void read_soft_axes(const hdf5::Reader& reader, Library& library) {
  if (reader.integer("/", "soft_axes") != 1) reader.fail("/@soft_axes", "is not 1");
  if (library.kind == ResponseKind::Decoupled) reader.fail(kSoftAxes.name, kSoftAndDecoupled);
  read_rows(reader, kSoftAxes, library);
}

void write_surface(hdf5::Writer& writer, const Library& library) {
  writer.group("/surface", "The triangulation that carries the responses.");
  writer.dataset("/surface/position", library.positions, {"m", "Position of each vertex."});
  writer.dataset("/surface/inward", library.inward,
                 {"1", "Unit direction u^z at each vertex, into the body."});
  writer.dataset("/surface/triangles", library.triangles,
                 {"1", "Vertices of each triangle, counter-clockwise seen from outside."});
}

/// A bound of the error of the mesh.
struct MeshError {
  const char* name;
  double NodeResponse::*value;
  const char* description;
};
constexpr MeshError kMeshErrors[] = {
    {"/response/normal_mesh_error", &NodeResponse::normal_mesh_error,
     "Bound of the error of the mesh in the normal curves; NaN when unknown."},
    {"/response/lateral_mesh_error", &NodeResponse::lateral_mesh_error,
     "Bound of the error of the mesh in the lateral curves; NaN when unknown."}};

/// Not written where it is unknown everywhere.
void write_mesh_errors(hdf5::Writer& writer, const std::vector<NodeResponse>& responses) {
  for (const MeshError& error : kMeshErrors) {
    std::vector<double> values;
    for (const NodeResponse& response : responses) values.push_back(response.*error.value);
    if (std::all_of(values.begin(), values.end(), [](double e) { return std::isnan(e); })) continue;
    writer.dataset(error.name, values, {"N", error.description});
  }
}

void read_mesh_errors(const hdf5::Reader& reader, std::vector<NodeResponse>& responses) {
  for (const MeshError& error : kMeshErrors) {
    if (!reader.has(error.name)) continue;
    const auto values = reader.dataset<double>(error.name, "N", responses.size());
    Checks(reader).numbers(error.name, values, rules::kKnownNonNegative);
    for (std::size_t v = 0; v < values.size(); ++v) responses[v].*error.value = values[v];
  }
}

void write_responses(hdf5::Writer& writer, const Library& library) {
  writer.group("/response", "Force-deflection curves of each vertex: slopes at knots.");
  write_columns(writer, "/response", library.responses, kResponseColumns);
  write_mesh_errors(writer, library.responses);
  write_flat(writer, "/response/normal_", "normal", flatten(library.responses, normal_of));
  write_flat(writer, "/response/lateral_", "lateral", flatten(library.responses, lateral_of));
  if (library.relaxes()) {
    writer.group("/relaxation", "How the normal responses relax under a deflection that stays.");
    writer.dataset("/relaxation/time", library.relaxation_times, {"s", "Relaxation times."});
    writer.dataset("/response/relaxation_fraction", relaxation_fractions(library),
                   {"1", "Fraction that relaxes with each time, vertex by vertex."});
  }
  if (library.leans())
    writer.dataset(kLeans.name, rows_of(library.responses, kLeans),
                   {"1",
                    "Lateral deflection of a straight press over its depth, of each vertex with a "
                    "response; of coupled responses at w = 1."});
  if (library.has_soft_axes())
    writer.dataset(kSoftAxes.name, rows_of(library.responses, kSoftAxes),
                   {"1",
                    "Soft axis b of each vertex with a response: along it the lateral stiffness is "
                    "(1 - |b|^2)^2 of that across it."});
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
  if (certificate.relaxation_rate > 0)
    writer.set_real(group, "relaxation_rate", certificate.relaxation_rate);
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
  if (reader.has_attribute(group, "relaxation_rate"))
    certificate.relaxation_rate = reader.real(group, "relaxation_rate");
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

void write_library(const std::filesystem::path& path, const Library& library) {
  check_for_writing(Checks(path), library);
  hdf5::Writer writer(path);
  const bool coupled = library.kind == ResponseKind::Coupled;
  write_root(writer, kLibraryArtifact, schema_of(library),
             "A response library: surface, responses, certificate.");
  const int schema = schema_of(library);
  if (schema >= kRelaxingLibrarySchema) writer.set_integer("/", "coupled", coupled ? 1 : 0);
  if (schema >= kGrippingLibrarySchema) {
    writer.set_integer("/", "relaxes", library.relaxes() ? 1 : 0);
    writer.set_integer("/", "leans", library.leans() ? 1 : 0);
  }
  if (schema >= kSoftLibrarySchema) writer.set_integer("/", "soft_axes", 1);
  writer.set_text("/", "name", library.name);
  writer.set_text("/", "tool_shape", library.tool_shape);
  writer.set_real("/", "tool_radius", library.tool_radius);
  write_surface(writer, library);
  write_responses(writer, library);
  write_certificate(writer, library.certificate);
  write_provenance(writer, library.provenance);
  writer.commit();
}

namespace {

Library read_hdf5_library(const std::filesystem::path& path) {
  hdf5::Reader reader(path, kLibraryRemedy);
  Library library;
  const std::int64_t schema = reader.require_artifact(
      kLibraryArtifact,
      {kFirstLibrarySchema, kLibrarySchema, kFormerCoupledSchema, kRelaxingLibrarySchema,
       kGrippingLibrarySchema, kLeaningLibrarySchema, kSoftLibrarySchema});
  const bool said = schema >= kGrippingLibrarySchema;
  const auto says = [&](const char* name) { return reader.integer("/", name) == 1; };
  const bool relaxes = said ? says("relaxes") : schema == kRelaxingLibrarySchema;
  const bool coupled = schema >= kRelaxingLibrarySchema && says("coupled");
  if (schema == kFormerCoupledSchema || (coupled && !said)) reader.fail("/", kFormerCoupled);
  if (schema == kGrippingLibrarySchema && coupled && says("leans")) reader.fail("/", kFormerLean);
  if (coupled) library.kind = ResponseKind::Coupled;
  library.name = reader.text("/", "name");
  library.tool_shape = reader.text("/", "tool_shape");
  library.tool_radius = reader.real("/", "tool_radius");
  library.positions = reader.dataset<Vec3>("/surface/position", "m");
  library.inward = reader.dataset<Vec3>("/surface/inward", "1", library.positions.size());
  library.triangles = reader.dataset<Triangle>("/surface/triangles", "1");
  library.responses = read_columns(reader, "/response", kResponseColumns, library.positions.size());
  read_mesh_errors(reader, library.responses);
  read_flat(reader, "/response/normal_", library.responses, normal_of);
  read_flat(reader, "/response/lateral_", library.responses, lateral_of);
  if (library.kind == ResponseKind::Coupled) read_coupling(reader, library.responses);
  if (relaxes) read_relaxation(reader, library);
  if (said && says("leans")) read_rows(reader, kLeans, library);
  if (schema >= kSoftLibrarySchema) read_soft_axes(reader, library);
  library.certificate = read_certificate(reader, certificate_names(schema));
  library.provenance = read_provenance(reader);
  check_library(Checks(reader), library);
  return library;
}

/// The bytes as a temporary file that exists as long as the object: the reader needs a path.
class MemoryFile {
 public:
  MemoryFile(const void* bytes, std::size_t size)
      : path_((std::filesystem::temp_directory_path() / "palpate-XXXXXX").string()) {
    const int file = mkostemp(path_.data(), O_CLOEXEC);
    if (file < 0) fail_to("create", path_);
    const char* from = static_cast<const char*>(bytes);
    bool good = true;
    while (good && size > 0) {
      const ssize_t count = write(file, from, size);
      good = count > 0;
      from += count;
      size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
    close(file);
    if (good) return;
    unlink(path_.c_str());
    fail_to("write", path_);
  }
  ~MemoryFile() { unlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] static void fail_to(const char* what, const std::string& path) {
    throw Error(ErrorKind::Internal, path, std::string("cannot ") + what + " the temporary file",
                "set TMPDIR to a folder with room");
  }

  std::string path_;
};

/// The library in that file; errors name the bytes instead of the file.
Library read_from(const MemoryFile& file) {
  try {
    return read_hdf5_library(file.path());
  } catch (const Error& e) {
    std::string where = e.where();
    if (where.rfind(file.path(), 0) == 0) where.replace(0, file.path().size(), kInMemory);
    throw Error(e.kind(), where, e.problem(), e.remedy());
  }
}

}  // namespace

Library read_library(const std::filesystem::path& path) {
  if (is_flat_file(path)) return read_flat_library(content_of(path), path);
  return read_hdf5_library(path);
}

Library library_from_bytes(std::string_view bytes) {
  if (begins_flat(bytes)) return read_flat_library(bytes, kInMemory);
  return read_from(MemoryFile(bytes.data(), bytes.size()));
}

}  // namespace palpate
