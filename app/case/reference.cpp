// SPDX-License-Identifier: AGPL-3.0-or-later
// The reference tables of docs/cases.md, from the same description as the reader.
#include <fmt/format.h>

#include "app/case/describe.hpp"
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
    row(key, choices.empty() ? "text" : allowed,
        value.empty() ? "empty" : fmt::format("`\"{}\"`", value));
  }
  void texts(const std::vector<std::string>&, const Key& key) { row(key, "list of texts", "`[]`"); }
  void flag(bool value, const Key& key) { row(key, "`true`, `false`", fmt::format("`{}`", value)); }
  void integer(int value, const Key& key) {
    row(key, fmt::format("whole number, {}", range_text(key.range)), fmt::format("`{}`", value));
  }
  void number(double value, const Key& key) {
    row(key, fmt::format("number, {}", range_text(key.range)),
        fmt::format("`{}`", print_number(value)));
  }
  void quantity(double value, Dimension dimension, const Key& key) {
    row(key, allowed(dimension, key), fmt::format("`\"{}\"`", print_quantity(value, dimension)));
  }
  void quantities(const std::vector<double>& values, Dimension dimension, const Key& key) {
    std::string shown;
    for (const double value : values) {
      shown += fmt::format("{}\"{}\"", shown.empty() ? "" : ", ", print_quantity(value, dimension));
    }
    row(key, fmt::format("list, each: {}", allowed(dimension, key)), fmt::format("`[{}]`", shown));
  }
  void point(const Vec3&, Dimension dimension, const Key& key) {
    row(key, fmt::format("list of three, each: {}", allowed(dimension, key)), "");
  }
  void direction(const Vec3&, const Key& key) { row(key, "list of three numbers, not all 0", ""); }

  /// Every alternative is documented, with its condition.
  bool when(std::string_view key, const std::string&, std::string_view wanted) {
    condition_ = fmt::format(" (`{} = \"{}\"`)", key, wanted);
    return true;
  }

  template <class S>
  void section(std::string_view name, S& s, Presence presence, std::string_view about) {
    open(fmt::format("[{}]", name), presence, about);
    describe(*this, s);
  }
  template <class S>
  void sections(std::string_view name, std::vector<S>&, Presence presence, std::string_view about) {
    open(fmt::format("[[{}]]", name), presence, about);
    S defaults;
    describe(*this, defaults);
  }

  const std::string& result() const { return out_; }
  void table_head() { out_ += "| key | meaning | value | default |\n|---|---|---|---|\n"; }

 private:
  void open(const std::string& title, Presence presence, std::string_view about) {
    condition_.clear();
    out_ += fmt::format("\n### `{}`{}\n\n{}\n\n", title, presence == kRequired ? ", required" : "",
                        about);
    table_head();
  }
  void row(const Key& key, std::string_view values, std::string_view by_default) {
    out_ += fmt::format("| `{}` | {}{} | {} | {} |\n", key.name, key.about, condition_, values,
                        key.presence == kRequired ? "required" : by_default);
  }
  static std::string allowed(Dimension dimension, const Key& key) {
    return fmt::format("{} ({}), {}", dimension_name(dimension), unit_list(dimension),
                       range_text(key.range, dimension));
  }

  std::string out_;
  std::string condition_;
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
