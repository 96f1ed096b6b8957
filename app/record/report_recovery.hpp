// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/record/session_recorder.hpp"

namespace palpate::app {

/// On the standard output; each gap is a warning.
void report(const Recovered& recovered);
/// recover_interrupted with its report.
void recover_and_report(const std::filesystem::path& recording);

}  // namespace palpate::app
