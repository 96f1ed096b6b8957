// SPDX-License-Identifier: AGPL-3.0-or-later
// Decompression by zlib that allocates no more than its input can hold.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::mesher {

/// The most bytes that `packed` compressed bytes can stand for: deflate shrinks at most 1032 : 1
/// [Deutsch 1996, RFC 1951].
constexpr std::size_t most_inflated(std::size_t packed) {
  return 1032 * packed + 64;
}

/// The first `size` bytes of a stream of zlib, or of the members of a gzip file one after the
/// other.
/// @throws Error(Geometry) at `where` when the stream is damaged or too short for them.
std::string inflate_exactly(std::string_view packed, std::size_t size, const std::string& where);

}  // namespace palpate::mesher
