// SPDX-License-Identifier: Apache-2.0
#include "format/sha256.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "format/error.hpp"
#include "format/regular_file.hpp"

namespace palpate {
namespace {

using Word = std::uint32_t;
constexpr std::size_t kBlockBytes = 64;

// First 32 bits of the fractional parts of the cube roots of the first 64 primes [FIPS
// 180-4, 4.2.2].
constexpr std::array<Word, 64> kRoundConstants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

Word word_at(const unsigned char* bytes) {
  return Word{bytes[0]} << 24 | Word{bytes[1]} << 16 | Word{bytes[2]} << 8 | Word{bytes[3]};
}

/// The message schedule W_t [FIPS 180-4, 6.2.2 step 1].
std::array<Word, 64> schedule_of(const unsigned char* block) {
  std::array<Word, 64> W{};
  for (std::size_t t = 0; t < 16; ++t) W[t] = word_at(block + 4 * t);
  for (std::size_t t = 16; t < 64; ++t) {
    const Word s0 = std::rotr(W[t - 15], 7) ^ std::rotr(W[t - 15], 18) ^ (W[t - 15] >> 3);
    const Word s1 = std::rotr(W[t - 2], 17) ^ std::rotr(W[t - 2], 19) ^ (W[t - 2] >> 10);
    W[t] = s1 + W[t - 7] + s0 + W[t - 16];
  }
  return W;
}

class Hasher {
 public:
  void add(std::string_view bytes) {
    length_ += bytes.size();
    while (!bytes.empty()) {
      const std::size_t taken = std::min(bytes.size(), kBlockBytes - used_);
      std::memcpy(block_.data() + used_, bytes.data(), taken);
      bytes.remove_prefix(taken);
      used_ += taken;
      if (used_ == kBlockBytes) compress();
    }
  }

  /// Padding: a 1 bit, zeros, and the length in bits as 64-bit big-endian [FIPS 180-4, 5.1.1].
  std::string finish() {
    const std::uint64_t bits = length_ * 8;
    add(std::string_view("\x80", 1));
    while (used_ != kBlockBytes - 8) add(std::string_view("\0", 1));
    std::array<char, 8> tail{};
    for (std::size_t i = 0; i < 8; ++i) tail[i] = static_cast<char>(bits >> (56 - 8 * i));
    add(std::string_view(tail.data(), tail.size()));
    return hexadecimal();
  }

 private:
  void compress() {
    const std::array<Word, 64> W = schedule_of(block_.data());
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t t = 0; t < 64; ++t) {
      const Word S1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
      const Word T1 = h + S1 + ((e & f) ^ (~e & g)) + kRoundConstants[t] + W[t];
      const Word S0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
      const Word T2 = S0 + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + T1, d = c, c = b, b = a, a = T1 + T2;
    }
    const std::array<Word, 8> round{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) state_[i] += round[i];
    used_ = 0;
  }

  std::string hexadecimal() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const Word word : state_) {
      for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[(word >> shift) & 0xfU];
    }
    return text;
  }

  // First 32 bits of the fractional parts of the square roots of the first 8 primes [5.3.3].
  std::array<Word, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                             0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, kBlockBytes> block_{};
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Hasher hasher;
  hasher.add(bytes);
  return hasher.finish();
}

std::string sha256_of_file(const std::filesystem::path& path, std::uint64_t first_bytes) {
  const auto fail = [&path](int error_number) {
    throw Error(ErrorKind::Configuration, path.string(),
                "cannot be read (" + std::generic_category().message(error_number) + ")",
                "check the path and the permissions");
  };
  require_regular_file(path, "name a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(errno);
  Hasher hasher;
  std::vector<char> buffer(std::size_t{1} << 20);
  while (first_bytes > 0) {
    const std::uint64_t wanted = std::min<std::uint64_t>(buffer.size(), first_bytes);
    file.read(buffer.data(), static_cast<std::streamsize>(wanted));
    const auto found = static_cast<std::uint64_t>(file.gcount());
    hasher.add(std::string_view(buffer.data(), found));
    first_bytes -= found;
    if (found < wanted) break;
  }
  if (file.bad()) fail(EIO);
  return hasher.finish();
}

}  // namespace palpate
