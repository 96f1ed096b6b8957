// SPDX-License-Identifier: AGPL-3.0-or-later
// One set of constants for every law of the table, of a soft tissue.
#pragma once

#include <vector>

#include "fem/laws/law_table.hpp"

namespace palpate::test {

/// Every law of the table, in its order, with a shear modulus of a few kPa at rest and constants
/// that let each of its terms act. `poisson` of all.
std::vector<fem::LawConstants> sample_laws(double poisson);

}  // namespace palpate::test
