// SPDX-License-Identifier: AGPL-3.0-or-later
// A verification test says what it compares with what, and leaves it as a row of a table from which
// scripts/verification_table.py makes docs/VERIFICATION.md.
#pragma once

#include <string>

namespace palpate::test {

/// What an error is measured in, and with it its bound.
enum class Error {
  Relative,  ///< to the reference
  Absolute   ///< in the unit of the quantity
};

struct Comparison {
  std::string problem;   ///< heading under which the row stands, "Hertz"
  std::string quantity;  ///< "force at nu = 0.3, 12 600 nodes"
  std::string unit;      ///< of both numbers; "1" when dimensionless
  double computed;
  double reference;
  /// Where the reference comes from, after its mark: [P] printed in a public source, [C] computed
  /// for this project independently of the solver, [R] recalled from the literature.
  std::string source;
  double bound;  ///< of the error
  Error error = Error::Relative;
};

/// Expects the error to be within the bound, and appends the row, one line of JSON, to the file of
/// the running test; the first row of a test begins its file anew.
void verify(const Comparison& comparison);

/// Leaves a row that says why the running test compared nothing, so that its rows are not missed.
void record_skipped(const std::string& problem, const std::string& reason);

}  // namespace palpate::test
