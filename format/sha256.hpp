// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace palpate {

std::string sha256(std::string_view bytes);  ///< 64 lower-case hexadecimal digits [FIPS 180-4]
/// Digest of the file, or of its first bytes. @throws Error when unreadable
std::string sha256_of_file(const std::filesystem::path& path,
                           std::uint64_t first_bytes = std::numeric_limits<std::uint64_t>::max());

}  // namespace palpate
