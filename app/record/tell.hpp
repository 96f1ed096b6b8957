// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/record/session_recorder.hpp"

namespace palpate::app {

void tell(const Recovered& recovered);  ///< on the standard output
/// recover_what_was_left, told.
void tell_what_was_left(const std::filesystem::path& recording);

}  // namespace palpate::app
