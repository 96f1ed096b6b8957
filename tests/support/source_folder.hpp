// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

namespace palpate::test {

/// The root of the sources. A function, so that only one file is compiled anew in another checkout.
std::filesystem::path source_folder();

}  // namespace palpate::test
