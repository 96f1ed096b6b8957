// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/report.hpp"

#include <string_view>

#include "app/markup.hpp"
#include "app/report/embed.hpp"
#include "app/report/page.hpp"
#include "app/report/page_data.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate {

std::string report::page_text(const nlohmann::json& data) {
  std::string html;
  html += page_before_title();
  html += app::escape_markup(data["title"].get<std::string>());
  html += page_before_data();
  html += script_json(data);
  html += page_after_data();
  return html;
}

void report::write_page(const nlohmann::json& data, const std::filesystem::path& path) {
  write_file_crash_safely(path, page_text(data));
}

void write_report(const ReportInput& input, const std::filesystem::path& path) {
  report::write_page(report::page_data(input), path);
}

}  // namespace palpate
