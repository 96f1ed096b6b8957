// SPDX-License-Identifier: AGPL-3.0-or-later
// The visitor that reads settings from TOML.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/case/describe/case.hpp"

namespace palpate::app {

/// Parses a TOML file. `what` names it in messages. @throws Error(Configuration) with the line.
toml::table read_toml(const std::filesystem::path& path, std::string_view what);
toml::table parse_toml(std::string_view text, const std::string& file_name);

/// The line of each key, for the messages of later checks.
class SourceMap {
 public:
  explicit SourceMap(std::string file) : file_(std::move(file)) {}

  void remember(const std::string& key, const toml::node& node) {
    lines_[key] = node.source().begin.line;
  }
  bool has(const std::string& key) const { return lines_.contains(key); }
  /// "file:line" of a dotted key; the file alone when the key is absent.
  std::string where(const std::string& key) const;
  std::string where(const toml::node& node) const;

 private:
  std::string file_;
  std::map<std::string, std::uint32_t> lines_;
};

/// Reads one table. finish() rejects unknown keys and missing ones.
class TableReader {
 public:
  /// title: name of the table in messages ("[mesh]"); prefix: of its dotted keys ("mesh.").
  TableReader(const toml::table& table, std::string title, std::string prefix, SourceMap& sources);

  void text(std::string& value, const Key& key, const Choices& choices = {});
  void texts(std::vector<std::string>& values, const Key& key);
  void flag(bool& value, const Key& key);
  /// false is 0, true is 1, and `word` is -1.
  void flag_or_count(int& value, std::string_view word, const Key& key);
  void integer(int& value, const Key& key);
  void number(double& value, const Key& key);
  void quantity(double& value, Dimension dimension, const Key& key);
  void quantities(std::vector<double>& values, Dimension dimension, const Key& key);
  void quantity_or_auto(double& value, Dimension dimension, const Key& key);
  void quantities_or_auto(std::vector<double>& values, Dimension dimension, const Key& key);
  void point(Vec3& value, Dimension dimension, const Key& key);
  void direction(Vec3& value, const Key& key);

  bool when(std::string_view, const std::string& value, std::string_view wanted) {
    return value == wanted;
  }

  /// A list of tables as the value of a key: [{ a = 1, b = "2 mm" }, ...].
  template <class S, class Body>
  void tables(std::vector<S>& list, const Key& key, Body body) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    for (const toml::node& item : tables_of(*node, key)) {
      const std::string name = fmt::format("{}[{}]", dotted(key), list.size());
      S& s = list.emplace_back();
      read(as_table(item, name), name, name + ".", [&](TableReader& inner) { body(inner, s); });
    }
  }

  /// Whether the file has the section; its name is known whether or not.
  bool has_section(std::string_view name, bool) {
    known_.push_back(name);
    return table_.contains(name);
  }

  template <class S>
  void section(std::string_view name, S& s, Presence presence, std::string_view about) {
    section(name, presence, about, [&](TableReader& inner) { describe(inner, s); });
  }
  /// The keys are those that `body` describes to a visitor.
  template <class Body>
  void section(std::string_view name, Presence presence, std::string_view about, Body body) {
    const toml::node* node = find({name, about, presence});
    if (node == nullptr) return;
    const std::string title = fmt::format("[{}]", name);
    read(as_table(*node, title), title, fmt::format("{}.", name), body);
  }

  template <class S>
  void sections(std::string_view name, std::vector<S>& list, Presence presence,
                std::string_view about) {
    sections(name, list, presence, about, [](TableReader& inner, S& s) { describe(inner, s); });
  }
  template <class S, class Body>
  void sections(std::string_view name, std::vector<S>& list, Presence presence,
                std::string_view about, Body body) {
    const toml::node* node = find({name, about, presence});
    if (node == nullptr) return;
    const std::string title = fmt::format("[[{}]]", name);
    for (const toml::node& item : as_array(*node, title)) {
      const std::string prefix = fmt::format("{}[{}].", name, list.size());
      sources_.remember(prefix, item);
      S& s = list.emplace_back();
      read(as_table(item, title), title, prefix, [&](TableReader& inner) { body(inner, s); });
    }
  }

  void finish() const;

 private:
  template <class Body>
  void read(const toml::table& table, const std::string& title, const std::string& prefix,
            Body body) {
    TableReader inner(table, title, prefix, sources_);
    body(inner);
    inner.finish();
  }

  struct Missing {
    Key key;
    Choices choices;
  };

  const toml::node* find(const Key& key, const Choices& choices = {});
  const toml::table& as_table(const toml::node& node, const std::string& title) const;
  const toml::array& as_array(const toml::node& node, const std::string& title) const;
  const toml::array& tables_of(const toml::node& node, const Key& key) const;
  const toml::array& three(const toml::node& node, const Key& key, std::string_view example) const;
  double quantity_of(const toml::node& node, Dimension dimension, const Key& key) const;
  double number_of(const toml::node& node, const Key& key) const;
  void check_range(double value, const std::string& shown, const Key& key, const toml::node& node,
                   const std::string& range) const;
  [[noreturn]] void wrong_type(const toml::node& node, const Key& key, std::string_view wanted,
                               const std::string& example) const;
  std::string dotted(const Key& key) const { return fmt::format("{}{}", prefix_, key.name); }

  const toml::table& table_;
  std::string title_;
  std::string prefix_;
  SourceMap& sources_;
  std::vector<std::string_view> known_;
  std::vector<Missing> missing_;
};

}  // namespace palpate::app
