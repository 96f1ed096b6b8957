// SPDX-License-Identifier: Apache-2.0
// Looking up values in a JSON text without building anything.
#pragma once

#include <cstddef>
#include <string_view>

namespace palpate::runtime {

/// A value somewhere in a JSON text [RFC 8259]; absent when it was not found or the text is not
/// JSON up to it. noexcept, allocation-free, linear in the text, nesting up to 64 deep.
class JsonView {
 public:
  JsonView() = default;  ///< absent
  explicit JsonView(std::string_view text) noexcept;

  explicit operator bool() const noexcept { return !text_.empty(); }
  /// Member of an object. Names are compared as written, without resolving escapes.
  JsonView operator[](std::string_view name) const noexcept;
  JsonView operator[](std::size_t index) const noexcept;  ///< item of an array
  bool number(double& value) const noexcept;              ///< false and untouched if it is none
  std::string_view string() const noexcept;               ///< as written; empty if it is none

 private:
  std::string_view text_;  ///< exactly this value
};

}  // namespace palpate::runtime
