// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/body_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "app/init/voxel_normals.hpp"
#include "format/error.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/image/label_image.hpp"
#include "mesher/read/mesh/read_volume_mesh.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/read/unit_guess.hpp"
#include "mesher/volume/discretization.hpp"

namespace palpate::app {
namespace {

using mesher::Surface;

constexpr auto kVolumeEndings = std::to_array<std::string_view>(
    {".msh", ".mesh", ".inp", ".feb", ".node", ".ele", ".vtu", ".vtk"});
constexpr auto kImageEndings =
    std::to_array<std::string_view>({".nii", ".nii.gz", ".nrrd", ".nhdr"});

template <class Endings>
bool is_one_of(const Endings& endings, const std::string& ending) {
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

std::string first_bytes(const std::filesystem::path& path) {
  std::string bytes(2048, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

bool has_separate_parts(const mesher::FaultySurface& error) {
  const auto& faults = error.faces().faults;
  return std::find(faults.begin(), faults.end(), mesher::Fault::SeparatePart) != faults.end();
}

void read_skin(BodyFile& body, const std::string& given) {
  find_unit(body, given, mesher::largest_dimension(mesher::read_faces(body.path).points));
  mesher::SurfaceFile file{body.path, body.unit.si, ""};
  const auto read = [&] {
    body.surface = mesher::read_surface(file, [&](std::string_view line) {
      if (line.find(": repaired:") != std::string_view::npos) body.was_repaired = true;
    });
  };
  try {
    read();
  } catch (const mesher::FaultySurface& error) {
    if (!has_separate_parts(error)) throw;
    file.repair.largest_part = body.has_parts = true;
    read();
  }
}

/// The mesh in the first unit in which its size is one of a body: the reader refuses others.
/// @throws Error of the first unit in which the fault is not the size.
mesher::VolumeMesh read_in_some_unit(mesher::VolumeMeshFile& file) {
  std::exception_ptr fault;
  bool is_of_size = true;
  for (const double unit : {1e-3, 1.0, 1e-6}) {
    file.unit = unit;
    try {
      return mesher::read_volume_mesh(file, {});
    } catch (const Error& error) {
      if (!is_of_size) continue;
      fault = std::current_exception();
      is_of_size = error.problem().starts_with("the largest dimension");
    }
  }
  std::rethrow_exception(fault);
}

void read_volume(BodyFile& body, const std::string& given) {
  mesher::VolumeMeshFile file;
  file.path = body.path;
  const mesher::VolumeMesh volume = read_in_some_unit(file);
  body.regions = volume.region_names;
  body.surface.points = volume.nodes;
  body.surface.triangles = mesher::boundary_of(volume, body.path.string());
  find_unit(body, given, mesher::largest_dimension(volume.nodes) / file.unit);
  for (Vec3& x : body.surface.points) x = (body.unit.si / file.unit) * x;
}

/// The faces between voxels with a label and others.
Surface voxel_faces(const mesher::LabelImage& image) {
  Surface surface;
  std::map<std::array<std::size_t, 3>, std::int32_t> corners;
  const auto corner = [&](const std::array<std::size_t, 3>& at) {
    const auto [entry, is_new] =
        corners.try_emplace(at, static_cast<std::int32_t>(surface.points.size()));
    if (is_new)
      surface.points.push_back(
          image.point({static_cast<double>(at[0]) - 0.5, static_cast<double>(at[1]) - 0.5,
                       static_cast<double>(at[2]) - 0.5}));
    return entry->second;
  };
  const auto is_outside = [&](std::array<std::size_t, 3> at, std::size_t axis, bool upper) {
    if (upper ? at[axis] + 1 == image.size[axis] : at[axis] == 0) return true;
    at[axis] = upper ? at[axis] + 1 : at[axis] - 1;
    return image.at(at[0], at[1], at[2]) == 0;
  };
  const auto add_faces = [&](const std::array<std::size_t, 3>& at) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true}) {
        if (!is_outside(at, axis, upper)) continue;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<std::int32_t, 4> square{};
        for (std::size_t k = 0; k < 4; ++k) {
          std::array<std::size_t, 3> c = at;
          c[axis] += upper ? 1 : 0;
          c[u] += k == 1 || k == 2 ? 1 : 0;
          c[v] += k >= 2 ? 1 : 0;
          square[k] = corner(c);
        }
        if (!upper) std::swap(square[1], square[3]);
        surface.triangles.push_back({square[0], square[1], square[2]});
        surface.triangles.push_back({square[0], square[2], square[3]});
      }
  };
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        if (image.at(i, j, k) != 0) add_faces({i, j, k});
  return surface;
}

void read_segmentation(BodyFile& body, const std::string& given) {
  mesher::LabelImage image;
  body.unit_source = UnitSource::Stated;
  try {
    image = mesher::read_label_image(body.path, given.empty() ? 0 : length_unit(given).si);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Configuration || !given.empty()) throw;
    image = mesher::read_label_image(body.path, 1);
    body.unit_source = UnitSource::Guessed;
  }
  const std::set<std::int32_t> labels(image.labels.begin(), image.labels.end());
  body.labels.assign(labels.begin(), labels.end());
  std::erase_if(body.labels, [](std::int32_t label) { return label <= 0; });
  if (body.labels.empty())
    refuse_geometry(body.path.string(), "no voxel has a label", "export the segmentation again");
  body.surface = voxel_faces(image);
  body.area_excess = 1.5;  // mean of |n_x| + |n_y| + |n_z| over all directions n
  const bool is_in_metres = body.unit_source == UnitSource::Stated || !given.empty();
  if (!is_in_metres || !given.empty())
    find_unit(body, given, mesher::largest_dimension(body.surface.points));
  if (!is_in_metres) {
    for (Vec3& x : body.surface.points) x = body.unit.si * x;
    mesher::scale_image(image, body.unit.si, body.path.string());
  }
  const auto normals = std::make_shared<const VoxelNormals>(std::move(image));
  body.inward = [normals](const Vec3& point) { return normals->inward(point); };
}

}  // namespace

Unit length_unit(const std::string& symbol) {
  for (const Unit& unit : units_of(Dimension::Length))
    if (unit.symbol == symbol) return unit;
  refuse("--unit " + symbol, "no unit of length", "use one of " + unit_list(Dimension::Length));
}

void find_unit(BodyFile& body, const std::string& given, double raw) {
  if (!given.empty()) {
    body.unit = length_unit(given);
    body.unit_source = UnitSource::Given;
    return;
  }
  if (const auto stated = mesher::stated_unit(first_bytes(body.path))) {
    body.unit = *stated;
    body.unit_source = UnitSource::Stated;
    return;
  }
  if (!(raw > 0)) refuse_geometry(body.path.string(), "the body has no extent", "export it again");
  const mesher::UnitGuess guess = mesher::guess_unit(raw);
  body.unit = guess.likely;
  body.other_unit = guess.another;
}

BodyFile read_body_file(const std::filesystem::path& path, const std::string& unit) {
  BodyFile body;
  body.path = path;
  const std::string ending = mesher::ending(path);
  const bool is_vtk = ending == ".vtk" || ending == ".vtu";
  if (is_one_of(kImageEndings, ending)) {
    body.kind = BodyKind::Image;
    read_segmentation(body, unit);
    return body;
  }
  if (is_one_of(kVolumeEndings, ending)) {
    body.kind = BodyKind::VolumeMesh;
    try {
      read_volume(body, unit);
      return body;
    } catch (const Error&) {
      if (!is_vtk) throw;  // VTK files may be surfaces
      body = {};
      body.path = path;
    }
  }
  read_skin(body, unit);
  return body;
}

}  // namespace palpate::app
