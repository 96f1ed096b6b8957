// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "app/case/case.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"

namespace palpate::app {

/// A script on a library, played through the public C interface with a simulated device and hand.
class ScriptedSession {
 public:
  /// `library` is the content of `library_file`. lipschitz_bound: N/m, 0 = that of the library.
  /// @throws Error(Configuration) when the library cannot be loaded or does not allow the bound, or
  /// the script does not fit the library.
  ScriptedSession(const std::filesystem::path& library_file, const Library& library,
                  const SimulateSection& script, double lipschitz_bound = 0);
  ~ScriptedSession();
  ScriptedSession(const ScriptedSession&) = delete;
  ScriptedSession& operator=(const ScriptedSession&) = delete;

  /// Its provenance is left to the caller.
  RecordingHeading heading() const;
  /// Every step, as it is made.
  void play(const std::function<void(const RecordedStep&)>& record);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::app
