// SPDX-License-Identifier: Apache-2.0
#include "format/position_text.hpp"

#include <cmath>
#include <cstdio>

namespace palpate {
namespace {

constexpr Unit kMillimetre{"mm", 1e-3};

Unit& unit() {
  static Unit chosen = kMillimetre;
  return chosen;
}

}  // namespace

void print_positions_in(const Unit& chosen) {
  unit() = chosen;
}

Unit unit_of_length(double metres) {
  for (const Unit& known : units_of(Dimension::Length))
    if (std::abs(known.si - metres) <= 1e-9 * known.si) return known;
  return kMillimetre;
}

std::string position_text(const Vec3& x) {
  const double scale = 1 / unit().si;
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) %.*s", scale * x[0], scale * x[1],
                scale * x[2], static_cast<int>(unit().symbol.size()), unit().symbol.data());
  return text;
}

}  // namespace palpate
