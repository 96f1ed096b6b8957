// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace palpate::app {

/// Help no wider than the terminal, or 80 columns where its width is not known. It goes to the
/// commands that are added after it.
/// @param columns of the terminal; 0: unknown
std::shared_ptr<CLI::Formatter> help_formatter(int columns);

}  // namespace palpate::app
