// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/image/image_field.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "format/error.hpp"
#include "mesher/read/body_size.hpp"
#include "mesher/read/image/label_image.hpp"

namespace palpate::mesher {
namespace {

using RegionOfLabel = std::map<std::int32_t, std::int32_t>;

std::string list_of(const std::map<std::int32_t, std::size_t>& counts) {
  std::string list;
  for (const auto& [label, count] : counts)
    if (label != 0)
      list += text(list.empty() ? "" : ", ", label, " (", counted(count, "voxel"), ")");
  return list;
}

/// The region of each label of the case; names are added to the field.
RegionOfLabel regions_of(const ImageFile& file, const std::map<std::int32_t, std::size_t>& counts,
                         LabelField& field, const Log& log) {
  RegionOfLabel region_of;
  std::map<std::int32_t, std::size_t> others = counts;
  for (const auto& [value, region] : file.labels) {
    if (!counts.contains(value)) {
      refuse(file.path.string(), text("no voxel has the label ", value),
             text("the labels of the image are ", list_of(counts)));
    }
    const auto known = std::find(field.region_names.begin(), field.region_names.end(), region);
    region_of[value] = static_cast<std::int32_t>(known - field.region_names.begin());
    if (known == field.region_names.end()) field.region_names.push_back(region);
    others.erase(value);
  }
  if (const std::string list = list_of(others); !list.empty()) {
    note(log, text(file.path.string(), ": no part of the body: labels ", list));
  }
  return region_of;
}

/// Corners of all voxels of the body, a voxel wider on every side.
Bounds box_of(const LabelImage& image, const RegionOfLabel& region_of) {
  std::vector<Vec3> corners;
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i) {
        if (!region_of.contains(image.at(i, j, k))) continue;
        for (unsigned corner = 0; corner < 8; ++corner)
          corners.push_back(image.point({static_cast<double>(i) + ((corner & 1U) != 0 ? 1 : -1),
                                         static_cast<double>(j) + ((corner & 2U) != 0 ? 1 : -1),
                                         static_cast<double>(k) + ((corner & 4U) != 0 ? 1 : -1)}));
        if (corners.size() > 100000) {
          const Bounds so_far = bounds(corners);
          corners = {so_far.low, so_far.high};
        }
      }
  return bounds(corners);
}

}  // namespace

LabelField image_field(const ImageFile& file, const Log& log) {
  const std::string where = file.path.string();
  const auto labels =
      std::make_shared<const ImageLabels>(read_label_image(file.path, file.unit), where);
  const LabelImage& image = labels->image();
  std::map<std::int32_t, std::size_t> counts;
  for (const std::int32_t label : image.labels) ++counts[label];
  LabelField field;
  const RegionOfLabel region_of = regions_of(file, counts, field, log);
  field.region = [labels, region_of](const Vec3& x) {
    const auto found = region_of.find(labels->label(x));
    return found == region_of.end() ? kVoid : found->second;
  };
  field.box = box_of(image, region_of);
  field.resolution = std::min({norm(image.step[0]), norm(image.step[1]), norm(image.step[2])});
  const Vec3 size = field.box.high - field.box.low;
  check_body_size(std::max({size[0], size[1], size[2]}), 1, where, log);
  note(log, text(where, ": ", image.size[0], " x ", image.size[1], " x ", image.size[2],
                 " voxels, the body within ", position_text(field.box.low), " to ",
                 position_text(field.box.high)));
  return field;
}

}  // namespace palpate::mesher
