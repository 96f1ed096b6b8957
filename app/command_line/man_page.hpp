// SPDX-License-Identifier: AGPL-3.0-or-later
// Manual pages from the description that the parser has.
#pragma once

#include <string>
#include <string_view>

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

/// Name of the page of a command: "palpate-export-site".
std::string man_page_name(const CLI::App& command);

/// The page in the man macros of roff [man(7)], section 1: synopsis, arguments, options,
/// subcommands and the footer of the help. `version` stands at the foot of the page.
std::string man_page(const CLI::App& command, std::string_view version);

}  // namespace palpate::app
