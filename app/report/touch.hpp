// SPDX-License-Identifier: AGPL-3.0-or-later
// What the page needs to be touched: the runtime for the browser and the library that it loads.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "format/library.hpp"

namespace palpate::report {

/// palpate.wasm; empty where this program was built without the WebAssembly toolchain.
std::string_view runtime_wasm();

/// The runtime and the flat library as columns of bytes; null without a runtime, or where no vertex
/// has a response.
nlohmann::json touch_data(const Library& library);

}  // namespace palpate::report
