// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/quantity.hpp"

#include <array>
#include <charconv>
#include <system_error>

#include "format/text.hpp"

namespace palpate::app {
namespace {

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension) {
  const std::string_view body = trimmed(text);
  double number = 0;
  const auto [end, failure] = std::from_chars(body.data(), body.data() + body.size(), number);
  if (failure != std::errc{}) return {0, QuantityFault::NoNumber};
  const auto used = static_cast<std::size_t>(end - body.data());
  const std::string_view symbol = trimmed(body.substr(used));
  if (symbol.empty()) return {0, QuantityFault::NoUnit};
  for (const Unit& unit : units_of(dimension)) {
    if (unit.symbol == symbol) return {number * unit.si, QuantityFault::None};
  }
  return {0, QuantityFault::WrongUnit};
}

std::string print_quantity(double value, Dimension dimension) {
  const std::span<const Unit> units = units_of(dimension);
  for (const Unit& unit : {units.front(), units.back()}) {
    const double scaled = value / unit.si;
    if (scaled * unit.si == value) return shortest(scaled) + " " + std::string(unit.symbol);
  }
  return shortest(value) + " " + std::string(units.back().symbol);
}

std::string print_number(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace palpate::app
