// SPDX-License-Identifier: AGPL-3.0-or-later
// The case that `palpate init` writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/init/base.hpp"
#include "app/init/body_file.hpp"
#include "app/init/first_sizes.hpp"

namespace palpate::app {

struct FirstCase {
  std::string toml;
  std::vector<std::string> remarks;  ///< for the terminal: unit, base, sizes, what to check
  bool is_refused = false;           ///< by the mesher, with these sizes
};

/// Where the unit is from, and what it makes of the size.
/// @param raw largest dimension in units of the file
std::string unit_reason(const BodyFile& body, double raw);

/// A short case with a comment on each line that says why.
/// @param file path of the body as the case names it
/// @param name of the case; empty: that of its file
FirstCase first_case(const BodyFile& body, const Base& base, const FirstSizes& sizes,
                     const std::string& file, const std::string& name);

}  // namespace palpate::app
