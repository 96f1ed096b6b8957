// SPDX-License-Identifier: AGPL-3.0-or-later
// The reference tables of docs/cases.md, from the same description as the reader.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/case/describe/case.hpp"
#include "app/case/range_text.hpp"

namespace palpate::app {
namespace {

class Documenter {
 public:
  void text(const std::string& value, const Key& key, const Choices& choices = {}) {
    std::string allowed;
    for (const std::string_view choice : choices) {
      allowed += fmt::format("{}`\"{}\"`", allowed.empty() ? "" : ", ", choice);
    }
    if (choices.size() > kMostInACell) {
      below_ += fmt::format("\nValues of `{}`:\n\n", key.name);
      for (const std::string_view choice : choices) below_ += fmt::format("- `\"{}\"`\n", choice);
      allowed = "see below";
    }
    row(key, choices.empty() ? "string" : allowed,
        value.empty() ? "empty" : fmt::format("`\"{}\"`", value));
  }
  void texts(const std::vector<std::string>&, const Key& key) {
    row(key, "list of strings", "`[]`");
  }
  void flag(bool value, const Key& key) { row(key, "`true`, `false`", fmt::format("`{}`", value)); }
  void flag_or_count(int value, std::string_view word, const Key& key) {
    const std::string shown = value < 0   ? fmt::format("\"{}\"", word)
                              : value > 1 ? std::to_string(value)
                                          : fmt::format("{}", value == 1);
    row(key, fmt::format("`true`, `false`, `\"{}\"` or integer, {}", word, range_text(key.range)),
        fmt::format("`{}`", shown));
  }
  void integer(int value, const Key& key) {
    row(key, fmt::format("integer, {}", range_text(key.range)), fmt::format("`{}`", value));
  }
  void number(double value, const Key& key) {
    row(key, fmt::format("number, {}", range_text(key.range)),
        fmt::format("`{}`", print_number(value)));
  }
  void quantity(double value, Dimension dimension, const Key& key) {
    row(key, allowed(dimension, key), fmt::format("`\"{}\"`", print_quantity(value, dimension)));
  }
  void quantities(const std::vector<double>& values, Dimension dimension, const Key& key) {
    row(key, fmt::format("list, each: {}", allowed(dimension, key)),
        fmt::format("`[{}]`", quoted(values, dimension)));
  }
  void quantity_or_auto(double, Dimension dimension, const Key& key) {
    row(key, fmt::format("`\"{}\"` or {}", kAutoText, allowed(dimension, key)),
        fmt::format("`\"{}\"`", kAutoText));
  }
  void quantities_or_auto(const std::vector<double>&, Dimension dimension, const Key& key) {
    row(key, fmt::format("`\"{}\"` or list, each: {}", kAutoText, allowed(dimension, key)),
        fmt::format("`\"{}\"`", kAutoText));
  }
  void point(const Vec3& value, Dimension dimension, const Key& key) {
    row(key, fmt::format("three values, each: {}", allowed(dimension, key)),
        fmt::format("`[{}]`", quoted(value, dimension)));
  }
  void direction(const Vec3&, const Key& key) { row(key, "three numbers, not all 0", ""); }

  template <class S, class Body>
  void tables(std::vector<S>&, const Key& key, Body body) {
    row(key, "list of tables with the keys below", "`[]`");
    owner_ = fmt::format("{}.", key.name);
    S defaults;
    body(*this, defaults);
    owner_.clear();
  }

  /// Documents every alternative, with its condition.
  bool when(std::string_view key, const std::string&, std::string_view wanted) {
    condition_ = fmt::format(" (`{} = \"{}\"`)", key, wanted);
    return true;
  }

  bool has_section(std::string_view, bool) { return true; }

  template <class Body>
  void section(std::string_view name, Presence presence, std::string_view about, Body body) {
    open(fmt::format("[{}]", name), presence, about);
    body(*this);
  }
  template <class S, class Body>
  void sections(std::string_view name, std::vector<S>&, Presence presence, std::string_view about,
                Body body) {
    open(fmt::format("[[{}]]", name), presence, about);
    S defaults;
    body(*this, defaults);
  }

  std::string result() const {
    std::string units = "\n### Units\n\n| dimension | units |\n|---|---|\n";
    for (const Dimension dimension : used_)
      units += fmt::format("| {} | {} |\n", dimension_name(dimension), unit_list(dimension));
    return out_ + below_ + units;
  }
  void table_head() { out_ += "| key | meaning | value | default |\n|---|---|---|---|\n"; }

 private:
  void open(const std::string& title, Presence presence, std::string_view about) {
    condition_.clear();
    out_ += std::exchange(below_, {});
    out_ += fmt::format("\n### `{}`{}\n\n{}\n\n", title, presence == kRequired ? ", required" : "",
                        about);
    table_head();
  }
  void row(const Key& key, std::string_view values, std::string_view by_default) {
    out_ += fmt::format("| `{}{}` | {}{} | {} | {} |\n", owner_, key.name, key.about, condition_,
                        values, key.presence == kRequired ? "required" : by_default);
  }
  template <class Values>
  static std::string quoted(const Values& values, Dimension dimension) {
    std::string list;
    for (const double value : values)
      list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", print_quantity(value, dimension));
    return list;
  }
  std::string allowed(Dimension dimension, const Key& key) {
    if (std::find(used_.begin(), used_.end(), dimension) == used_.end()) used_.push_back(dimension);
    return fmt::format("{}, {}", dimension_name(dimension), range_text(key.range, dimension));
  }

  static constexpr std::size_t kMostInACell = 5;

  std::string out_;
  std::string condition_;
  std::string owner_;  ///< key of the list of tables whose keys are documented
  std::string below_;  ///< what a cell is too small for, printed below the table
  std::vector<Dimension> used_;
};

}  // namespace

std::string case_reference() {
  Documenter documenter;
  Case defaults;
  documenter.table_head();
  describe(documenter, defaults);
  return documenter.result();
}

}  // namespace palpate::app
