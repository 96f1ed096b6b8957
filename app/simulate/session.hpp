// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "app/case/case.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"

namespace palpate::app {

/// Play the script on a library through the public C interface, with a simulated device and hand,
/// and record every step. `library` is the content of `library_file`. The provenance of the
/// recording is left to the caller. @throws Error(Configuration) when the library cannot be loaded
/// or the script does not fit it.
Recording play_session(const std::filesystem::path& library_file, const Library& library,
                       const SimulateSection& script);

}  // namespace palpate::app
