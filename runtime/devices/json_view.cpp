// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/json_view.hpp"

#include <charconv>

namespace palpate::runtime {
namespace {

constexpr int kDeepest = 64;
constexpr std::string_view kSpace = " \t\r\n";

/// Reads forward in a text; `ok` becomes false where it is not JSON.
struct Cursor {
  std::string_view rest;
  bool ok = true;

  void skip_space() noexcept {
    const std::size_t at = rest.find_first_not_of(kSpace);
    rest.remove_prefix(at == std::string_view::npos ? rest.size() : at);
  }
  bool take(char c) noexcept {
    skip_space();
    if (rest.empty() || rest.front() != c) return false;
    rest.remove_prefix(1);
    return true;
  }

  std::string_view take_string() noexcept {
    if (!take('"')) return fail();
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (rest[i] == '\\') {
        ++i;
      } else if (rest[i] == '"') {
        const std::string_view inside = rest.substr(0, i);
        rest.remove_prefix(i + 1);
        return inside;
      }
    }
    return fail();
  }

  /// Skips a value and returns it.
  std::string_view take_value(int depth = 0) noexcept {
    skip_space();
    const std::string_view from = rest;
    if (rest.empty() || depth > kDeepest) return fail();
    if (rest.front() == '{' || rest.front() == '[') {
      skip_container(rest.front() == '{', depth);
    } else if (rest.front() == '"') {
      take_string();
    } else {
      const std::size_t end = rest.find_first_of(",]} \t\r\n");
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end);
    }
    return ok ? from.substr(0, from.size() - rest.size()) : std::string_view{};
  }

  void skip_container(bool object, int depth) noexcept {
    const char end = object ? '}' : ']';
    rest.remove_prefix(1);
    if (take(end)) return;
    do {
      if (object) {
        take_string();
        ok = ok && take(':');
      }
      take_value(depth + 1);
    } while (ok && take(','));
    ok = ok && take(end);
  }

  std::string_view fail() noexcept {
    ok = false;
    return {};
  }
};

}  // namespace

JsonView::JsonView(std::string_view text) noexcept {
  Cursor cursor{text};
  const std::string_view value = cursor.take_value();
  if (cursor.ok) text_ = value;
}

JsonView JsonView::operator[](std::string_view name) const noexcept {
  Cursor cursor{text_};
  if (!cursor.take('{') || cursor.take('}')) return {};
  do {
    const std::string_view key = cursor.take_string();
    if (!cursor.ok || !cursor.take(':')) return {};
    const std::string_view value = cursor.take_value();
    if (!cursor.ok) return {};
    if (key == name) return JsonView(value);
  } while (cursor.take(','));
  return {};
}

JsonView JsonView::operator[](std::size_t index) const noexcept {
  Cursor cursor{text_};
  if (!cursor.take('[') || cursor.take(']')) return {};
  for (std::size_t i = 0;; ++i) {
    const std::string_view value = cursor.take_value();
    if (!cursor.ok) return {};
    if (i == index) return JsonView(value);
    if (!cursor.take(',')) return {};
  }
}

bool JsonView::number(double& value) const noexcept {
  double parsed = 0;
  const char* end = text_.data() + text_.size();
  const auto [stop, error] = std::from_chars(text_.data(), end, parsed);
  if (text_.empty() || error != std::errc() || stop != end) return false;
  value = parsed;
  return true;
}

std::string_view JsonView::string() const noexcept {
  if (text_.size() < 2 || text_.front() != '"') return {};
  return text_.substr(1, text_.size() - 2);
}

}  // namespace palpate::runtime
