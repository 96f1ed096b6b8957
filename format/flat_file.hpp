// SPDX-License-Identifier: Apache-2.0
// Named arrays in one little-endian file that is read without HDF5, also where it lies in memory.
// Normative page: format/schema/flat.md.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "format/vec3.hpp"

namespace palpate {

inline constexpr std::uint32_t kFlatVersion = 1;
/// These contain entries without which the others must not be used: earlier readers refuse them.
inline constexpr std::uint32_t kRelaxingFlatVersion = 2;
inline constexpr std::uint32_t kGrippingFlatVersion = 3;
inline constexpr std::uint32_t kLeaningFlatVersion = 4;
inline constexpr std::uint32_t kLatestFlatVersion = 5;

/// What an entry is made of; the numbers are those on disk.
enum class FlatType : std::uint32_t {
  UInt8 = 1,
  Int32 = 2,
  Int64 = 3,
  Float32 = 4,
  Float64 = 5,
  Text = 6,  ///< UTF-8; the length of each text in front of all of them
  Int16 = 7
};

namespace flat {

template <class T>
constexpr FlatType type_of() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return FlatType::UInt8;
  if constexpr (std::is_same_v<T, std::int16_t>) return FlatType::Int16;
  if constexpr (std::is_same_v<T, std::int32_t>) return FlatType::Int32;
  if constexpr (std::is_same_v<T, std::int64_t>) return FlatType::Int64;
  if constexpr (std::is_same_v<T, float>) return FlatType::Float32;
  if constexpr (std::is_same_v<T, double>) return FlatType::Float64;
}

/// A row of a table: a number, or an array of numbers.
template <class T>
struct Row {
  using Number = T;
  static constexpr std::uint32_t kColumns = 1;
};
template <class T, std::size_t N>
struct Row<std::array<T, N>> {
  using Number = T;
  static constexpr std::uint32_t kColumns = N;
};

inline constexpr std::size_t kAnyRows = std::numeric_limits<std::size_t>::max();
inline constexpr std::size_t kNameSize = 56;  ///< bytes, of the name of an entry

/// An entry of the table of contents, as it lies on disk.
struct Entry {
  std::array<char, kNameSize> name{};  ///< padded with zeros
  FlatType type = FlatType::UInt8;
  std::uint32_t columns = 1;
  std::uint64_t offset = 0;  ///< of its first byte in the file, a multiple of 64
  std::uint64_t rows = 0;
  std::uint64_t reserved[6] = {};
};
static_assert(sizeof(Entry) == 128);

}  // namespace flat

/// Do these bytes begin as such a file does?
bool begins_flat(std::string_view bytes) noexcept;

/// The same of a file; false where it cannot be read.
bool is_flat_file(const std::filesystem::path& file);

/// Its version; 0 where it ends before that.
std::uint32_t version_of_flat_file(const std::filesystem::path& file);

/// Collects the entries of a file.
class FlatWriter {
 public:
  explicit FlatWriter(std::uint32_t version = kFlatVersion) : version_(version) {}

  template <class T>
  void array(std::string_view name, const std::vector<T>& values) {
    using Row = flat::Row<T>;
    add(name, flat::type_of<typename Row::Number>(), Row::kColumns, values.size(),
        {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }
  void number(std::string_view name, double value) { array(name, std::vector<double>{value}); }
  void texts(std::string_view name, const std::vector<std::string>& values);
  void text(std::string_view name, const std::string& value) { texts(name, {value}); }

  /// The whole file, with its seal.
  std::string file() const;

 private:
  void add(std::string_view name, FlatType type, std::uint32_t columns, std::uint64_t rows,
           std::string_view bytes);

  std::uint32_t version_;
  std::vector<flat::Entry> entries_;  ///< offsets from the first byte behind the table
  std::string data_;
};

/// The entries of a file in memory, which must outlive the object.
class FlatReader {
 public:
  /// @throws Error(Configuration) where the bytes are no such file, are of a later version, damaged
  /// or cut off: it names `file` and says `remedy`.
  FlatReader(std::string_view bytes, std::filesystem::path file, std::string remedy);

  bool has(std::string_view name) const noexcept { return find(name) != nullptr; }

  /// @throws Error(Configuration) where the entry is missing, of another type, or has other rows.
  template <class T>
  std::vector<T> array(std::string_view name, std::size_t rows = flat::kAnyRows) const {
    using Row = flat::Row<T>;
    const std::string_view bytes =
        bytes_of(name, flat::type_of<typename Row::Number>(), Row::kColumns, sizeof(T), rows);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  double number(std::string_view name) const { return array<double>(name, 1).front(); }
  std::vector<std::string> texts(std::string_view name, std::size_t rows = flat::kAnyRows) const;
  std::string text(std::string_view name) const { return texts(name, 1).front(); }

  std::uint32_t version() const noexcept { return version_; }
  const std::filesystem::path& file() const noexcept { return file_; }
  const std::string& remedy() const noexcept { return remedy_; }
  [[noreturn]] void fail(std::string_view name, const std::string& problem) const;

 private:
  const flat::Entry* find(std::string_view name) const noexcept;
  const flat::Entry& entry(std::string_view name, FlatType type, std::size_t rows) const;
  std::string_view bytes_of(std::string_view name, FlatType type, std::uint32_t columns,
                            std::size_t row_size, std::size_t rows) const;
  void read_head();
  void read_table(std::uint32_t count);

  std::string_view bytes_;  ///< without the seal
  std::uint32_t version_ = kFlatVersion;
  std::filesystem::path file_;
  std::string remedy_;
  std::vector<flat::Entry> entries_;
};

}  // namespace palpate
