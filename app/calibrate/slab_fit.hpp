// SPDX-License-Identifier: AGPL-3.0-or-later
// Presses of many sites of an organ as those of one slab of unknown thickness: a modulus for each
// site, and one stiffening and one thickness for all.
#pragma once

#include <string>
#include <vector>

#include "app/calibrate/press_fit.hpp"
#include "app/calibrate/slab_table.hpp"

namespace palpate::app {

/// What the data say of a quantity within the range of the table.
struct Identified {
  double value = 0, low = 0, high = 0;   ///< of the best fit, and where its profile ends
  bool no_low = false, no_high = false;  ///< the profile does not end before the range does

  bool is_interval() const { return !no_low && !no_high; }
  bool is_nothing() const { return no_low && no_high; }
};

struct SlabFit {
  PressFit fit;           ///< stiffening and inverse thickness, then the moduli, then the shifts
  Identified stiffening;  ///< pure
  Identified thickness;   ///< m
  double median_modulus = 0, least_modulus = 0, largest_modulus = 0;  ///< Pa, at rest
  double modulus_thickness =
      0;  ///< median correlation of a modulus with 1/thickness; unknown at a bound
  double modulus_stiffening = 0;  ///< and with the stiffening
};

/// The depths that are compared: of the table that the fit needs.
std::vector<double> compared_depths(const Curves& measured, int depths);

/// fit_presses() with the forces of a slab.
/// @throws Error(Configuration) as fit_presses.
SlabFit fit_slab(const Curves& measured, const SlabTable& table, const PressFitSettings& settings);

/// The fitted forces as the curves of a model, at the sites of the measurement.
Curves fitted_curves(const Curves& measured, const PressFit& fit);

}  // namespace palpate::app
