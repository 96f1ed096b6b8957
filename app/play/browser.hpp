// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a page goes that nobody named a place for, and the browser that shows it.
#pragma once

#include <filesystem>
#include <string>

namespace palpate::app {

/// NAME.html in the palpate folder of XDG_CACHE_HOME, or else of ~/.cache, or else in the folder
/// for temporary files. The folder is made. @throws Error(Configuration) where it cannot be.
std::filesystem::path cached_page(const std::string& name);

/// Shows a file, by its absolute path, or an address with xdg-open, without waiting for it.
/// @return false without a display or without xdg-open
bool open_in_browser(std::string page);

}  // namespace palpate::app
