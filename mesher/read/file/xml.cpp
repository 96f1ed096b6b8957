// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/xml.hpp"

#include <algorithm>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

std::string_view trimmed_text(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

XmlFile::XmlFile(std::string_view xml, std::string file) : text_(xml), file_(std::move(file)) {
  const pugi::xml_parse_result result =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    refuse_geometry(at(result.offset), text("the XML is damaged: ", result.description()),
                    kDamagedFile);
  }
}

std::string XmlFile::where(pugi::xml_node node) const {
  return node ? at(node.offset_debug()) : file_;
}

std::string XmlFile::at(std::ptrdiff_t offset) const {
  const auto end = text_.begin() +
                   std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
  return text(file_, ":", 1 + std::count(text_.begin(), end, '\n'));
}

void XmlFile::refuse(pugi::xml_node node, const std::string& problem,
                     const std::string& remedy) const {
  refuse_geometry(where(node), problem, remedy);
}

}  // namespace palpate::mesher
