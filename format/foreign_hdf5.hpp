// SPDX-License-Identifier: Apache-2.0
// Columns of numbers in HDF5 files of other programs, found by their paths. No HDF5 header is
// needed to use it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::hdf5 {

/// One column, as it is stored.
struct ForeignColumn {
  std::vector<double> values;
  std::string unit;  ///< of the attribute `units` or `unit`; empty where there is none
};

/// Whether the file is an HDF5 file (MAT files of version 7.3 are), by its signature.
bool is_hdf5(const std::filesystem::path& file);

/// The numbers at a path: "/run1/force" or "run1.force", a data set or the member of a compound
/// one; "/run1/data(:,2)" is the second column of a table, "/run1/data(2,:)" its second row,
/// counted from 1. In MAT files rows and columns are those of MATLAB, which stores them transposed.
/// @throws Error(Configuration) naming the file and the path: no such name (those beside it are
///   listed), text or references instead of numbers, a table without a choice of its column, a
///   value that is no finite number, a data set that was never written or lies in other files, a
///   file that is cut off.
ForeignColumn read_foreign_column(const std::filesystem::path& file, const std::string& path);

}  // namespace palpate::hdf5
