// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/range_text.hpp"

#include <cmath>

namespace palpate::app {

std::string range_text(const Range& range, std::optional<Dimension> dimension) {
  const auto show = [&](double value) {
    if (dimension) return print_quantity(value, *dimension);
    std::string text = print_number(value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text;
  };
  const bool below = std::isfinite(range.low);
  const bool above = std::isfinite(range.high);
  if (!below && !above) return "any finite value";
  if (!above) return (range.low_open ? "> " : ">= ") + show(range.low);
  std::string text = show(range.low) + " .. " + show(range.high);
  if (range.low_open && range.high_open) return text + ", both ends excluded";
  if (range.low_open) return text + ", lower end excluded";
  if (range.high_open) return text + ", upper end excluded";
  return text;
}

}  // namespace palpate::app
