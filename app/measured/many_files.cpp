// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/many_files.hpp"

#include <charconv>
#include <utility>

#include "app/case/reader.hpp"
#include "app/measured/file_pattern.hpp"
#include "app/measured/sidecar.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

int whole_number(const std::string& text, const std::string& where) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure == std::errc{} && end == text.data() + text.size()) return value;
  refuse(where, "'" + text + "' is not a whole number", "correct the name or the row of the file");
}

double length(const std::string& text, const std::string& where) {
  const ParsedQuantity parsed = parse_quantity(text, Dimension::Length);
  if (parsed.fault == QuantityFault::None) return parsed.value;
  refuse(where, "'" + text + "' is not a length with its unit", "write for example \"{x} mm\"");
}

bool varies(const PressFileSection& s) {
  return !s.vertex_from.empty() || !s.site_from.empty() || !s.cycle_from.empty() ||
         !s.contact_from.empty() || !s.tool_from.empty();
}

/// The section of one file.
PressFileSection filled(PressFileSection s, const std::string& file, const NamedValues& values) {
  const std::string where = s.where + " (" + file + ")";
  s.file = file;
  s.choice.sheet = filled_in(s.choice.sheet, values, where);
  s.choice.range = filled_in(s.choice.range, values, where);
  if (!s.vertex_from.empty()) {
    s.vertex = whole_number(filled_in(s.vertex_from, values, where), where);
    if (s.vertex < 0) refuse(where, "the vertex is negative", "count vertices from 0");
  }
  if (!s.cycle_from.empty()) s.cycle = whole_number(filled_in(s.cycle_from, values, where), where);
  if (!s.contact_from.empty()) s.contact = length(filled_in(s.contact_from, values, where), where);
  if (!s.tool_from.empty()) s.tool = filled_in(s.tool_from, values, where);
  if (!s.site_from.empty()) {
    if (s.site_from.size() != 3)
      refuse(where, "a point has three coordinates",
             "write for example [\"{x} mm\", \"{y} mm\", \"20 mm\"]");
    for (std::size_t i = 0; i < 3; ++i)
      s.site[i] = length(filled_in(s.site_from[i], values, where), where);
  }
  s.where = where;
  return s;
}

std::vector<PressFileSection> expanded(const PressFileSection& s, const fs::path& folder) {
  if (s.file.empty() == s.files.empty())
    refuse(s.where, s.file.empty() ? "it names no record" : "it names both a file and a pattern",
           "give `file`, or `files` with a pattern");
  if (!s.files.empty() && !s.list.empty())
    refuse(s.where, "both a pattern and a list say which files there are",
           "with a list give `file`, as \"{file}\"");
  if (varies(s) && s.files.empty() && s.list.empty())
    refuse(s.where, "something varies, and the section is of one file",
           "give `files` with a pattern, or a `list`");
  std::vector<PressFileSection> sections;
  if (!s.files.empty())
    for (const MatchedFile& match : matching_files(folder, s.files, s.where))
      sections.push_back(filled(s, match.file.string(), match.values));
  else if (!s.list.empty())
    for (const NamedValues& row : read_list(folder / s.list))
      sections.push_back(filled(s, filled_in(s.file, row, s.where), row));
  else
    sections.push_back(s);
  return sections;
}

}  // namespace

void expand_files(Sidecar& sidecar, const fs::path& folder, const SourceMap& sources) {
  std::vector<PressFileSection> presses;
  for (std::size_t i = 0; i < sidecar.presses.size(); ++i) {
    sidecar.presses[i].where = sources.where(fmt::format("press[{}].", i));
    for (PressFileSection& section : expanded(sidecar.presses[i], folder))
      presses.push_back(std::move(section));
  }
  sidecar.presses = std::move(presses);
  std::vector<RobotFileSection> logs;
  for (std::size_t i = 0; i < sidecar.robot_logs.size(); ++i) {
    RobotFileSection log = sidecar.robot_logs[i];
    const std::string where = sources.where(fmt::format("robot[{}].", i));
    if (log.file.empty() == log.files.empty())
      refuse(where, log.file.empty() ? "it names no log" : "it names both a file and a pattern",
             "give `file`, or `files` with a pattern");
    if (log.files.empty())
      logs.push_back(log);
    else
      for (const MatchedFile& match : matching_files(folder, log.files, where)) {
        log.file = match.file.string();
        logs.push_back(log);
      }
  }
  sidecar.robot_logs = std::move(logs);
}

}  // namespace palpate::app
