// SPDX-License-Identifier: AGPL-3.0-or-later
// One set of constants for every law of the table, of a soft tissue.
#pragma once

#include <ostream>
#include <vector>

#include "fem/laws/law_table.hpp"

namespace palpate::fem {

/// How googletest names a law among the parameters of a test.
inline void PrintTo(const LawConstants& constants, std::ostream* out) {
  *out << constants.law;
}

}  // namespace palpate::fem

namespace palpate::test {

/// Every law of the table, in its order, with a shear modulus of a few kPa at rest and constants
/// that let each of its terms act. `poisson` of all.
std::vector<fem::LawConstants> sample_laws(double poisson);

}  // namespace palpate::test
