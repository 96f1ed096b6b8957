// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/size_of_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "format/error.hpp"
#include "format/numbers.hpp"
#include "mesher/read/image/label_image.hpp"
#include "mesher/read/mesh/read_volume_mesh.hpp"
#include "mesher/read/read_surface.hpp"

namespace palpate::app {
namespace {

class Box {
 public:
  void add(const Vec3& x) {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], x[i]);
      high_[i] = std::max(high_[i], x[i]);
    }
  }
  Vec3 extent() const { return high_ - low_; }

 private:
  Vec3 low_{kInfinity, kInfinity, kInfinity};
  Vec3 high_{-kInfinity, -kInfinity, -kInfinity};
};

Box box_of_image(const mesher::LabelImage& image, const mesher::ImageFile& file) {
  Box box;
  const auto is_listed = [&](std::int32_t label) {
    return std::any_of(file.labels.begin(), file.labels.end(),
                       [&](const mesher::ImageLabel& l) { return l.value == label; });
  };
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i) {
        if (!is_listed(image.at(i, j, k))) continue;
        const Vec3 index{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        box.add(image.point(index - Vec3{0.5, 0.5, 0.5}));
        box.add(image.point(index + Vec3{0.5, 0.5, 0.5}));
      }
  return box;
}

Box box_of_body(const mesher::Settings& mesh, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / mesh.source();
  if (!mesh.image.path.empty())
    return box_of_image(mesher::read_label_image(path, mesh.image.unit), mesh.image);
  Box box;
  if (!mesh.volume_mesh.path.empty()) {
    mesher::VolumeMeshFile file = mesh.volume_mesh;
    file.path = path;
    for (const Vec3& x : mesher::read_volume_mesh(file, {}).nodes) box.add(x);
    return box;
  }
  const mesher::Soup soup = mesher::read_faces(path);
  for (const auto& polygon : soup.polygons)
    for (const std::size_t p : polygon)
      if (p < soup.points.size()) box.add(mesh.surface.unit * soup.points[p]);
  return box;
}

}  // namespace

BodySize size_of_body(const mesher::Settings& mesh, const std::filesystem::path& folder) {
  const Vec3 extent = box_of_body(mesh, folder).extent();
  const BodySize size{norm(extent), *std::min_element(extent.begin(), extent.end())};
  // A flat sheet has no thickness; the mesher says what is wrong with it, if it gets that far.
  if (!(size.diagonal > 0) || !std::isfinite(size.diagonal) || !(size.thickness > 0)) {
    throw Error(ErrorKind::Geometry, (folder / mesh.source()).string(),
                "the body has no extent, so that the lengths of the case cannot be derived from it",
                "export it again, or give patch_spacing and depth in the case");
  }
  return size;
}

}  // namespace palpate::app
