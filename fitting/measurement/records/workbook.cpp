// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/workbook.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "format/error.hpp"
#include "format/text.hpp"

#ifdef PALPATE_HAS_WORKBOOKS
#include <pugixml.hpp>

#include "fitting/measurement/records/zip_archive.hpp"
#endif

namespace palpate::measured {

bool is_zip(const std::filesystem::path& file) {
  constexpr std::string_view mark = "PK\x03\x04";
  std::array<char, mark.size()> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  return std::string_view(head.data(), head.size()) == mark;
}

#ifndef PALPATE_HAS_WORKBOOKS

SheetText read_sheet(const std::filesystem::path& file, const SheetPart&) {
  refuse(file.string(), "this palpate was built without minizip, with which it reads workbooks",
         "install libminizip-dev and build again, or save the sheet as CSV");
}

#else

namespace {

/// The largest sheet there is.
constexpr std::uint32_t kRows = 1048576, kColumns = 16384;

struct Cell {
  std::uint32_t row = 0, column = 0;  ///< from 1; 0: none
};

/// "BC12", "BC" (row 0) or "12" (column 0).
bool parse_cell(std::string_view text, Cell& cell) {
  cell = {};
  while (!text.empty() && text.front() >= 'A' && text.front() <= 'Z' && cell.column <= kColumns) {
    cell.column = 26 * cell.column + static_cast<std::uint32_t>(text.front() - 'A' + 1);
    text.remove_prefix(1);
  }
  if (cell.column > kColumns) return false;
  if (text.empty()) return cell.column > 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), cell.row);
  return failure == std::errc{} && end == text.data() + text.size() && cell.row >= 1 &&
         cell.row <= kRows;
}

struct Range {
  Cell first{1, 1}, last{kRows, kColumns};
  bool has(const Cell& c) const {
    return c.row >= first.row && c.row <= last.row && c.column >= first.column &&
           c.column <= last.column;
  }
};

Range range_of(const std::string& text, const std::string& where) {
  Range range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  Cell first, last;
  const bool is_range = colon != std::string::npos && parse_cell(text.substr(0, colon), first) &&
                        parse_cell(text.substr(colon + 1), last) && first.column > 0 &&
                        last.column >= first.column && (first.row == 0) == (last.row == 0) &&
                        last.row >= first.row;
  if (!is_range)
    refuse(where, "'" + text + "' is not a range of cells",
           "write for example \"B4:E900\", header included, or \"B:E\"");
  range.first = {std::max(first.row, 1U), first.column};
  range.last = {last.row == 0 ? kRows : last.row, last.column};
  return range;
}

/// Names without the prefix of their namespace, which writers choose as they like.
std::string_view local(const char* name) {
  const std::string_view text(name);
  return text.substr(text.rfind(':') + 1);
}

std::vector<pugi::xml_node> children(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node& child : node.children())
    if (local(child.name()) == name) found.push_back(child);
  return found;
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  const auto found = children(node, name);
  return found.empty() ? pugi::xml_node{} : found.front();
}

std::string text_of(const pugi::xml_node& node) {
  std::string text;
  if (const pugi::xml_node plain = child(node, "t")) text = plain.text().get();
  for (const pugi::xml_node& run : children(node, "r")) text += child(run, "t").text().get();
  return text;
}

/// What a number is by the format of its cell.
enum class NumberKind { Plain, Time, Percent };

NumberKind kind_of_code(std::string_view code) {
  bool quoted = false, bracketed = false;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '\\' || c == '_' || c == '*') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == ']')) {
      // "[h]:mm" counts hours; "[Red]" is a colour.
      const std::string_view rest = code.substr(i + 1);
      bracketed =
          c == '[' && !rest.starts_with("h") && !rest.starts_with("m") && !rest.starts_with("s");
    } else if (!quoted && !bracketed) {
      if (c == '%') return NumberKind::Percent;
      if (std::string_view("yYdDhHsS").find(c) != std::string_view::npos) return NumberKind::Time;
    }
  }
  return NumberKind::Plain;
}

NumberKind kind_of_builtin(int id) {
  if (id == 9 || id == 10) return NumberKind::Percent;
  const bool is_time = (id >= 14 && id <= 22) || (id >= 27 && id <= 36) || (id >= 45 && id <= 47) ||
                       (id >= 50 && id <= 58);
  return is_time ? NumberKind::Time : NumberKind::Plain;
}

class Workbook {
 public:
  explicit Workbook(const std::filesystem::path& file) : file_(file), archive_(file) {
    const auto book = archive_.member("xl/workbook.xml");
    if (!book)
      refuse(file.string(), "it is an archive, and no workbook of Excel",
             "save it as .xlsx or as CSV");
    read_names(parse(*book, "xl/workbook.xml"));
    read_strings();
    read_formats();
  }

  SheetText read(const SheetPart& part) const {
    if (!part.sheet.empty()) {
      const auto found = std::find_if(sheets_.begin(), sheets_.end(),
                                      [&](const auto& s) { return s.name == part.sheet; });
      if (found == sheets_.end())
        refuse(file_.string(), "it has no sheet '" + part.sheet + "'",
               "its sheets are " + names(sheets_));
      return text_of_sheet(*found, part.range);
    }
    std::vector<Sheet> used;
    for (const Sheet& sheet : sheets_)
      if (!cells_of(sheet, {}).empty()) used.push_back(sheet);
    if (used.empty()) refuse(file_.string(), "no sheet has cells", "copy or save it again");
    if (used.size() > 1)
      refuse(file_.string(), "it has several sheets", "choose one with `sheet`: " + names(used));
    return text_of_sheet(used.front(), part.range);
  }

 private:
  struct Sheet {
    std::string name, member;
  };
  using Rows = std::map<std::uint32_t, std::map<std::uint32_t, std::string> >;

  static std::string names(const std::vector<Sheet>& sheets) {
    std::string text;
    for (const Sheet& sheet : sheets) text += (text.empty() ? "'" : ", '") + sheet.name + "'";
    return text;
  }

  pugi::xml_document parse(const std::string& content, const std::string& member) const {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(
        content.data(), content.size(), pugi::parse_default | pugi::parse_ws_pcdata_single);
    if (!result)
      refuse(file_.string() + ", " + member, result.description(), "save the workbook again");
    return document;
  }

  void read_names(const pugi::xml_document& book) {
    std::map<std::string, std::string> targets;
    constexpr const char* kRelations = "xl/_rels/workbook.xml.rels";
    const pugi::xml_document relations =
        parse(archive_.member(kRelations).value_or(""), kRelations);
    for (const pugi::xml_node& relation : children(relations.document_element(), "Relationship"))
      targets[relation.attribute("Id").value()] = relation.attribute("Target").value();
    for (const pugi::xml_node& sheet :
         children(child(book.document_element(), "sheets"), "sheet")) {
      std::string target;
      for (const pugi::xml_attribute& attribute : sheet.attributes())
        if (local(attribute.name()) == "id") target = targets[attribute.value()];
      const bool absolute = target.starts_with('/');
      sheets_.push_back(
          {sheet.attribute("name").value(), absolute ? target.substr(1) : "xl/" + target});
    }
  }

  void read_strings() {
    constexpr const char* kStrings = "xl/sharedStrings.xml";
    const auto content = archive_.member(kStrings);
    if (!content) return;
    const pugi::xml_document document = parse(*content, kStrings);
    for (const pugi::xml_node& entry : children(document.document_element(), "si"))
      strings_.push_back(text_of(entry));
  }

  void read_formats() {
    constexpr const char* kStyles = "xl/styles.xml";
    const auto content = archive_.member(kStyles);
    if (!content) return;
    const pugi::xml_document document = parse(*content, kStyles);
    std::map<int, NumberKind> own;
    for (const pugi::xml_node& format :
         children(child(document.document_element(), "numFmts"), "numFmt"))
      own[format.attribute("numFmtId").as_int()] =
          kind_of_code(format.attribute("formatCode").value());
    for (const pugi::xml_node& style :
         children(child(document.document_element(), "cellXfs"), "xf")) {
      const int id = style.attribute("numFmtId").as_int();
      formats_.push_back(own.contains(id) ? own.at(id) : kind_of_builtin(id));
    }
  }

  std::string string_at(const std::string& index) const {
    std::size_t i = 0;
    const auto [end, failure] = std::from_chars(index.data(), index.data() + index.size(), i);
    const bool is_index = failure == std::errc{} && end == index.data() + index.size();
    return is_index && i < strings_.size() ? strings_[i] : "a text that is missing";
  }

  std::string value_of(const pugi::xml_node& cell) const {
    const std::string kind = cell.attribute("t").value();
    std::string value = child(cell, "v").text().get();
    if (kind == "s") return string_at(value);
    if (kind == "inlineStr") return text_of(child(cell, "is"));
    if (kind == "b") return value == "1" ? "TRUE" : "FALSE";
    if (kind == "str" || kind == "e" || kind == "d") return value;
    if (value.empty()) return child(cell, "f") ? "a formula without a value" : "";
    const auto style = static_cast<std::size_t>(cell.attribute("s").as_uint());
    const NumberKind format = style < formats_.size() ? formats_[style] : NumberKind::Plain;
    if (format == NumberKind::Time) return value + " as a date or time";
    if (format == NumberKind::Percent) return value + " in percent format";
    return value;
  }

  /// Cells that are not empty. Rows and cells without a reference follow the one before.
  Rows cells_of(const Sheet& sheet, const Range& range) const {
    const auto content = archive_.member(sheet.member);
    if (!content) return {};
    const pugi::xml_document document = parse(*content, sheet.member);
    Rows rows;
    Cell at;
    for (const pugi::xml_node& row :
         children(child(document.document_element(), "sheetData"), "row")) {
      const std::uint32_t given = row.attribute("r").as_uint();
      at = {given > 0 ? given : at.row + 1, 0};
      for (const pugi::xml_node& cell : children(row, "c")) {
        Cell place;
        const bool has_place = parse_cell(cell.attribute("r").value(), place) && place.row > 0;
        at.column = has_place && place.column > 0 ? place.column : at.column + 1;
        if (at.row > kRows || at.column > kColumns || !range.has(at)) continue;
        std::string value = value_of(cell);
        if (!trimmed(value).empty()) rows[at.row][at.column] = std::move(value);
      }
    }
    return rows;
  }

  SheetText text_of_sheet(const Sheet& sheet, const std::string& range_text) const {
    const std::string where = file_.string() + ", sheet '" + sheet.name + "'";
    const Rows rows = cells_of(sheet, range_of(range_text, where));
    if (rows.empty())
      refuse(where,
             range_text.empty() ? "it has no cells" : "no cell of " + range_text + " is filled",
             "choose another sheet or range");
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    for (const auto& [number, cells] : rows) first = std::min(first, cells.begin()->first);
    SheetText text{sheet.name, ""};
    std::uint32_t line = 1;
    for (const auto& [number, cells] : rows) {
      text.text.append(number - line, '\n');
      line = number;
      std::uint32_t column = first;
      for (const auto& [at, value] : cells) {
        text.text.append(at - column, '\t');
        column = at;
        for (const char c : value)
          text.text += c == '\t' || c == '\n' || c == '\r' || c == '"' ? ' ' : c;
      }
    }
    return text;
  }

  std::filesystem::path file_;
  ZipArchive archive_;
  std::vector<Sheet> sheets_;
  std::vector<std::string> strings_;
  std::vector<NumberKind> formats_;
};

}  // namespace

SheetText read_sheet(const std::filesystem::path& file, const SheetPart& part) {
  return Workbook(file).read(part);
}

#endif

}  // namespace palpate::measured
