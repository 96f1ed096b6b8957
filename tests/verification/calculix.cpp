// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/verification/calculix.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace palpate::test {

namespace fs = std::filesystem;

std::string printed_by_calculix(const std::string& deck) {
  std::string name = (fs::temp_directory_path() / "palpate-ccx-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = name;
  std::ofstream(folder / "site.inp") << deck;
  const std::string command =
      "cd " + folder.string() + " && OMP_NUM_THREADS=1 timeout 550 ccx site > site.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "install ccx (Debian package calculix-ccx)";
  std::ostringstream printed;
  printed << std::ifstream(folder / "site.dat").rdbuf();
  fs::remove_all(folder);
  return printed.str();
}

}  // namespace palpate::test
