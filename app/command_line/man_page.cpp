// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/man_page.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>

namespace palpate::app {
namespace {

/// Text in roff: a backslash, a hyphen that is to be copied, and a leading dot are its own.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool starts_line = out.empty() || out.back() == '\n';
    if (starts_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string bold(std::string_view text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + roff(text) + "\\fR";
}

/// What stands for the value of an option; "" for a flag.
std::string value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  if (!option.get_option_text().empty()) return option.get_option_text();
  const std::string type = option.get_type_name();
  return type.substr(0, type.find_first_of(" :["));
}

std::string names_of(const CLI::Option& option) {
  if (option.get_positional()) return italic(option.get_name(true));
  std::string names;
  const auto add = [&](const std::string& name) {
    names += (names.empty() ? "" : ", ") + bold(name);
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  const std::string value = value_of(option);
  return value.empty() ? names : names + " " + italic(value);
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

std::string synopsis(const CLI::App& command) {
  std::string text = bold(full_name(command)) + " [" + italic("option") + "]...";
  if (!command.get_subcommands({}).empty()) text += " " + italic("subcommand");
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = italic(option->get_name(true));
    const std::string more = option->get_items_expected_max() > 1 ? "..." : "";
    text += option->get_required() ? fmt::format(" {}{}", name, more)
                                   : fmt::format(" [{}{}]", name, more);
  }
  return text;
}

void add_item(std::string& page, const std::string& head, const std::string& text) {
  page += ".TP\n" + head + "\n" + roff(text) + "\n";
}

void add_options(std::string& page, const CLI::App& command) {
  page += ".SH OPTIONS\n";
  for (const bool positional : {true, false})
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() == positional)
        add_item(page, names_of(*option), option->get_description());
}

void add_subcommands(std::string& page, const CLI::App& command) {
  const auto subcommands = command.get_subcommands({});
  if (subcommands.empty()) return;
  page += ".SH SUBCOMMANDS\n";
  for (const CLI::App* sub : subcommands)
    add_item(page, bold(man_page_name(*sub)) + "(1)", sub->get_description());
}

/// The footer of the help, each line on its own.
void add_notes(std::string& page, const CLI::App& command) {
  if (command.get_footer().empty()) return;
  page += ".SH NOTES\n.nf\n";
  std::istringstream footer(command.get_footer());
  for (std::string line; std::getline(footer, line);) page += roff(line) + "\n";
  page += ".fi\n";
}

}  // namespace

std::string man_page_name(const CLI::App& command) {
  std::string name = full_name(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string man_page(const CLI::App& command, std::string_view version) {
  std::string title = man_page_name(command);
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string page = fmt::format(".TH {} 1 \"\" \"{}\"\n", roff(title), roff(version));
  page += ".SH NAME\n" + roff(man_page_name(command)) + " \\- " + roff(command.get_description()) +
          "\n.SH SYNOPSIS\n" + synopsis(command) + "\n";
  add_options(page, command);
  add_subcommands(page, command);
  add_notes(page, command);
  if (const CLI::App* parent = command.get_parent())
    page += ".SH SEE ALSO\n" + bold(man_page_name(*parent)) + "(1)\n";
  return page;
}

}  // namespace palpate::app
