// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::app {

/// Number of insertions, deletions and substitutions from one word to the other [Levenshtein 1966].
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` with the smallest edit distance, the first of several; "" when there is
/// none.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& known);

/// Whether `word` may be meant for `other`: no more than half of that is mistyped.
bool is_like(std::string_view word, std::string_view other);

/// What to write instead of a word that is not known: "WHAT is 'y'" where it is like the nearest,
/// y, else "known are" and the list.
std::string meant_instead(std::string_view word, const std::vector<std::string_view>& known,
                          std::string_view what);

}  // namespace palpate::app
