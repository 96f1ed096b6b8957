// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/record/session_recorder.hpp"

namespace palpate::app {

void report(const Recovered& recovered);  ///< on the standard output
/// recover_interrupted with its report.
void recover_and_report(const std::filesystem::path& recording);

}  // namespace palpate::app
