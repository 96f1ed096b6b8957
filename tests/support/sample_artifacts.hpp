// SPDX-License-Identifier: AGPL-3.0-or-later
// Artifacts with random but valid content, the same in every run, for the tests of the files.
#pragma once

#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"

namespace palpate::samples {

Body body(unsigned seed);               ///< a jittered block of 3 x 3 x 3 cells, two regions
Body sprung_body(unsigned seed);        ///< the same with a foundation
Body curved_body(unsigned seed);        ///< the same with a foundation and curved edges
Body measured_body(unsigned seed);      ///< its skin alone, as measured
Curves curves(unsigned seed);           ///< 20 sites: complete, partial, failed without paths
Curves relaxing_curves(unsigned seed);  ///< the same of tissue that relaxes, two regions
Library library(unsigned seed);  ///< certified, with an interpolated node, a hole and two devices
Recording recording(unsigned seed);  ///< 5000 steps: more than one chunk; one reading is NaN

/// Every member as text, floating point in hexadecimal: equal texts mean equal bits.
std::string dump(const Body& body);
std::string dump(const Curves& curves);
/// The same with coupled responses.
Library coupled_library(unsigned seed);
/// The same with responses that relax, coupled where the seed is odd.
Library relaxing_library(unsigned seed);
/// Decoupled, coupled or relaxing, by the seed.
Library leaning_library(unsigned seed);
/// Coupled responses with soft axes, which lean, relax, or do neither in turn.
Library soft_library(unsigned seed);
std::string dump(const Library& library);
std::string dump(const Recording& recording);

}  // namespace palpate::samples
