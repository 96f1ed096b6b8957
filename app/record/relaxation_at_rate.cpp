// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/relaxation_at_rate.hpp"

#include <fmt/format.h>

#include "format/number_text.hpp"

namespace palpate::app {

std::string short_relaxation_warning(const Library& library, double rate) {
  constexpr double kPeriods = 5;
  if (!library.relaxes() || library.relaxation_times.front() * rate >= kPeriods) return {};
  return fmt::format(
      "the shortest relaxation time, {} ms, is below five periods of the force loop at {} Hz: the "
      "forces lag by about a period; raise the rate, or leave this time out of the case",
      number_text(1e3 * library.relaxation_times.front()), number_text(rate));
}

}  // namespace palpate::app
