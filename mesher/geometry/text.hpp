// SPDX-License-Identifier: AGPL-3.0-or-later
// Text of messages: counts and lengths as a user reads them.
#pragma once

#include <functional>
#include <sstream>
#include <string>
#include <string_view>

#include "format/position_text.hpp"

namespace palpate::mesher {

using Log = std::function<void(std::string_view)>;

/// Joins its arguments; numbers have up to six significant digits.
template <typename... Part>
std::string text(const Part&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

/// "12.5 mm"
inline std::string millimetres(double metres) {
  return text(1e3 * metres, " mm");
}

/// "1 vertex", "2 vertices"
inline std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return text(count, " ", count == 1 ? one : many);
}

/// "1 edge", "2 edges"
inline std::string counted(std::size_t count, std::string_view noun) {
  return counted(count, noun, text(noun, "s"));
}

/// Passes the line to the log, if there is one.
inline void note(const Log& log, const std::string& line) {
  if (log) log(line);
}

inline constexpr std::string_view kWarningMark = "warning: ";  ///< in front of lines of warn()

/// The same for what casts doubt on the result.
inline void warn(const Log& log, const std::string& line) {
  note(log, text(kWarningMark, line));
}

}  // namespace palpate::mesher
