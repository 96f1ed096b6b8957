// SPDX-License-Identifier: AGPL-3.0-or-later
// Names of many files, and what they say: "run-{x}-{y}-*.csv".
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace palpate::app {

/// What a file or a row of a list says, by name.
using NamedValues = std::map<std::string, std::string>;

struct MatchedFile {
  std::filesystem::path file;  ///< as the pattern is: relative to the same folder
  NamedValues values;
};

/// Whether a text has placeholders of a pattern: "*", "?" or "{name}".
bool is_pattern(const std::string& text);

/// The files below a folder that match, in the order of their names, numbers by their value. "*"
/// and
/// "?" stand for any text and any character within a name, "{name}" for a text that is not empty.
/// Folders may be patterns as well.
/// @throws Error(Configuration) at `where`: a brace without its other one, a name given twice, no
///   file that matches.
std::vector<MatchedFile> matching_files(const std::filesystem::path& folder,
                                        const std::string& pattern, const std::string& where);

/// The text with its placeholders replaced.
/// @throws Error(Configuration) at `where` for a name that has no value; those that have are
/// listed.
std::string filled_in(const std::string& text, const NamedValues& values, const std::string& where);

/// The rows of a text table under a header of names, whatever they hold.
/// @throws Error(Configuration) with file and line: no rows, a row of another width, a name twice.
std::vector<NamedValues> read_list(const std::filesystem::path& file);

}  // namespace palpate::app
