// SPDX-License-Identifier: AGPL-3.0-or-later
// The few shapes of the pictures of an experiment, as text of an SVG file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace palpate::app::svg {

inline std::string line(double x1, double y1, double x2, double y2, std::string_view colour,
                        std::string_view more = "") {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"{}/>)", x1,
                     y1, x2, y2, colour, more);
}

/// Text centred at (x, y).
inline std::string label(double x, double y, const std::string& text, std::string_view more = "") {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle"{}>{}</text>)", x, y, more,
                     text);
}

inline std::string rectangle(double x1, double y1, double x2, double y2, std::string_view more) {
  return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" {}/>)", x1, y1,
                     x2 - x1, y2 - y1, more);
}

/// A picture of width x height units that contains `shapes`.
inline std::string picture(double width, double height, const std::string& shapes) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n{}\n{}\n</svg>\n",
      width, height, rectangle(0, 0, width, height, R"(fill="#fff")"), shapes);
}

}  // namespace palpate::app::svg
