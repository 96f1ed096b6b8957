// SPDX-License-Identifier: AGPL-3.0-or-later
// Each comparison of a verification test becomes a row of docs/VERIFICATION.md, which
// scripts/verification_table.py makes.
#pragma once

#include <string>

namespace palpate::test {

/// What the reference is, and so what the comparison shows.
enum class Reference {
  ClosedForm,   ///< a formula of the theory, evaluated in the test
  Theory,       ///< a rate or an identity that the theory demands
  Published,    ///< a number printed in a public source
  Recalled,     ///< a number or trend remembered from the literature and not checked against it
  OtherSolver,  ///< computed by a program that shares no code with this one
  SameSolver,   ///< the same program on another mesh, element or setting
  Calibration   ///< a value that a constant of the solver was chosen to meet
};

/// The unit of an error and of its bound.
enum class Error {
  Relative,  ///< to the reference
  Absolute   ///< in the unit of the quantity
};

struct Comparison {
  std::string problem;   ///< heading of the table, "Hertz"
  std::string quantity;  ///< "force at nu = 0.3, 12 600 nodes"
  std::string unit;      ///< of both numbers; "1" when dimensionless
  double computed;
  double reference;
  Reference kind;
  std::string source;  ///< of the reference
  double bound;        ///< of the error
  Error error = Error::Relative;
};

/// Expects the error to be within the bound, and appends the row, one line of JSON, to the file of
/// the running test. The first row of a test truncates the file.
void verify(const Comparison& comparison);

}  // namespace palpate::test
