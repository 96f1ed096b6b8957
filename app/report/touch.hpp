// SPDX-License-Identifier: AGPL-3.0-or-later
// What the page needs to be touched: the runtime for the browser, and the library and the skin that
// it loads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::report {

/// palpate.wasm; empty where this program was built without the WebAssembly toolchain.
std::string_view runtime_wasm();

/// Bytes of the largest deformation.pdef that a page takes along.
inline constexpr std::size_t kLargestSkin = 16'000'000;

/// The runtime and the flat library as columns of bytes, with a "skin" of null; null without a
/// runtime, or where no vertex has a response.
nlohmann::json touch_data(const Library& library);

/// The same with the "skin" of `deformation`, the bytes of deformation.pdef: the file and the skin
/// vertex of each point of the picture (SurfaceMap::node); null where it is empty; {"problem",
/// "bytes", "limit"} where the file is of another library or body, or too large.
/// @throws Error(Configuration) when it cannot be read.
nlohmann::json touch_data(const Body& body, const Library& library, std::string_view deformation,
                          const std::vector<std::int32_t>& points);

/// The same for a picture whose points are these vertices of the library.
nlohmann::json touch_data(const Library& library, std::string_view deformation,
                          const std::vector<std::int32_t>& vertices);

}  // namespace palpate::report
