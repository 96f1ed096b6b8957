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

/// What the data say of the size of the constants.
struct DataScale {
  double modulus = 1;    ///< shear modulus at rest that they suggest, Pa
  double invariant = 0;  ///< largest I1 - 3, which a limit of the law must exceed
};

/// The constants of a law with default starts and bounds. The bounds lie within the ranges of the
/// table. Where a sign makes a law stable in every deformation (Mooney-Rivlin's C01, the moduli of
/// Ogden's terms), it is a bound here and not one of wide_constants(). Gent's limit J_m lies beyond
/// the data.
std::vector<ConstantInfo> default_constants(const IncompressibleLaw& law, const DataScale& scale);

/// The same with the ranges of the table where these are wider than what makes the law stable
/// everywhere: the stability of a fit within them is to be checked.
std::vector<ConstantInfo> wide_constants(const IncompressibleLaw& law, const DataScale& scale);

}  // namespace palpate::calibrate
