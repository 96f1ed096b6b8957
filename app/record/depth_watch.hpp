// SPDX-License-Identifier: AGPL-3.0-or-later
// Counts the steps of a session whose forces are guesses.
#pragma once

#include <cstdint>
#include <string>

#include "format/recording.hpp"

namespace palpate::app {

/// Steps beyond the deepest sample of a response: their forces are extrapolated, not computed.
class DepthWatch {
 public:
  void see(const RecordedStep& step);

  std::int64_t contact() const { return contact_; }  ///< steps in contact
  std::int64_t beyond() const { return beyond_; }    ///< of them beyond the deepest sample
  double deepest() const { return deepest_; }        ///< m, of all steps

  /// What a user must know, with `remedy` as its end; empty where no step went beyond.
  /// @param known  m, depth to which every response of the library is known
  std::string warning(double known, const std::string& remedy) const;

 private:
  std::int64_t contact_ = 0, beyond_ = 0;
  double deepest_ = 0;
};

}  // namespace palpate::app
