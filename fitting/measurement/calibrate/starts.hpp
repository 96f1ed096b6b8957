// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the fit of a law starts, and between which bounds it looks.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "fitting/measurement/calibrate/incompressible_law.hpp"

namespace palpate::calibrate {

/// Start and bounds of a constant, in Pa or pure.
struct ConstantInfo {
  std::string name;
  bool is_stress = true;  ///< in Pa; otherwise a pure number
  double start = 0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The constants of a law with default starts and bounds. The bounds lie within the ranges of the
/// table and exclude constants that make the law unstable in every deformation.
/// @param scale  shear modulus at rest that the data suggest, Pa.
std::vector<ConstantInfo> default_constants(const IncompressibleLaw& law, double scale);

/// Full sets of starts for the laws whose cost has several minima; none for the other laws.
std::vector<std::vector<double>> several_starts(const IncompressibleLaw& law, double scale);

}  // namespace palpate::calibrate
