// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fitting/response/fit_settings.hpp"

namespace palpate::fitting {

/// Gives every hole of the triangulation the mean response of its neighbours, ring by ring, with
/// status Interpolated. Its errors are the largest differences from a neighbour.
void fill_holes(Library& library, const FitSettings& settings);

}  // namespace palpate::fitting
