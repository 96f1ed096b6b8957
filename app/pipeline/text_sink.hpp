// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "app/console.hpp"
#include "app/pipeline/events.hpp"

namespace palpate::app {

/// Prints events as lines of text, and progress as a bar where the output is a terminal; warnings
/// go to the standard error. Not thread-safe.
class TextSink {
 public:
  explicit TextSink(Console console) : console_(std::move(console)) {}
  void operator()(const Event& event);

 private:
  void print(const StageStarted& e);
  void print(const StageUpToDate& e);
  void print(const LogLine& e);
  void print(const ChallengeVerdict& e);
  void print(const Warning& e);
  void print(const MeshFinished& e);
  void print(const CampaignStarted& e);
  void print(const PreloadStep& e);
  void print(const SiteFinished& e);
  void print(const Progress& e);
  void print(const FinerMeshProgress& e);
  void print(const SamplingRound& e);
  void print(const SamplingFinished& e);
  void print(const CampaignFinished& e);
  void print(const MergeFinished& e);
  void print(const FitFinished& e);
  void print(const Certified& e);
  void print(const StiffnessAtRate& e);
  void print(const Softened& e);
  void print(const SteepestForce& e);
  void print(const ConvergenceLevel& e);
  void print(const ConvergenceOfForce& e);
  void print(const Estimate& e);
  void print(const FileWritten& e);

  /// A result that was asked for, which a quiet command prints too.
  template <class... Args>
  void result(fmt::format_string<Args...> format, Args&&... args) {
    progress_.interrupt();
    console_.out.line(fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    if (console_.verbosity != Verbosity::Quiet) result(format, std::forward<Args>(args)...);
  }
  void warning(std::string_view text);

  Console console_;
  SiteSharing sharing_;
  ProgressDisplay progress_{"precompute", console_.out};
};

}  // namespace palpate::app
