// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/toml_string.hpp"

namespace palpate::app {

std::string toml_string(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      out += '\\';
      out += letter;
    } else if (code < 0x20 || code == 0x7f) {
      out += "\\u00";
      out += digits[code >> 4U];
      out += digits[code & 0xfU];
    } else {
      out += letter;
    }
  }
  out += '"';
  return out;
}

}  // namespace palpate::app
