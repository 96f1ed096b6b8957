// SPDX-License-Identifier: Apache-2.0
// Columns of matrices, as MATLAB writes them: "data(:,2)".
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// A name, and the column or row of it that is meant.
struct MatrixPath {
  std::string base;
  int column = 0;  ///< from 1; 0: none is chosen
  int row = 0;
  bool chosen() const { return column > 0 || row > 0; }
};

/// Takes "(:,2)" or "(2,:)" from the end of a path.
/// @throws Error(Configuration) at `where` for a number that is not from 1 on.
MatrixPath matrix_path(const std::string& path, const std::string& where);

/// @throws Error(Configuration) at `where` that says which value is not a finite number.
void check_finite(const std::vector<double>& values, const std::string& where);

}  // namespace palpate
