// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

/// A script for bash that completes the subcommands and options of `root`, from the description
/// that the parser has; files where neither is expected.
std::string bash_completion(const CLI::App& root);

}  // namespace palpate::app
