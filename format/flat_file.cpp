// SPDX-License-Identifier: Apache-2.0
#include "format/flat_file.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <utility>

#include "format/error.hpp"
#include "format/seal.hpp"

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little,
              "a flat file is little-endian: this machine needs a reader that swaps bytes");

// As in PNG: a byte that is no text, both ends of lines and the end of a text file, so that a
// transfer as text is noticed at once.
constexpr std::string_view kMagic{"\x89PLP\r\n\x1a\n", 8};
constexpr std::size_t kAlignment = 64;

/// The beginning of the file.
struct Head {
  std::array<char, 8> magic{};
  std::uint32_t version = kFlatVersion;
  std::uint32_t entries = 0;
  std::uint64_t size = 0;  ///< of the file without its seal
  std::array<char, 40> reserved{};
};
static_assert(sizeof(Head) == kAlignment);

const std::size_t kSealSize = seal_of_digest(std::string(64, '0')).size();

std::size_t row_size_of(const flat::Entry& entry) {
  switch (entry.type) {
    case FlatType::UInt8:
      return entry.columns;
    case FlatType::Int16:
      return std::size_t{2} * entry.columns;
    case FlatType::Int32:
    case FlatType::Float32:
      return std::size_t{4} * entry.columns;
    case FlatType::Int64:
    case FlatType::Float64:
    case FlatType::Text:  // the lengths
      return std::size_t{8} * entry.columns;
  }
  return 0;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string name_of(const flat::Entry& entry) {
  return {entry.name.begin(), std::find(entry.name.begin(), entry.name.end(), '\0')};
}

}  // namespace

bool begins_flat(std::string_view bytes) noexcept {
  return bytes.substr(0, kMagic.size()) == kMagic;
}

bool is_flat_file(const std::filesystem::path& file) {
  std::array<char, kMagic.size()> first{};
  if (!std::filesystem::is_regular_file(file)) return false;
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  return begins_flat({first.data(), first.size()});
}

std::uint32_t version_of_flat_file(const std::filesystem::path& file) {
  std::array<char, offsetof(Head, version) + sizeof(Head::version)> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  std::uint32_t version = 0;
  std::memcpy(&version, first.data() + offsetof(Head, version), sizeof version);
  return version;
}

void FlatWriter::add(std::string_view name, FlatType type, std::uint32_t columns,
                     std::uint64_t rows, std::string_view bytes) {
  flat::Entry entry;
  if (name.size() >= entry.name.size())
    throw Error(ErrorKind::Internal, std::string(name), "is too long for a flat file",
                "shorten it");
  std::copy(name.begin(), name.end(), entry.name.begin());
  entry.type = type;
  entry.columns = columns;
  entry.offset = data_.size();
  entry.rows = rows;
  entries_.push_back(entry);
  data_.append(bytes);
  data_.append((kAlignment - data_.size() % kAlignment) % kAlignment, '\0');
}

void FlatWriter::texts(std::string_view name, const std::vector<std::string>& values) {
  std::string bytes;
  for (const std::string& value : values) append(bytes, std::uint64_t{value.size()});
  for (const std::string& value : values) bytes += value;
  add(name, FlatType::Text, 1, values.size(), bytes);
}

std::string FlatWriter::file() const {
  const std::size_t begin = sizeof(Head) + entries_.size() * sizeof(flat::Entry);
  Head head;
  std::copy(kMagic.begin(), kMagic.end(), head.magic.begin());
  head.version = version_;
  head.entries = static_cast<std::uint32_t>(entries_.size());
  head.size = begin + data_.size();
  std::string bytes;
  append(bytes, head);
  for (flat::Entry entry : entries_) {
    entry.offset += begin;
    append(bytes, entry);
  }
  bytes += data_;
  return bytes + seal_of(bytes);
}

FlatReader::FlatReader(std::string_view bytes, std::filesystem::path file, std::string remedy)
    : bytes_(bytes), file_(std::move(file)), remedy_(std::move(remedy)) {
  read_head();
}

void FlatReader::read_head() {
  Head head;
  if (!begins_flat(bytes_) || bytes_.size() < sizeof head)
    refuse(file_.string(), "is not a flat library (.plib)", remedy_);
  std::memcpy(&head, bytes_.data(), sizeof head);
  version_ = head.version;
  if (head.version > kLatestFlatVersion)
    refuse(file_.string(),
           "is of version " + std::to_string(head.version) +
               " of the flat format; this program knows version " +
               std::to_string(kLatestFlatVersion),
           "update palpate, or export the library with this version");
  if (bytes_.size() != head.size + kSealSize)
    refuse(file_.string(),
           "has " + std::to_string(bytes_.size()) + " bytes where its head says " +
               std::to_string(head.size + kSealSize),
           remedy_);
  const std::string_view seal = bytes_.substr(head.size);
  bytes_ = bytes_.substr(0, head.size);
  if (seal != seal_of(bytes_))
    refuse(file_.string(), "is damaged: its content does not match its SHA-256", remedy_);
  read_table(head.entries);
}

void FlatReader::read_table(std::uint32_t count) {
  if (count > (bytes_.size() - sizeof(Head)) / sizeof(flat::Entry))
    refuse(file_.string(), "has more entries than bytes", remedy_);
  entries_.resize(count);
  std::memcpy(entries_.data(), bytes_.data() + sizeof(Head), count * sizeof(flat::Entry));
  for (const flat::Entry& entry : entries_) {
    const std::size_t row = row_size_of(entry);
    const bool inside = entry.offset % kAlignment == 0 && entry.offset <= bytes_.size() &&
                        row > 0 && entry.rows <= (bytes_.size() - entry.offset) / row;
    if (!inside) fail(name_of(entry), "is of unknown type or lies outside of the file");
  }
}

const flat::Entry* FlatReader::find(std::string_view name) const noexcept {
  for (const flat::Entry& entry : entries_) {
    const auto end = std::find(entry.name.begin(), entry.name.end(), '\0');
    if (std::equal(entry.name.begin(), end, name.begin(), name.end())) return &entry;
  }
  return nullptr;
}

const flat::Entry& FlatReader::entry(std::string_view name, FlatType type, std::size_t rows) const {
  const flat::Entry* found = find(name);
  if (found == nullptr) fail(name, "is missing");
  if (found->type != type) fail(name, "is of another type");
  if (rows != flat::kAnyRows && found->rows != rows)
    fail(name,
         "has " + std::to_string(found->rows) + " rows, " + std::to_string(rows) + " expected");
  return *found;
}

std::string_view FlatReader::bytes_of(std::string_view name, FlatType type, std::uint32_t columns,
                                      std::size_t row_size, std::size_t rows) const {
  const flat::Entry& found = entry(name, type, rows);
  if (found.columns != columns)
    fail(name, "has " + std::to_string(found.columns) + " columns, " + std::to_string(columns) +
                   " expected");
  return bytes_.substr(found.offset, found.rows * row_size);
}

std::vector<std::string> FlatReader::texts(std::string_view name, std::size_t rows) const {
  const flat::Entry& found = entry(name, FlatType::Text, rows);
  std::vector<std::uint64_t> lengths(found.rows);
  std::string_view rest = bytes_.substr(found.offset);
  const std::size_t head = lengths.size() * sizeof(std::uint64_t);
  if (head > 0) std::memcpy(lengths.data(), rest.data(), head);
  rest = rest.substr(head);
  std::vector<std::string> values;
  for (const std::uint64_t length : lengths) {
    if (length > rest.size()) fail(name, "leads beyond the end of the file");
    values.emplace_back(rest.substr(0, length));
    rest = rest.substr(length);
  }
  return values;
}

void FlatReader::fail(std::string_view name, const std::string& problem) const {
  refuse(file_.string() + ":" + std::string(name), problem, remedy_);
}

}  // namespace palpate
