// SPDX-License-Identifier: AGPL-3.0-or-later
// XML files, with the line of every fault.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "mesher/read/file/file.hpp"

namespace palpate::mesher {

/// The text without blanks and ends of lines around it.
std::string_view trimmed_text(std::string_view text);

class XmlFile {
 public:
  /// @throws Error(Geometry) with the line where the text is no XML.
  XmlFile(std::string_view xml, std::string file);

  const pugi::xml_document& document() const { return document_; }
  const std::string& file() const { return file_; }
  /// "file:line" of an element.
  std::string where(pugi::xml_node node) const;
  [[noreturn]] void refuse(pugi::xml_node node, const std::string& problem,
                           const std::string& remedy = kDamagedFile) const;

 private:
  std::string at(std::ptrdiff_t offset) const;

  std::string text_;
  std::string file_;
  pugi::xml_document document_;
};

}  // namespace palpate::mesher
