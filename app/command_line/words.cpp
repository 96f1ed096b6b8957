// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/words.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <utility>

#include "app/case/nearest.hpp"

namespace palpate::app {
namespace {

std::vector<std::string> subcommands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

/// "--name" of every option that the command and its parents take.
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* here = &command; here != nullptr; here = here->get_parent())
    for (const CLI::Option* option : here->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::App& command, const std::string& name) {
  for (const CLI::App* here = &command; here != nullptr; here = here->get_parent())
    if (const CLI::Option* option = here->get_option_no_throw(name))
      return option->get_expected_min() > 0;
  return false;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a word may be mistyped for another.
bool is_near(std::string_view word, std::string_view other) {
  return edit_distance(word, other) <= std::max<std::size_t>(2, word.size() / 3);
}

/// The known word that begins as this one does, where there is but one; else the nearest.
std::string closest(const std::string& word, const std::vector<std::string>& known) {
  const auto begins_alike = [&](const std::string& other) { return other.starts_with(word); };
  const auto longer = std::find_if(known.begin(), known.end(), begins_alike);
  if (longer != known.end() && std::find_if(longer + 1, known.end(), begins_alike) == known.end())
    return *longer;
  const std::string_view other = nearest(word, {known.begin(), known.end()});
  return is_near(word, other) ? std::string(other) : std::string();
}

/// @param help the words that explain the command
std::string unknown_text(const std::string& kind, const std::string& word,
                         const std::vector<std::string>& known, const std::string& help) {
  const std::string other = closest(word, known);
  const std::string unknown = "unknown " + kind + " '" + word + "'";
  if (other.empty()) return unknown + "; see '" + help + "'";
  return unknown + "; the nearest is '" + other + "'";
}

}  // namespace

std::vector<std::string> help_as_option(std::vector<std::string> words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

std::string unknown_word(const CLI::App& root, const std::vector<std::string>& words) {
  const CLI::App* command = &root;
  std::string help = root.get_name() + " help";
  bool value = false;  // of the option before
  for (const std::string& word : words) {
    if (word == "--") return {};
    if (std::exchange(value, false)) continue;
    if (word.starts_with("--")) {
      const std::string name = word.substr(0, word.find('='));
      const auto known = options_of(*command);
      if (!contains(known, name)) return unknown_text("option", name, known, help);
      value = name == word && takes_value(*command, name);
      continue;
    }
    const auto names = subcommands_of(*command);
    if (word.starts_with("-") || names.empty()) continue;
    if (!contains(names, word)) return unknown_text("subcommand", word, names, help);
    command = command->get_subcommand(word);
    help += " " + word;
  }
  return {};
}

std::string help_for(const CLI::App& root) {
  std::string command = root.get_name() + " help";
  for (const CLI::App* here = &root; !here->get_subcommands().empty();) {
    here = here->get_subcommands().back();
    command += " " + here->get_name();
  }
  return command;
}

}  // namespace palpate::app
