// SPDX-License-Identifier: AGPL-3.0-or-later
// The file of `palpate calibrate`: which law, on which tests. Reference: docs/measured.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fem/specimen/clamped.hpp"
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

namespace palpate::app {

struct FitFile {
  std::string name, source, licence;
  calibrate::HomogeneousSettings settings;
  std::vector<calibrate::HomogeneousTest> tests;
  std::vector<std::optional<fem::ClampedSpecimen>> specimens;  ///< of each test; without a law
  std::vector<std::string> statements;       ///< how each test follows from its record
  std::vector<std::filesystem::path> files;  ///< records of the tests
};

/// Read the file and all its records, in SI.
/// @throws Error(Configuration) with file and line.
FitFile read_fit_file(const std::filesystem::path& path);

}  // namespace palpate::app
