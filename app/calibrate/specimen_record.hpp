// SPDX-License-Identifier: AGPL-3.0-or-later
// One test of a fit file: which columns of which record are its deformation and its stress.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

namespace palpate::app {

/// A [[test]] of a fit file, as it is written.
struct TestSection {
  std::string file, mode, measure = "nominal";
  std::string stress_file;           ///< where the stress or force stands alone in another file
  std::vector<std::string> columns;  ///< names in order, of a file without a header
  int table = 0;                     ///< of the file, from 1; 0: its only one
  std::string deformation, stress;   ///< columns of deformation and stress
  std::string displacement, force;   ///< or of travel and force, with a specimen
  std::string uncertainty;           ///< column, of the stress or the force
  std::string deformation_is;        ///< "stretch", "strain", "log strain" or "shear"
  std::string deformation_unit, stress_unit;  ///< where the file has none; of travel and force too
  std::string deformation_sign = "as recorded", stress_sign = "as recorded", zero = "as recorded";
  int first_row = 1, last_row = 0;  ///< of numbers; 0: the last
  int cycle = 0;                    ///< from 1; 0: all, -1: the last
  std::string branch = "both";
  double gauge_length = std::numeric_limits<double>::quiet_NaN();
  double width = std::numeric_limits<double>::quiet_NaN();
  double thickness = std::numeric_limits<double>::quiet_NaN();
  double diameter = std::numeric_limits<double>::quiet_NaN();
  std::string area;
  double weight = 1;
  bool offset = false;
};

/// The samples of the test, in SI.
/// @param folder  that of the fit file.
/// @param where   its place there, for messages.
/// @throws Error(Configuration) for columns that are not clear, a force without a section, a travel
///   without a gauge length, rows or cycles that the record does not have; as read_csv and
///   column_in_si.
calibrate::HomogeneousTest read_test(const TestSection& section,
                                     const std::filesystem::path& folder, const std::string& where);

/// First and last sample of the branches of a cyclic record, in turn away from rest and back. A
/// branch ends where the deformation has turned by more than a fifth of its range.
struct Branch {
  std::size_t first = 0, last = 0;
  bool loading = true;
};
std::vector<Branch> branches_of(const std::vector<double>& deformation, double rest);

}  // namespace palpate::app
