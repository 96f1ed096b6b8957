// SPDX-License-Identifier: AGPL-3.0-or-later
// The libraries that come with palpate, ready to be touched.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::app {

/// A flat library and the case that it was made of.
struct ShippedLibrary {
  std::string name;            ///< NAME of NAME.plib
  std::filesystem::path file;  ///< NAME.plib
  std::string about;  ///< first sentence of the comment that opens cases/NAME.toml; or empty
};

/// share/palpate/libraries beside the bin folder of this program, installed or not.
std::filesystem::path shipped_folder();

/// Those of the folder, by name; none where there is no such folder. Their cases are in the folder
/// `cases` beside it.
std::vector<ShippedLibrary> shipped_libraries(const std::filesystem::path& folder);

/// The library that a word of the command line means: a shipped one by its name; else a file, or a
/// folder with library.h5 or library.plib. "./liver" is never a name.
/// @throws Error(Configuration) where there is neither; it has the names.
std::filesystem::path chosen_library(const std::string& word, const std::filesystem::path& shipped);

}  // namespace palpate::app
