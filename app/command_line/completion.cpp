// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/completion.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>
#include <string>

namespace palpate::app {
namespace {

/// The parts of the script that the commands fill in.
struct Cases {
  std::string paths;  ///< patterns of the words that lead to a subcommand
  std::string words;  ///< a branch a command: its options and subcommands
};

/// The options of the command and of its parents, each once.
std::string option_words(const CLI::App& command) {
  std::set<std::string> names;
  for (const CLI::App* here = &command; here != nullptr; here = here->get_parent())
    for (const CLI::Option* option : here->get_options())
      names.insert(option->get_lnames().begin(), option->get_lnames().end());
  std::string words;
  for (const std::string& name : names) words += " --" + name;
  return words;
}

void collect(const CLI::App& command, const std::string& path, Cases& cases) {
  std::string names;
  for (const CLI::App* sub : command.get_subcommands({})) {
    const std::string deeper = path + " " + sub->get_name();
    names += " " + sub->get_name();
    cases.paths += fmt::format("{}\"{}\"", cases.paths.empty() ? "" : "|", deeper);
    collect(*sub, deeper, cases);
  }
  cases.words += fmt::format("    \"{}\") names=\"{}\" options=\"{}\" ;;\n", path, names,
                             option_words(command));
}

}  // namespace

std::string bash_completion(const CLI::App& root) {
  Cases cases;
  collect(root, "", cases);
  return fmt::format(R"(# bash completion of {0}
_{0}() {{
  local here=${{COMP_WORDS[COMP_CWORD]}} path= word names options
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path $word" in
      {1}) path="$path $word" ;;
    esac
  done
  case "$path" in
{2}  esac
  if [[ $here == -* ]]; then names=$options; fi
  mapfile -t COMPREPLY < <(compgen -W "$names" -- "$here")
}}
complete -o default -F _{0} {0}
)",
                     root.get_name(), cases.paths, cases.words);
}

}  // namespace palpate::app
