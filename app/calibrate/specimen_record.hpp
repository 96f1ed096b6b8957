// SPDX-License-Identifier: AGPL-3.0-or-later
// One test of a fit file: which columns of which record are its deformation and its stress.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/measured/specimen_size.hpp"
#include "app/measured/table_keys.hpp"
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

namespace palpate::app {

/// A [[test]] of a fit file, as it is written.
struct TestSection {
  std::string file, mode, measure = "nominal";
  std::string stress_file;           ///< where the stress or force stands alone in another file
  std::vector<std::string> columns;  ///< names in order, of a file without a header
  measured::TableChoice choice;      ///< of the file
  std::string deformation, stress;   ///< columns of deformation and stress
  std::string displacement, force;   ///< or of travel and force, with a specimen
  std::string uncertainty;           ///< column, of the stress or the force
  std::string deformation_is;        ///< "stretch", "strain", "log strain" or "shear"
  std::string deformation_unit, stress_unit;  ///< where the file has none; of travel and force too
  std::string deformation_sign, stress_sign;  ///< "as recorded" (if empty) or "reversed"
  std::string load;  ///< "tension" or "compression", whatever the signs of the record; or empty
  std::string zero = "as recorded";
  int first_row = 1, last_row = 0;  ///< of numbers; 0: the last
  int cycle = 0;                    ///< from 1; 0: all, -1: the last
  std::string branch = "both";
  SpecimenSize size;
  double weight = 1;
  bool offset = false;
  bool clamped = false;  ///< by glued clamps or plates
};

/// The samples of a test, and how they follow from the columns of its record.
struct SpecimenTest {
  calibrate::HomogeneousTest test;
  std::string statement;  ///< "stretch = 1 - x/(20 mm), nominal stress = -F/(12.6 mm^2)"
};

/// The samples of the test, in SI. With `load` the signs follow from the record: strains and
/// stresses are positive in tension where they are largest, negative in compression.
/// @param folder  that of the fit file.
/// @param where   its place there, for messages.
/// @throws Error(Configuration) for columns that are not clear, a force without a section, a travel
///   without a gauge length, signs beside a load, a record of another load than is stated, rows or
///   cycles that the record does not have; as read_csv and column_in_si.
SpecimenTest read_test(const TestSection& section, const std::filesystem::path& folder,
                       const std::string& where);

/// First and last sample of the branches of a cyclic record, in turn away from rest and back. A
/// branch ends where the deformation has turned by more than a fifth of its range.
struct Branch {
  std::size_t first = 0, last = 0;
  bool loading = true;
};
std::vector<Branch> branches_of(const std::vector<double>& deformation, double rest);

}  // namespace palpate::app
