// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fitting/response/fit_settings.hpp"

namespace palpate::fitting {

/// Give every hole of the triangulation the mean response of its neighbours, nearest rings first,
/// and mark it Filled. Its errors are the largest difference to a neighbour: the honest doubt about
/// a response that was never solved.
void fill_holes(Library& library, const FitSettings& settings);

}  // namespace palpate::fitting
