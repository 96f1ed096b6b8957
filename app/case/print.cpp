// SPDX-License-Identifier: AGPL-3.0-or-later
// The resolved case: the value of every key, as TOML.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/case/describe/case.hpp"
#include "app/case/material.hpp"
#include "app/case/toml_string.hpp"

namespace palpate::app {
namespace {

template <class T, class Print>
std::string list(const T& items, Print print) {
  std::string out;
  for (const auto& item : items) out += fmt::format("{}{}", out.empty() ? "" : ", ", print(item));
  return fmt::format("[{}]", out);
}

class Printer {
 public:
  /// Prints these sections only; null: all.
  explicit Printer(const std::vector<std::string_view>* wanted)
      : wanted_(wanted), printing_(is_wanted("")) {}

  void text(const std::string& value, const Key& key, const Choices& = {}) {
    line(key, toml_string(value));
  }
  void texts(const std::vector<std::string>& values, const Key& key) {
    line(key, list(values, toml_string));
  }
  void flag(bool value, const Key& key) { line(key, value ? "true" : "false"); }
  void flag_or_count(int value, std::string_view word, const Key& key) {
    if (value < 0) return line(key, toml_string(std::string(word)));
    value > 1 ? integer(value, key) : flag(value == 1, key);
  }
  void integer(int value, const Key& key) { line(key, std::to_string(value)); }
  void number(double value, const Key& key) { line(key, print_number(value)); }
  void quantity(double value, Dimension dimension, const Key& key) {
    line(key, toml_string(print_quantity(value, dimension)));
  }
  template <class T>
  void quantities(const T& values, Dimension dimension, const Key& key) {
    line(key,
         list(values, [dimension](double v) { return toml_string(print_quantity(v, dimension)); }));
  }
  void quantity_or_auto(double value, Dimension dimension, const Key& key) {
    if (!std::isnan(value)) return quantity(value, dimension, key);
    line(key, toml_string(kAutoText));
  }
  void quantities_or_auto(const std::vector<double>& values, Dimension dimension, const Key& key) {
    if (!values.empty()) return quantities(values, dimension, key);
    line(key, toml_string(kAutoText));
  }
  void point(const Vec3& value, Dimension dimension, const Key& key) {
    quantities(value, dimension, key);
  }
  void direction(const Vec3& value, const Key& key) { line(key, list(value, print_number)); }

  template <class S, class Body>
  void tables(std::vector<S>& items, const Key& key, Body body) {
    if (items.empty()) return;
    line(key, list(items, [&body](S item) {
           Printer inner(nullptr);
           body(inner, item);
           std::string keys = inner.out_.substr(0, inner.out_.size() - 1);
           for (std::size_t end; (end = keys.find('\n')) != std::string::npos;)
             keys.replace(end, 1, ", ");
           return fmt::format("{{ {} }}", keys);
         }));
  }

  bool when(std::string_view, const std::string& value, std::string_view wanted) {
    return value == wanted;
  }

  bool has_section(std::string_view, bool has_values) { return has_values; }

  template <class Body>
  void section(std::string_view name, Presence, std::string_view, Body body) {
    if (!is_wanted(name)) return;
    printing_ = true;
    out_ += fmt::format("\n[{}]\n", name);
    body(*this);
  }

  template <class S, class Body>
  void sections(std::string_view name, std::vector<S>& items, Presence, std::string_view,
                Body body) {
    if (!is_wanted(name)) return;
    printing_ = true;
    for (S& s : items) {
      out_ += fmt::format("\n[[{}]]\n", name);
      body(*this, s);
    }
  }

  const std::string& result() const { return out_; }

 private:
  bool is_wanted(std::string_view section) const {
    return wanted_ == nullptr ||
           std::find(wanted_->begin(), wanted_->end(), section) != wanted_->end();
  }
  void line(const Key& key, const std::string& value) {
    if (printing_) out_ += fmt::format("{} = {}\n", key.name, value);
  }

  const std::vector<std::string_view>* wanted_;
  bool printing_;
  std::string out_;
};

std::string print(const Case& c, const std::vector<std::string_view>* wanted) {
  Printer printer(wanted);
  Case copy = c;  // describe() takes references that a reader writes to
  describe(printer, copy);
  return printer.result();
}

}  // namespace

bool operator==(const Case& a, const Case& b) {
  return resolved_toml(a) == resolved_toml(b);
}

std::string resolved_toml(const Case& c) {
  return print(c, nullptr);
}

std::string material_keys(const fem::LawConstants& law) {
  MaterialSection material;
  material.law = law;
  Printer printer(nullptr);
  describe_law(printer, material);
  return printer.result();
}

std::string resolved_sections(const Case& c, const std::vector<std::string_view>& sections) {
  return print(c, &sections);
}

}  // namespace palpate::app
