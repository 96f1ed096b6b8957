// SPDX-License-Identifier: Apache-2.0
// Numbers and texts as bytes, for journals and digests. Little-endian; a text or
// a list follows its length (uint32).
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "format/error.hpp"
#include "format/vec3.hpp"

namespace palpate {

static_assert(std::endian::native == std::endian::little, "a record is the memory as it is");

class ByteWriter {
 public:
  template <class Number>
  void put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
  void put(const Vec3& v) {
    for (const double x : v) put(x);
  }
  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes.append(text);
  }

  std::string bytes;
};

/// Reads the same back and believes nothing. @throws Error(Configuration): "<where>: <problem>;
/// <remedy>" where the bytes end too early.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& where, const char* problem,
             const char* remedy)
      : bytes_(bytes), where_(where), problem_(problem), remedy_(remedy) {}

  template <class Number>
  Number get() {
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  Vec3 vector() {
    Vec3 v{};
    for (double& x : v) x = get<double>();
    return v;
  }
  std::string text() {
    const auto length = get<std::uint32_t>();
    return std::string(take(length));
  }
  /// A length that could not fit into what is left is damage, not a reason to allocate.
  std::size_t count(std::size_t smallest_item) {
    const auto n = get<std::uint32_t>();
    if (n > bytes_.size() / smallest_item) fail();
    return n;
  }
  template <class Enum>
  Enum one_of(Enum last) {
    const auto value = get<std::uint8_t>();
    if (value > static_cast<std::uint8_t>(last)) fail();
    return static_cast<Enum>(value);
  }
  bool at_end() const { return bytes_.empty(); }
  void expect_end() const {
    if (!at_end()) fail();
  }

 private:
  std::string_view take(std::size_t n) {
    if (n > bytes_.size()) fail();
    const std::string_view head = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return head;
  }
  [[noreturn]] void fail() const {
    throw Error(ErrorKind::Configuration, where_, problem_, remedy_);
  }

  std::string_view bytes_;
  const std::string& where_;
  const char* problem_;
  const char* remedy_;
};

}  // namespace palpate
