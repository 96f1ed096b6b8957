// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "app/case/nearest.hpp"
#include "app/case/range_text.hpp"
#include "format/error.hpp"
#include "format/flat_file.hpp"

namespace palpate::app {
namespace {

/// The value as written, on one line and shortened.
std::string shown(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return print_number(number->get());
  std::ostringstream stream;
  stream << toml::node_view<const toml::node>(node);
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string example_of(const Key& key, Dimension dimension) {
  constexpr double typical = 10;
  return fmt::format("{} = \"{}\"", key.name,
                     print_quantity(typical * units_of(dimension).front().si, dimension));
}

std::string choices_text(const Choices& choices) {
  std::string text;
  for (const std::string_view choice : choices)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", choice);
  return text;
}

/// The remedy for a missing key. What a key is about may be said as belonging to it: "of the
/// press".
std::string to_add(const Key& key, const Choices& choices) {
  const bool belongs = key.about.starts_with("of ");
  std::string text =
      fmt::format("add it: {}{}{}", belongs ? key.name : "", belongs ? " " : "", key.about);
  if (!choices.empty()) text += fmt::format("; one of {}", choices_text(choices));
  return text;
}

bool is_auto(const toml::node& node) {
  return node.value_exact<std::string_view>() == kAutoText;
}

bool is_artifact(std::string_view bytes) {
  return begins_flat(bytes) || bytes.starts_with("\x89HDF\r\n");
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file_name) {
  try {
    return toml::parse(text, file_name);
  } catch (const toml::parse_error& error) {
    std::string problem(error.description());
    std::replace(problem.begin(), problem.end(), '\n', ' ');
    refuse(fmt::format("{}:{}", file_name, error.source().begin.line),
           fmt::format("invalid TOML: {}", problem),
           "correct the line; see toml.io for the syntax");
  }
}

toml::table read_toml(const std::filesystem::path& path, std::string_view what) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  const bool empty = stream && stream.peek() == std::ifstream::traits_type::eof();
  if (stream.bad() || (!empty && !(text << stream.rdbuf()))) {
    refuse(path.string(), fmt::format("cannot read {}", what), "check its path and permissions");
  }
  if (is_artifact(text.str()))
    refuse(path.string(), fmt::format("is an artifact of palpate, not {}", what),
           "give the case that made it, and its folder with --out");
  return parse_toml(text.str(), path.string());
}

std::string SourceMap::where(const std::string& key) const {
  const auto found = lines_.find(key);
  return found == lines_.end() ? file_ : fmt::format("{}:{}", file_, found->second);
}

std::string SourceMap::where(const toml::node& node) const {
  return fmt::format("{}:{}", file_, std::max<std::uint32_t>(1, node.source().begin.line));
}

TableReader::TableReader(const toml::table& table, std::string title, std::string prefix,
                         SourceMap& sources)
    : table_(table), title_(std::move(title)), prefix_(std::move(prefix)), sources_(sources) {}

const toml::node* TableReader::find(const Key& key, const Choices& choices) {
  known_.push_back(key.name);
  const toml::node* node = table_.get(key.name);
  if (node != nullptr) {
    sources_.remember(dotted(key), *node);
  } else if (key.presence == kRequired) {
    missing_.push_back({key, choices});
  }
  return node;
}

/// Reports a missing key before an unknown one, unless the unknown key is a misspelling of it.
void TableReader::finish() const {
  for (const auto& [name, node] : table_) {
    if (std::find(known_.begin(), known_.end(), name.str()) != known_.end()) continue;
    const std::string_view meant = nearest(name.str(), known_);
    const bool is_misspelt = is_like(name.str(), meant);
    if (!missing_.empty() && !is_misspelt) continue;
    refuse(sources_.where(node), fmt::format("unknown key '{}' in {}", name.str(), title_),
           meant_instead(name.str(), known_, "the nearest known key"));
  }
  if (missing_.empty()) return;
  const auto& [key, choices] = missing_.front();
  refuse(sources_.where(table_), fmt::format("key '{}' is missing", dotted(key)),
         to_add(key, choices));
}

const toml::table& TableReader::as_table(const toml::node& node, const std::string& title) const {
  if (const toml::table* table = node.as_table()) return *table;
  refuse(sources_.where(node), fmt::format("{} must be a table, found {}", title, shown(node)),
         fmt::format("write {} on a line of its own and its keys below it", title));
}

const toml::array& TableReader::as_array(const toml::node& node, const std::string& title) const {
  if (const toml::array* array = node.as_array()) return *array;
  refuse(sources_.where(node),
         fmt::format("{} must be a list of tables, found a single value", title),
         fmt::format("write {} with double brackets", title));
}

const toml::array& TableReader::tables_of(const toml::node& node, const Key& key) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty() || !array->front().is_table())
    wrong_type(node, key, "a list with at least one table",
               fmt::format("{} = [{{ ... }}]", key.name));
  return *array;
}

void TableReader::wrong_type(const toml::node& node, const Key& key, std::string_view wanted,
                             const std::string& example) const {
  refuse(sources_.where(node),
         fmt::format("key '{}' needs {}, found {}", dotted(key), wanted, shown(node)),
         fmt::format("write for example {}", example));
}

void TableReader::check_range(double value, const std::string& value_text, const Key& key,
                              const toml::node& node, const std::string& range) const {
  if (std::isfinite(value) && key.range.contains(value)) return;
  refuse(sources_.where(node), fmt::format("{} = {} is out of range", dotted(key), value_text),
         fmt::format("give a value in the range {}", range));
}

void TableReader::text(std::string& value, const Key& key, const Choices& choices) {
  const toml::node* node = find(key, choices);
  if (node == nullptr) return;
  const std::string example =
      fmt::format("{} = \"{}\"", key.name, choices.empty() ? "..." : choices.front());
  const auto found = node->value_exact<std::string>();
  if (!found) wrong_type(*node, key, "a string", example);
  value = *found;
  if (value.empty() && key.presence == kRequired) {
    wrong_type(*node, key, "a string that is not empty", example);
  }
  if (choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  refuse(sources_.where(*node),
         fmt::format("key '{}' is '{}', which is not one of {}", dotted(key), value,
                     choices_text(choices)),
         is_like(value, nearest(value, choices))
             ? fmt::format("the nearest is '{}'", nearest(value, choices))
             : "write one of them");
}

void TableReader::texts(std::vector<std::string>& values, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const std::string example = fmt::format("{} = [\"...\"]", key.name);
  if (!node->is_array()) wrong_type(*node, key, "a list of strings", example);
  values.clear();
  for (const toml::node& item : *node->as_array()) {
    const auto found = item.value_exact<std::string>();
    if (!found) wrong_type(item, key, "a list of strings", example);
    values.push_back(*found);
  }
}

void TableReader::flag(bool& value, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto found = node->value_exact<bool>();
  if (!found) wrong_type(*node, key, "true or false", fmt::format("{} = true", key.name));
  value = *found;
}

void TableReader::flag_or_count(int& value, std::string_view word, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto flag = node->value_exact<bool>()) {
    value = *flag ? 1 : 0;
    return;
  }
  if (node->value_exact<std::string>() == word) {
    value = -1;
    return;
  }
  const auto count = node->value_exact<std::int64_t>();
  if (!count)
    wrong_type(*node, key, fmt::format("true, false, '{}' or an integer", word),
               fmt::format("{} = true", key.name));
  check_range(static_cast<double>(*count), std::to_string(*count), key, *node,
              range_text(key.range));
  value = static_cast<int>(*count);
}

void TableReader::integer(int& value, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto found = node->value_exact<std::int64_t>();
  if (!found) wrong_type(*node, key, "an integer", fmt::format("{} = 10", key.name));
  check_range(static_cast<double>(*found), std::to_string(*found), key, *node,
              range_text(key.range));
  value = static_cast<int>(*found);
}

namespace {

/// A number in the range: the one that stands there in quotes, else one for an example.
double number_like(const toml::node& node, const Range& range) {
  const std::string text = node.value<std::string>().value_or("");
  char* end = nullptr;
  const double there = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::isfinite(there) && range.contains(there)) return there;
  constexpr std::array kExamples{0.5, 0.4, 1.0, 2.0, 10.0};
  const auto fits =
      std::find_if(kExamples.begin(), kExamples.end(), [&](double x) { return range.contains(x); });
  return fits == kExamples.end() ? kExamples.front() : *fits;
}

}  // namespace

double TableReader::number_of(const toml::node& node, const Key& key) const {
  const auto found = node.value<double>();
  if (!node.is_number() || !found) {
    wrong_type(node, key, "a number without unit",
               fmt::format("{} = {}", key.name, number_like(node, key.range)));
  }
  check_range(*found, shown(node), key, node, range_text(key.range));
  return *found;
}

void TableReader::number(double& value, const Key& key) {
  if (const toml::node* node = find(key)) value = number_of(*node, key);
}

double TableReader::quantity_of(const toml::node& node, Dimension dimension, const Key& key) const {
  const std::string_view name = dimension_name(dimension);
  const bool vowel = std::string_view("aeiou").find(name.front()) != std::string_view::npos;
  const std::string kind = fmt::format("{} {}", vowel ? "an" : "a", name);
  const std::string example =
      fmt::format("{} (units: {})", example_of(key, dimension), unit_list(dimension));
  const auto text = node.value_exact<std::string>();
  if (!text) wrong_type(node, key, kind + " with its unit", example);
  const ParsedQuantity parsed = parse_quantity(*text, dimension);
  switch (parsed.fault) {
    case QuantityFault::NoNumber:
    case QuantityFault::NoUnit:
      wrong_type(node, key, kind + " with its unit", example);
    case QuantityFault::WrongUnit:
      wrong_type(node, key, kind + " in one of its units", example);
    case QuantityFault::None:
      break;
  }
  check_range(parsed.value, *text, key, node, range_text(key.range, dimension));
  return parsed.value;
}

void TableReader::quantity(double& value, Dimension dimension, const Key& key) {
  if (const toml::node* node = find(key)) value = quantity_of(*node, dimension, key);
}

void TableReader::quantities(std::vector<double>& values, Dimension dimension, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->empty()) {
    const std::string item = print_quantity(10 * units_of(dimension).front().si, dimension);
    wrong_type(*node, key, fmt::format("a list with at least one {}", dimension_name(dimension)),
               fmt::format("{} = [\"{}\"]", key.name, item));
  }
  values.clear();
  for (const toml::node& item : *array) values.push_back(quantity_of(item, dimension, key));
}

void TableReader::quantity_or_auto(double& value, Dimension dimension, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  value = is_auto(*node) ? kAuto : quantity_of(*node, dimension, key);
}

void TableReader::quantities_or_auto(std::vector<double>& values, Dimension dimension,
                                     const Key& key) {
  const toml::node* node = table_.get(key.name);
  if (node == nullptr || !is_auto(*node)) return quantities(values, dimension, key);
  find(key);
  values.clear();
}

const toml::array& TableReader::three(const toml::node& node, const Key& key,
                                      std::string_view example) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3) {
    wrong_type(node, key, "a list of three values", fmt::format("{} = {}", key.name, example));
  }
  return *array;
}

void TableReader::point(Vec3& value, Dimension dimension, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array& array =
      three(*node, key,
            dimension == Dimension::Acceleration ? R"(["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"])"
                                                 : R"(["0 mm", "0 mm", "10 mm"])");
  for (std::size_t i = 0; i < 3; ++i) value[i] = quantity_of(array[i], dimension, key);
}

void TableReader::direction(Vec3& value, const Key& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array& array = three(*node, key, "[0, 0, 1]");
  for (std::size_t i = 0; i < 3; ++i) value[i] = number_of(array[i], key);
  if (!(norm(value) > 0)) wrong_type(*node, key, "a direction that is not zero", "[0, 0, 1]");
}

}  // namespace palpate::app
