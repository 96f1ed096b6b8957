// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/experiment/slingshot.hpp"

namespace palpate::app {

/// The cylinder with the tool in it, as in figure 11 of [Mahvash & Hayward 2005]: the patches, the
/// active one marked, the tip, the contact point, the deflection between them and the force, after
/// a straight press along the line of motion to `depth` (m). An SVG picture to scale.
/// @throws Error(Internal) when the file cannot be written.
void write_touch_picture(const std::filesystem::path& file, const SlingshotSetup& setup, double k,
                         double depth);

}  // namespace palpate::app
