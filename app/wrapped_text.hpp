// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::app {

/// Text of which each line that is wider than `columns` is broken at blanks. What follows a break
/// is indented by as many blanks as the line itself and `hanging` more. A word that is wider than
/// the room stays whole. Colour codes take no room, and a letter of several bytes takes that of
/// one.
/// @param columns 0: any width
std::string wrapped(std::string_view text, std::size_t columns, std::size_t hanging);

/// The text of a command's help: a description that stands behind a name goes on below itself.
/// @param description column in which descriptions begin
std::string wrapped_help(std::string_view text, std::size_t columns, std::size_t description);

}  // namespace palpate::app
