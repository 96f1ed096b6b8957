// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "app/case/case.hpp"

namespace palpate::app {

/// The part of the sites that one of several machines computes: every `count`-th, from `index`.
struct Shard {
  int index = 1;  ///< 1..count
  int count = 1;
};

/// A case and where its artifacts are.
struct Workspace {
  Case c;
  std::filesystem::path case_folder;  ///< surfaces and profiles are relative to it
  std::filesystem::path out;
  int threads = 1;
  double memory = 0;  ///< bytes that precompute may use; 0: no bound
  Shard shard;

  std::filesystem::path body() const { return out / "body.h5"; }
  std::filesystem::path curves() const { return out / "curves.h5"; }
  /// The file that precompute writes: curves(), or the part of the shard.
  std::filesystem::path precomputed() const;
  /// The finished sites of an unfinished campaign.
  std::filesystem::path journal() const;
  std::filesystem::path library() const { return out / "library.h5"; }
  /// The displacements of the skin that the campaign keeps, a file for each site.
  std::filesystem::path fields() const { return out / "fields"; }
  std::filesystem::path deformation() const { return out / "deformation.pdef"; }
  std::filesystem::path recording() const { return out / "recording.h5"; }
  std::filesystem::path report() const { return out / "report.html"; }
};

/// Reads the case; creates nothing. `out` empty: the folder that the case names, or out/NAME.
/// @param size  of the body of a case, in the folder of its file; asked only where lengths of the
///   case are derived from it
Workspace make_workspace(const std::filesystem::path& case_file, const std::string& out,
                         int threads, const SizeOfBody& size = {});

/// Creates the output folder and checks that it is writable, before any long work.
/// @throws Error(Configuration).
void prepare_output(const std::filesystem::path& folder);

}  // namespace palpate::app
