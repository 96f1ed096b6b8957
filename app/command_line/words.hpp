// SPDX-License-Identifier: AGPL-3.0-or-later
// The words of a command line before they are parsed.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

/// "help SUBCOMMAND..." as "SUBCOMMAND... --help"; other words as they are.
std::vector<std::string> help_as_option(std::vector<std::string> words);

/// The message for the first subcommand or option that `root` does not know, with the nearest one
/// that it knows; "" where there is none. CLI11 would only say that something is missing or not
/// expected.
std::string unknown_word(const CLI::App& root, const std::vector<std::string>& words);

/// The command that explains the subcommand that was parsed last: "palpate help export site".
std::string help_for(const CLI::App& root);

}  // namespace palpate::app
