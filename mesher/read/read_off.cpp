// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_off.hpp"

#include <utility>

#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

/// Blanks in the place of comments, so that lines keep their numbers.
std::string without_comments(std::string_view bytes) {
  std::string text(bytes);
  bool in_comment = false;
  for (char& c : text) {
    in_comment = c != '\n' && (in_comment || c == '#');
    if (in_comment) c = ' ';
  }
  return text;
}

void check_kind(Scanner& scanner) {
  const std::string kind(scanner.word());
  // The letters before OFF say what follows the coordinates; 4 and n are other dimensions.
  const bool is_off = kind == "OFF" || kind == "COFF" || kind == "NOFF" || kind == "CNOFF" ||
                      kind == "STOFF" || kind == "STCOFF" || kind == "STNOFF" || kind == "STCNOFF";
  if (!is_off) scanner.refuse("the file does not begin with 'OFF'");
  if (scanner.peek() == "BINARY")
    scanner.refuse("a binary OFF file", "export the surface as text, or as STL or PLY");
}

}  // namespace

Soup read_off(std::string_view bytes, const std::string& file) {
  const std::string text_of_file = without_comments(bytes);
  Scanner scanner(text_of_file, file);
  check_kind(scanner);
  const std::size_t points = scanner.count("the number of vertices", 6);
  const std::size_t faces = scanner.count("the number of faces", 2);
  scanner.line();  // the number of edges, which nobody needs
  Soup soup;
  for (std::size_t v = 0; v < points; ++v) {
    Vec3 x{};
    for (double& coordinate : x) coordinate = scanner.real("a coordinate");
    soup.points.push_back(x);
    scanner.line();
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::vector<std::size_t> corners(scanner.count("the number of corners of a face", 2));
    for (std::size_t& corner : corners) {
      const std::int64_t index = scanner.integer("the index of a vertex");
      if (index < 0 || index >= static_cast<std::int64_t>(points))
        scanner.refuse(text("the index ", index, " of a face is none of the ", points,
                            " vertices, 0 to ", points - 1));
      corner = static_cast<std::size_t>(index);
    }
    soup.polygons.push_back(std::move(corners));
    scanner.line();
  }
  return soup;
}

}  // namespace palpate::mesher
