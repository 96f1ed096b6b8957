// SPDX-License-Identifier: Apache-2.0
// Records in memory <-> one dataset per member in an HDF5 file.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "format/checks.hpp"
#include "format/column.hpp"
#include "format/hdf5_file.hpp"

namespace palpate {

template <class Record, class... Fields>
void write_columns(hdf5::Writer& writer, const std::string& group,
                   const std::vector<Record>& records,
                   const std::tuple<Column<Record, Fields>...>& columns) {
  const auto write_one = [&]<class Field>(const Column<Record, Field>& column) {
    std::vector<Stored<Field>> values;
    values.reserve(records.size());
    for (const Record& record : records) {
      values.push_back(static_cast<Stored<Field>>(record.*column.member));
    }
    writer.dataset(group + "/" + column.name, values, {column.units, column.description});
  };
  std::apply([&](const auto&... column) { (write_one(column), ...); }, columns);
}

/// The datasets of a table of so many records, to be filled by append_columns().
template <class Record, class... Fields>
void begin_columns(hdf5::Writer& writer, const std::string& group, std::uint64_t records,
                   const std::tuple<Column<Record, Fields>...>& columns) {
  const auto begin_one = [&]<class Field>(const Column<Record, Field>& column) {
    writer.begin_dataset<Stored<Field>>(group + "/" + column.name, records,
                                        {column.units, column.description});
  };
  std::apply([&](const auto&... column) { (begin_one(column), ...); }, columns);
}

template <class Record, class... Fields>
void append_columns(hdf5::Writer& writer, const std::string& group,
                    const std::vector<Record>& records,
                    const std::tuple<Column<Record, Fields>...>& columns) {
  const auto append_one = [&]<class Field>(const Column<Record, Field>& column) {
    std::vector<Stored<Field>> values;
    values.reserve(records.size());
    for (const Record& record : records)
      values.push_back(static_cast<Stored<Field>>(record.*column.member));
    writer.append(group + "/" + column.name, values);
  };
  std::apply([&](const auto&... column) { (append_one(column), ...); }, columns);
}

/// Checks each column before it enters a record: an enumeration never holds an unknown value.
template <class Record, class... Fields>
std::vector<Record> read_columns(const hdf5::Reader& reader, const std::string& group,
                                 const std::tuple<Column<Record, Fields>...>& columns,
                                 std::size_t rows = hdf5::kAnyRows) {
  const Checks checks(reader);
  std::vector<Record> records;
  bool sized = false;
  const auto read_one = [&]<class Field>(const Column<Record, Field>& column) {
    if (column.optional && !reader.has(group + "/" + column.name)) return;
    const auto values = reader.dataset<Stored<Field>>(group + "/" + column.name, column.units,
                                                      sized ? records.size() : rows);
    check_column(checks, group, values, column);
    if (!sized) records.resize(values.size());
    sized = true;
    for (std::size_t row = 0; row < values.size(); ++row) {
      records[row].*column.member = static_cast<Field>(values[row]);
    }
  };
  std::apply([&](const auto&... column) { (read_one(column), ...); }, columns);
  return records;
}

/// The rows of a table whose columns are all as they should be, values apart.
template <class Record, class... Fields>
std::size_t rows_of_columns(const hdf5::Reader& reader, const std::string& group,
                            const std::tuple<Column<Record, Fields>...>& columns) {
  std::size_t rows = hdf5::kAnyRows;
  const auto look = [&]<class Field>(const Column<Record, Field>& column) {
    rows = reader.rows_of<Stored<Field>>(group + "/" + column.name, column.units, rows);
  };
  std::apply([&](const auto&... column) { (look(column), ...); }, columns);
  return rows;
}

/// Some rows of such a table, not yet checked. For columns that are not optional.
template <class Record, class... Fields>
std::vector<Record> read_rows(const hdf5::Reader& reader, const std::string& group,
                              const std::tuple<Column<Record, Fields>...>& columns,
                              std::size_t first, std::size_t count) {
  std::vector<Record> records(count);
  const auto read_one = [&]<class Field>(const Column<Record, Field>& column) {
    static_assert(!std::is_enum_v<Field>, "an enumeration is checked before it is one");
    const auto values = reader.part<Stored<Field>>(group + "/" + column.name, first, count);
    for (std::size_t row = 0; row < count; ++row)
      records[row].*column.member = static_cast<Field>(values[row]);
  };
  std::apply([&](const auto&... column) { (read_one(column), ...); }, columns);
  return records;
}

}  // namespace palpate
