// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_stl.hpp"

#include <algorithm>

#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

/// "solid", "facet normal", "outer loop", "vertex", "endloop", "endfacet", "endsolid".
class StlReader {
 public:
  StlReader(std::string_view bytes, const std::string& file) : scanner_(bytes, file) {}

  Soup read() {
    while (const auto line = scanner_.line()) {
      Fields fields(*line, scanner_);
      const std::string keyword = lower(std::string(fields.next()));
      if (keyword == "solid") {
        name_solid(line->substr(5));
      } else if (keyword == "vertex") {
        vertex(fields);
      } else if (keyword == "endloop") {
        end_loop();
      } else if (!keyword.empty() && !keyword.starts_with("end") && keyword != "facet" &&
                 keyword != "outer" && keyword != "color") {
        scanner_.refuse("a line that is none of an STL file");
      }
    }
    if (!loop_.empty()) scanner_.refuse("the file ends inside a face");
    return std::move(soup_);
  }

 private:
  void name_solid(std::string_view rest) {
    const std::size_t first = std::min(rest.find_first_not_of(" \t"), rest.size());
    Names names;
    if (first < rest.size()) names.emplace_back(rest.substr(first));
    const auto known = std::find(soup_.known_names.begin(), soup_.known_names.end(), names);
    name_ = static_cast<std::size_t>(known - soup_.known_names.begin());
    if (known == soup_.known_names.end()) soup_.known_names.push_back(names);
  }

  void vertex(Fields& fields) {
    Vec3 x{};
    for (double& component : x) component = fields.real("a coordinate");
    loop_.push_back(soup_.points.size());
    soup_.points.push_back(x);
  }

  void end_loop() {
    if (loop_.size() < 3) scanner_.refuse("a face with fewer than three corners");
    if (soup_.known_names.empty()) name_solid({});
    soup_.polygons.push_back(loop_);
    soup_.names.push_back(name_);
    loop_.clear();
  }

  Scanner scanner_;
  Soup soup_;
  std::vector<std::size_t> loop_;
  std::size_t name_ = 0;
};

}  // namespace

bool is_text_stl(std::string_view bytes) {
  constexpr std::size_t head = 1000;
  Scanner scanner(bytes.substr(0, head), "");
  const std::string first = lower(std::string(scanner.word()));
  return first == "solid" && bytes.substr(0, head).find('\0') == std::string_view::npos &&
         lower(std::string(bytes.substr(0, head))).find("facet") != std::string::npos;
}

Soup read_text_stl(std::string_view bytes, const std::string& file) {
  return StlReader(bytes, file).read();
}

}  // namespace palpate::mesher
