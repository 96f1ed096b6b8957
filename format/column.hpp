// SPDX-License-Identifier: Apache-2.0
// The members of a record as columns of a table on disk. One table per record (name, member, units,
// meaning, rule) writes, reads and checks it.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "format/checks.hpp"

namespace palpate {

template <class Record, class Field>
struct Column {
  const char* name;
  Field Record::*member;
  const char* units;
  const char* description;
  Rule rule;
  bool optional = false;  ///< a file may lack it: the member keeps its initial value
};

// A function because clang 14 cannot deduce the arguments of an aggregate.
template <class Record, class Field>
constexpr Column<Record, Field> column(const char* name, Field Record::*member, const char* units,
                                       const char* description, Rule rule, bool optional = false) {
  return {name, member, units, description, rule, optional};
}

/// What stands for a member on disk: flags and enumerations as 8-bit numbers.
template <class Field>
using Stored =
    std::conditional_t<std::is_enum_v<Field> || std::is_same_v<Field, bool>, std::uint8_t, Field>;

template <class Record, class Field>
void check_column(const Checks& checks, const std::string& group,
                  const std::vector<Stored<Field>>& values, const Column<Record, Field>& column) {
  const std::string dataset = group + "/" + column.name;
  if constexpr (std::is_same_v<Field, Vec3>) {
    checks.vectors(dataset, values, column.rule);
  } else {
    checks.numbers(dataset, values, column.rule);
  }
}

/// `first`: the row of the first record in the table.
template <class Record, class... Fields>
void check_columns(const Checks& checks, const std::string& group,
                   const std::vector<Record>& records,
                   const std::tuple<Column<Record, Fields>...>& columns, std::size_t first = 0) {
  const auto check_one = [&]<class Field>(const Column<Record, Field>& column) {
    const std::string dataset = group + "/" + column.name;
    for (std::size_t row = 0; row < records.size(); ++row) {
      const auto value = static_cast<Stored<Field>>(records[row].*column.member);
      if constexpr (std::is_same_v<Field, Vec3>) {
        checks.vector(dataset, first + row, value, column.rule);
      } else {
        checks.number(dataset, first + row, static_cast<double>(value), column.rule);
      }
    }
  };
  std::apply([&](const auto&... column) { (check_one(column), ...); }, columns);
}

}  // namespace palpate
