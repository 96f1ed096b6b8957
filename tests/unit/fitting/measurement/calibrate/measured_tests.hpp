// SPDX-License-Identifier: AGPL-3.0-or-later
// The measured tables of data/measured as tests in homogeneous deformations.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/calibrate/homogeneous_fit.hpp"
#include "fitting/measurement/records/csv_table.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::calibrate {

inline HomogeneousTest measured_test(const std::string& file, Mode mode) {
  const auto table = measured::read_csv(test::source_folder() / "data/measured" / file);
  HomogeneousTest test;
  test.name = file;
  test.mode = mode;
  test.deformation = measured::column_in_si(table, table.columns[0].name, Dimension::Ratio);
  test.nominal = measured::column_in_si(table, table.columns[1].name, Dimension::Pressure);
  return test;
}

inline std::vector<HomogeneousTest> three_modes(const std::string& folder) {
  return {measured_test(folder + "/uniaxial.csv", Mode::Uniaxial),
          measured_test(folder + "/equibiaxial.csv", Mode::Equibiaxial),
          measured_test(folder + "/pure-shear.csv", Mode::PureShear)};
}

}  // namespace palpate::calibrate
