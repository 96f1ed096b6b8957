// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of each law with a shear modulus of about one.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "fitting/measurement/calibrate/incompressible_law.hpp"

namespace palpate::calibrate {

inline constexpr std::array kModes{Mode::Uniaxial, Mode::Equibiaxial, Mode::PureShear,
                                   Mode::SimpleShear};

/// Young's modulus of a case with a shear modulus of one.
inline constexpr double kYoung = 2 * (1 + kCasePoisson);

/// Typical constants of each law, away from special values.
inline std::vector<double> typical(std::string_view law) {
  if (law == "neo-hookean") return {kYoung};
  if (law == "mooney-rivlin") return {0.4, 0.1};
  if (law == "mooney-rivlin-5") return {0.3, 0.2, 0.12, 0.06, 0.09};
  if (law == "yeoh") return {0.5, -0.02, 0.003};
  if (law == "ogden-1") return {1, 4.3};
  if (law == "ogden-2") return {0.7, 1.7, 0.3, -3};
  if (law == "ogden-3") return {0.6, 1.3, 0.01, 5, 0.02, -2};
  if (law == "demiray-fung") return {1, 3};
  if (law == "veronda-westmann") return {0.25, 4};
  if (law == "gent") return {1, 20};
  return {1, 3};  // arruda-boyce
}

}  // namespace palpate::calibrate
