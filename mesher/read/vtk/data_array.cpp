// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/data_array.hpp"

#include <algorithm>
#include <cstdint>

#include "format/base64.hpp"
#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/file/inflate.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

/// Bytes of a stream, which is base64 in pieces or raw.
class ByteStream {
 public:
  ByteStream(std::string_view text, bool is_base64, const std::string& where)
      : text_(text), is_base64_(is_base64), where_(where) {}

  /// The first bytes of what comes next, without moving.
  std::string peek(std::size_t size) const {
    const std::string_view piece = text_.substr(0, needed(size));
    if (!is_base64_) return std::string(piece);
    auto bytes = from_base64(piece);
    if (!bytes) refuse_geometry(where_, "a text that is not base64", kDamagedFile);
    if (bytes->size() < size) short_of(size);
    bytes->resize(size);
    return std::move(*bytes);
  }
  std::string take(std::size_t size) {
    std::string bytes = peek(size);
    text_.remove_prefix(needed(size));
    return bytes;
  }
  /// The most bytes that may follow.
  std::size_t left() const { return is_base64_ ? text_.size() / 4 * 3 : text_.size(); }

 private:
  std::size_t needed(std::size_t size) const {
    if (size > left()) short_of(size);
    return is_base64_ ? (size + 2) / 3 * 4 : size;
  }
  [[noreturn]] void short_of(std::size_t size) const {
    refuse_geometry(where_, text("an array of ", size, " bytes where at most ", left(), " follow"),
                    kDamagedFile);
  }

  std::string_view text_;
  bool is_base64_;
  const std::string& where_;
};

class Decoder {
 public:
  Decoder(ByteStream stream, const VtkEncoding& encoding, const std::string& where)
      : stream_(stream), encoding_(encoding), where_(where) {}

  std::string bytes(std::optional<std::size_t> expected) {
    return encoding_.is_compressed ? inflated(expected) : plain(expected);
  }

 private:
  std::uint64_t count_at(std::string_view header, std::size_t row) const {
    const auto field = header.substr(row * encoding_.header_bytes, encoding_.header_bytes);
    return encoding_.header_bytes == 8
               ? Scanner::decoded<std::uint64_t>(field, encoding_.is_swapped)
               : Scanner::decoded<std::uint32_t>(field, encoding_.is_swapped);
  }
  void check(std::uint64_t found, std::optional<std::size_t> expected) const {
    if (!expected || found == *expected) return;
    refuse_geometry(where_, text("an array of ", found, " bytes, ", *expected, " expected"),
                    kDamagedFile);
  }

  /// The number of bytes, then the bytes, in one piece of base64.
  std::string plain(std::optional<std::size_t> expected) {
    const std::uint64_t size = count_at(stream_.peek(encoding_.header_bytes), 0);
    check(size, expected);
    if (size > stream_.left()) {
      refuse_geometry(
          where_, text("an array of ", size, " bytes where at most ", stream_.left(), " follow"),
          kDamagedFile);
    }
    return stream_.take(encoding_.header_bytes + size).substr(encoding_.header_bytes);
  }

  /// The number of blocks, their size, that of the last one if it is smaller, the compressed size
  /// of each; then the blocks.
  std::string inflated(std::optional<std::size_t> expected) {
    const std::string start = stream_.peek(3 * encoding_.header_bytes);
    const std::uint64_t blocks = count_at(start, 0), size = count_at(start, 1);
    const std::uint64_t last = count_at(start, 2);
    if (blocks > stream_.left() / encoding_.header_bytes) {
      refuse_geometry(where_, text("an array of ", blocks, " blocks in ", stream_.left(), " bytes"),
                      kDamagedFile);
    }
    const std::string header = stream_.take((3 + blocks) * encoding_.header_bytes);
    std::uint64_t packed = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint64_t more = count_at(header, 3 + b);
      if (more > stream_.left() - packed) {
        refuse_geometry(where_, "compressed blocks larger than what follows", kDamagedFile);
      }
      packed += more;
    }
    const std::string data = stream_.take(packed);
    std::string bytes;
    std::size_t at = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint64_t piece = count_at(header, 3 + b);
      const bool is_short = b + 1 == blocks && last != 0;
      bytes +=
          inflate_exactly(std::string_view(data).substr(at, piece), is_short ? last : size, where_);
      at += piece;
    }
    check(bytes.size(), expected);
    return bytes;
  }

  ByteStream stream_;
  const VtkEncoding& encoding_;
  const std::string& where_;
};

template <class Number>
std::vector<double> converted(std::string_view bytes, bool is_swapped) {
  std::vector<double> numbers;
  numbers.reserve(bytes.size() / sizeof(Number));
  for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number))
    numbers.push_back(static_cast<double>(
        Scanner::decoded<Number>(bytes.substr(at, sizeof(Number)), is_swapped)));
  return numbers;
}

struct NumberType {
  const char* name;
  std::size_t size;
  std::vector<double> (*convert)(std::string_view, bool);
};
/// A string is a list of characters of type Int8.
constexpr NumberType kNumberTypes[] = {
    {"Int8", 1, converted<std::int8_t>},   {"UInt8", 1, converted<std::uint8_t>},
    {"Int16", 2, converted<std::int16_t>}, {"UInt16", 2, converted<std::uint16_t>},
    {"Int32", 4, converted<std::int32_t>}, {"UInt32", 4, converted<std::uint32_t>},
    {"Int64", 8, converted<std::int64_t>}, {"UInt64", 8, converted<std::uint64_t>},
    {"Float32", 4, converted<float>},      {"Float64", 8, converted<double>},
    {"String", 1, converted<std::int8_t>}};

std::vector<double> ascii_numbers(std::string_view words, std::optional<std::size_t> count,
                                  const std::string& where) {
  Scanner scanner(words, where);
  std::vector<double> numbers;
  while (!scanner.peek().empty() && (!count || numbers.size() <= *count)) {
    const auto value = real_of(scanner.word());
    if (!value) refuse_geometry(where, "a word that is no number in an array", kDamagedFile);
    numbers.push_back(*value);
  }
  if (count && numbers.size() != *count) {
    refuse_geometry(where,
                    text("an array of ", numbers.size() > *count ? "more than " : "",
                         std::min(numbers.size(), *count), " numbers, ", *count, " expected"),
                    kDamagedFile);
  }
  return numbers;
}

}  // namespace

std::vector<double> numbers_of(const VtkArrayText& array, const VtkEncoding& encoding,
                               std::optional<std::size_t> count, const std::string& where) {
  if (array.format == "ascii") return ascii_numbers(array.text, count, where);
  const auto type = std::find_if(std::begin(kNumberTypes), std::end(kNumberTypes),
                                 [&](const NumberType& t) { return t.name == array.type; });
  if (type == std::end(kNumberTypes)) {
    refuse_geometry(where, text("an array of type '", array.type, "'"), kDamagedFile);
  }
  const bool is_appended = array.format == "appended";
  if (!is_appended && array.format != "binary") {
    refuse_geometry(where, text("an array of format '", array.format, "'"), kDamagedFile);
  }
  if (is_appended && array.offset >= encoding.appended.size()) {
    refuse_geometry(where,
                    text("an array begins at byte ", array.offset, " of ", encoding.appended.size(),
                         " appended bytes"),
                    kDamagedFile);
  }
  const std::string_view stream = is_appended ? encoding.appended.substr(array.offset) : array.text;
  Decoder decoder({stream, !is_appended || encoding.appended_is_base64, where}, encoding, where);
  std::optional<std::size_t> size;
  if (count) size = *count * type->size;
  return type->convert(decoder.bytes(size), encoding.is_swapped);
}

}  // namespace palpate::mesher
