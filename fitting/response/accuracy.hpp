// SPDX-License-Identifier: AGPL-3.0-or-later
// How far the forces at the vertices of a library are from those of a converged mesh.
#pragma once

#include <string>

#include "format/library.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {

/// Relative errors of the responses of one kind that 95 % of the vertices do not exceed: the
/// largest along a path, over the largest force of the response. NaN when unknown.
struct Accuracy {
  double mesh = kUnknown;  ///< of the curves, by NodeResponse::normal_mesh_error and its like
  double fit = kUnknown;   ///< of the responses, to the curves
};

/// A lateral force below a hundredth of the largest normal force counts as that hundredth.
Accuracy normal_accuracy(const Library& library);
Accuracy lateral_accuracy(const Library& library);

/// One sentence; empty where no vertex has a response.
std::string accuracy_text(const Library& library);

}  // namespace palpate::fitting
