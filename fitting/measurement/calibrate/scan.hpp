// SPDX-License-Identifier: AGPL-3.0-or-later
// Starts that the data give: the constants that are linear in the stress follow from the exponents
// by linear least squares, so that only the exponents are scanned.
#pragma once

#include <vector>

#include "fitting/measurement/calibrate/incompressible_law.hpp"

namespace palpate::calibrate {

/// One sample as the fit weighs it.
struct WeightedSample {
  Mode mode = Mode::Uniaxial;
  double deformation = 1;
  double stress = 0;  ///< nominal, Pa
  double factor = 1;  ///< of its residual
  std::size_t test = 0;
};

struct ScanSettings {
  bool any_sign = false;  ///< moduli of Ogden's terms of either sign; otherwise none below zero
  std::size_t starts = 6;
  std::vector<bool> offset;  ///< for each test, whether a constant stress is fitted to it as well
};

/// Full sets of constants of the law (without offsets), the best first. Exponents are scanned over
/// the range in which they make a difference within the strains of the data; sets that differ from
/// a better one by neighbours of the scan only are left out. Laws that are linear in their
/// constants have one start, their solution.
std::vector<std::vector<double>> scanned_starts(const IncompressibleLaw& law,
                                                const std::vector<WeightedSample>& samples,
                                                const ScanSettings& settings = {});

/// For Ogden's law, the constants with one term in turn exchanged for another one of the scan, and
/// all moduli solved for: ways out of ends at which two terms are one. None for other laws.
std::vector<std::vector<double>> exchanged_terms(const IncompressibleLaw& law,
                                                 const std::vector<WeightedSample>& samples,
                                                 const std::vector<double>& constants,
                                                 const ScanSettings& settings = {});

/// I1 - 3 of the incompressible deformation.
double first_invariant(Mode mode, double deformation);

}  // namespace palpate::calibrate
