// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/command_line/completion.hpp"
#include "app/command_line/man_page.hpp"
#include "app/console.hpp"
#include "format/error.hpp"
#include "format/provenance.hpp"

namespace palpate::app {
namespace {

void write_page(const std::filesystem::path& folder, const CLI::App& command) {
  const std::filesystem::path path = folder / (man_page_name(command) + ".1");
  std::ofstream file(path);
  file << man_page(command, creator_text());
  if (!file.flush())
    throw Error(ErrorKind::Internal, path.string(), "cannot be written",
                "check the permissions and the free space of the folder");
}

int write_pages(const CLI::App& command, const std::filesystem::path& folder) {
  write_page(folder, command);
  int pages = 1;
  for (const CLI::App* sub : command.get_subcommands({})) pages += write_pages(*sub, folder);
  return pages;
}

}  // namespace

void add_manual_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand("manual", "Writes the manual pages, for man(1)");
  command->footer("Example: palpate manual ~/.local/share/man/man1");
  const auto folder = std::make_shared<std::string>();
  command->add_option("FOLDER", *folder, "Where the pages go")->required();
  command->callback([&root, folder, &action] {
    action = [&root, folder] {
      std::error_code failed;
      std::filesystem::create_directories(*folder, failed);
      if (failed)
        refuse(*folder, "cannot be made: " + failed.message(), "name a folder that can be written");
      say("manual: {} pages -> {}", write_pages(root, *folder), *folder);
      return kExitDone;
    };
  });
}

void add_completion_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("completion", "Prints a script that completes the words of palpate");
  command->footer("Example: source <(palpate completion bash)");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash")->required()->check(CLI::IsMember({"bash"}));
  command->callback([&root, &action] {
    action = [&root] {
      print_line(bash_completion(root));
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
