// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_obj.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "format/error.hpp"

namespace palpate::mesher {
namespace {

constexpr auto kOutOfRange = std::numeric_limits<std::size_t>::max();

/// The number at the start of a word; "nan" and "inf" count as numbers.
template <typename Number>
std::optional<Number> leading_number(const std::string& word) {
  Number value{};
  const char* begin = word.data();
  if (*begin == '+') ++begin;
  const auto [end, failure] = std::from_chars(begin, word.data() + word.size(), value);
  if (failure != std::errc{}) return std::nullopt;
  return value;
}

std::optional<Vec3> parse_vertex(std::istringstream& words) {
  Vec3 x{};
  for (double& coordinate : x) {
    std::string word;
    if (!(words >> word)) return std::nullopt;
    const auto value = leading_number<double>(word);
    if (!value) return std::nullopt;
    coordinate = *value;
  }
  return x;
}

/// "7", "7/1", "7//3" and "7/1/3" all name vertex 7; -1 is the latest vertex so far.
std::optional<std::vector<std::size_t>> parse_face(std::istringstream& words,
                                                   std::size_t vertices_so_far) {
  std::vector<std::size_t> corners;
  for (std::string word; words >> word && word.front() != '#';) {
    const auto index = leading_number<std::int64_t>(word);
    if (!index) return std::nullopt;
    const auto count = static_cast<std::int64_t>(vertices_so_far);
    const std::int64_t v = *index > 0 ? *index - 1 : count + *index;
    corners.push_back(*index == 0 || v < 0 ? kOutOfRange : static_cast<std::size_t>(v));
  }
  return corners;
}

/// The names that `o`, `g` and `usemtl` give to the faces after them.
class CurrentNames {
 public:
  /// Other keywords change nothing.
  void update(const std::string& keyword, std::istringstream& words) {
    Names* const target = keyword == "o"        ? &object_
                          : keyword == "g"      ? &groups_
                          : keyword == "usemtl" ? &material_
                                                : nullptr;
    if (target == nullptr) return;
    target->clear();
    for (std::string word; words >> word && word.front() != '#';) target->push_back(word);
  }

  /// Index into `known`, to which new names are appended.
  std::size_t index_in(std::vector<Names>& known) const {
    Names all = object_;
    all.insert(all.end(), groups_.begin(), groups_.end());
    all.insert(all.end(), material_.begin(), material_.end());
    const auto found = std::find(known.begin(), known.end(), all);
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (found == known.end()) known.push_back(all);
    return index;
  }

 private:
  Names object_, groups_, material_;
};

}  // namespace

Soup read_obj(const std::filesystem::path& path) {
  std::ifstream in(path);
  Soup soup;
  CurrentNames names;
  std::size_t number = 0;
  const auto refuse = [&](const std::string& problem) {
    throw Error(ErrorKind::Geometry, path.string(), text("line ", number, ": ", problem),
                "the file is damaged: export the surface again");
  };
  for (std::string line; std::getline(in, line);) {
    ++number;
    while (!line.empty() && line.back() == '\\') {  // continued on the next line
      line.pop_back();
      std::string more;
      if (!std::getline(in, more)) break;
      ++number;
      line += ' ' + more;
    }
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "v") {
      const auto vertex = parse_vertex(words);
      if (!vertex) refuse("a vertex without three numbers");
      soup.points.push_back(*vertex);
    } else if (keyword == "f") {
      auto face = parse_face(words, soup.points.size());
      if (!face) refuse("a face with an index that is no number");
      soup.polygons.push_back(std::move(*face));
      soup.names.push_back(names.index_in(soup.known_names));
    } else {
      names.update(keyword, words);
    }
  }
  return soup;
}

}  // namespace palpate::mesher
