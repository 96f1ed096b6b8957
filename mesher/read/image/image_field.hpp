// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/text.hpp"
#include "mesher/settings.hpp"
#include "mesher/volume/label_oracle.hpp"

namespace palpate::mesher {

/// The regions of an image as a body to be meshed. Labels of one region are joined; what is thinner
/// than a voxel may be missed.
/// @throws Error as read_label_image; Error(Configuration) for a label that no voxel has;
///   Error(Geometry) for an implausible size.
LabelField image_field(const ImageFile& file, const Log& log);

}  // namespace palpate::mesher
