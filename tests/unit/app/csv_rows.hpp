// SPDX-License-Identifier: AGPL-3.0-or-later
// A table read as a spreadsheet would: every row with as many fields as the title.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::test {

using CsvRow = std::map<std::string, std::string>;

inline std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

/// The rows by the names of the title row.
inline std::vector<CsvRow> csv_rows(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto names = csv_fields(line);
  std::vector<CsvRow> rows;
  while (std::getline(lines, line)) {
    const auto fields = csv_fields(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), fields.size()); ++i)
      rows.back()[names[i]] = fields[i];
  }
  return rows;
}

}  // namespace palpate::test
