// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/workspace.hpp"

#include <unistd.h>

#include <system_error>

#include "format/error.hpp"

namespace palpate::app {

namespace fs = std::filesystem;

fs::path Workspace::precomputed() const {
  if (shard.count == 1) return curves();
  return out /
         ("curves." + std::to_string(shard.index) + "-of-" + std::to_string(shard.count) + ".h5");
}

fs::path Workspace::journal() const {
  return precomputed().replace_extension(".journal");
}

Workspace make_workspace(const fs::path& case_file, const std::string& out, int threads) {
  Workspace space;
  space.c = read_case(case_file);
  space.case_folder = case_file.parent_path();
  space.threads = threads;
  if (!out.empty()) {
    space.out = out;
  } else if (!space.c.output.folder.empty()) {
    space.out = space.c.output.folder;
  } else {
    space.out = fs::path("out") / space.c.name;
  }
  return space;
}

void prepare_output(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    throw Error(ErrorKind::Configuration, folder.string(),
                "cannot create the output folder (" + failure.message() + ")",
                "choose another with --out");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorKind::Configuration, folder.string(), "the output folder is not writable",
                "choose another with --out");
  }
}

}  // namespace palpate::app
