// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/workspace.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>

#include "format/error.hpp"

namespace palpate::app {

namespace fs = std::filesystem;

namespace {

/// Endings of surfaces, volume meshes and images: what a new user gives instead of a case.
constexpr std::array<std::string_view, 20> kBodies{
    ".stl", ".obj", ".off",  ".ply", ".vtk", ".vtp",  ".vtu",  ".msh", ".mesh", ".inp",
    ".feb", ".ele", ".node", ".nii", ".gz",  ".nrrd", ".nhdr", ".3mf", ".step", ".glb"};

void refuse_bodies(const fs::path& case_file) {
  std::string ending = case_file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(kBodies.begin(), kBodies.end(), ending) == kBodies.end()) return;
  refuse(case_file.string(), "is no case: the ending is that of a surface, mesh or image",
         "write a case for it, as docs/your-own-organ.md shows; 'palpate init' writes one for a "
         "surface");
}

}  // namespace

fs::path Workspace::precomputed() const {
  if (shard.count == 1) return curves();
  return out /
         ("curves." + std::to_string(shard.index) + "-of-" + std::to_string(shard.count) + ".h5");
}

fs::path Workspace::journal() const {
  return precomputed().replace_extension(".journal");
}

Workspace make_workspace(const fs::path& case_file, const std::string& out, int threads,
                         const SizeOfBody& size) {
  refuse_bodies(case_file);
  Workspace space;
  space.c = read_case(case_file, size);
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
