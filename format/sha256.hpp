// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

std::string sha256(std::string_view bytes);  ///< 64 lower-case hexadecimal digits [FIPS 180-4]
std::string sha256_of_file(const std::filesystem::path& path);  ///< @throws Error when unreadable

}  // namespace palpate
