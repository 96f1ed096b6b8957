// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/report.hpp"

#include <string_view>

#include "app/markup.hpp"
#include "app/report/embed.hpp"
#include "app/report/page.hpp"
#include "app/report/page_data.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate {

namespace {

std::string render(const nlohmann::json& data) {
  std::string html;
  html += report::page_before_title();
  html += app::escape_markup(data["title"].get<std::string>());
  html += report::page_before_data();
  html += report::script_json(data);
  html += report::page_after_data();
  return html;
}

}  // namespace

void report::write_page(const nlohmann::json& data, const std::filesystem::path& path) {
  write_file_crash_safely(path, render(data));
}

void write_report(const ReportInput& input, const std::filesystem::path& path) {
  report::write_page(report::page_data(input), path);
}

}  // namespace palpate
