// SPDX-License-Identifier: AGPL-3.0-or-later
// Columns of numbers in MAT files of version 5 and before; those of version 7.3 are HDF5 files
// (format/foreign_hdf5.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::measured {

/// Whether the file is a MAT file of version 5, by its first bytes, or of version 4, by its name.
bool is_mat_file(const std::filesystem::path& file);

/// The numbers at a path as MATLAB writes it: "force", "run.force", "run(2).press.force",
/// "runs{2}.force"; "data(:,2)" is the second column of a matrix. Indices count from 1, in the
/// order of the memory of MATLAB.
/// @throws Error(Configuration) naming the file and the path: no such variable, field or index
///   (those there are listed), texts, objects, tables and complex or sparse numbers, a value that
///   is no finite number, a file that is cut off; or when palpate was built without libmatio.
std::vector<double> read_mat_column(const std::filesystem::path& file, const std::string& path);

}  // namespace palpate::measured
