// SPDX-License-Identifier: Apache-2.0
// Values in a JSON text, without allocation.
#pragma once

#include <cstddef>
#include <string_view>

namespace palpate::runtime {

/// A value in a JSON text [RFC 8259]; absent when it was not found or the text before it is not
/// JSON. noexcept, allocation-free, linear in the length of the text, nesting up to 64 levels.
class JsonView {
 public:
  JsonView() = default;  ///< absent
  explicit JsonView(std::string_view text) noexcept;

  explicit operator bool() const noexcept { return !text_.empty(); }
  /// Member of an object. Names are compared as written, without resolving escapes.
  JsonView operator[](std::string_view name) const noexcept;
  JsonView operator[](std::size_t index) const noexcept;  ///< item of an array
  bool number(double& value) const noexcept;  ///< false, value unchanged, if it is not a number
  std::string_view string() const noexcept;   ///< as written; empty if it is not a string

 private:
  std::string_view text_;  ///< exactly this value
};

}  // namespace palpate::runtime
