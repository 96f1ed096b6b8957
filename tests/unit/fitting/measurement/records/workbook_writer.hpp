// SPDX-License-Identifier: AGPL-3.0-or-later
// The least that a workbook is made of, to be bent by tests.
#pragma once

#include <minizip/zip.h>

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace palpate::measured {

/// An archive with these members, in the order of their names.
inline void write_archive(const std::filesystem::path& path,
                          const std::map<std::string, std::string>& members) {
  const zipFile archive = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, content] : members) {
    zipOpenNewFileInZip64(archive, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr,
                          Z_DEFLATED, 6, 0);
    zipWriteInFileInZip(archive, content.data(), static_cast<unsigned>(content.size()));
    zipCloseFileInZip(archive);
  }
  zipClose(archive, nullptr);
}

/// Members of a workbook whose sheets hold this XML inside `sheetData`.
inline std::map<std::string, std::string> workbook_members(
    const std::vector<std::pair<std::string, std::string>>& sheets) {
  std::map<std::string, std::string> members;
  std::string list, relations;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    list += "<sheet name=\"" + sheets[i].first + "\" sheetId=\"" + number + "\" r:id=\"rId" +
            number + "\"/>";
    relations +=
        "<Relationship Id=\"rId" + number + "\" Target=\"worksheets/sheet" + number + ".xml\"/>";
    members["xl/worksheets/sheet" + number + ".xml"] =
        "<worksheet><sheetData>" + sheets[i].second + "</sheetData></worksheet>";
  }
  members["xl/workbook.xml"] = "<workbook><sheets>" + list + "</sheets></workbook>";
  members["xl/_rels/workbook.xml.rels"] = "<Relationships>" + relations + "</Relationships>";
  return members;
}

/// A row of numbers, and of texts where a field is none.
inline std::string row_of(int number, const std::vector<std::string>& fields) {
  std::string text = "<row r=\"" + std::to_string(number) + "\">";
  char column = 'A';
  for (const std::string& field : fields) {
    const std::string place = column + std::to_string(number);
    const bool is_number = field.find_first_not_of("0123456789.-") == std::string::npos;
    if (is_number && !field.empty())
      text += "<c r=\"" + place + "\"><v>" + field + "</v></c>";
    else if (!field.empty())
      text += "<c r=\"" + place + "\" t=\"inlineStr\"><is><t>" + field + "</t></is></c>";
    ++column;
  }
  return text + "</row>";
}

}  // namespace palpate::measured
