// SPDX-License-Identifier: Apache-2.0
// Messages and exceptions at the boundary of the C interface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include "format/vec3.hpp"
#include "runtime/palpate.h"

namespace palpate::runtime {

/// Remembers the message for palpate_last_error of this thread and returns the status.
int fail(int status, const char* text) noexcept;

/// Runs an action that may throw and turns an exception into a status and a message. `status`: for
/// an exception with a message.
template <typename Action>
int guarded(int status, Action action) noexcept {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    return fail(PALPATE_ERROR_MEMORY, "out of memory");
  } catch (const std::exception& e) {
    return fail(status, e.what());
  } catch (...) {
    return fail(status, "unknown failure");
  }
}

inline void copy(const Vec3& from, double to[3]) noexcept {
  std::copy(from.begin(), from.end(), to);
}

/// Copies the fields that both headers know to the caller; fields of a newer header stay untouched.
template <class Struct>
void give(const Struct& whole, Struct* to, std::uint32_t size) noexcept {
  const std::uint32_t known = std::min<std::uint32_t>(size, sizeof(Struct));
  std::memcpy(to, &whole, known);
  to->size = size;
}

/// Copies an array to the caller, who has room for `capacity` rows; `name`: the function, for the
/// message. `rows` null: the handle was.
template <class Row, class Number>
int give_array(const char* name, const std::vector<Row>* rows, Number* to,
               std::size_t capacity) noexcept {
  static_assert(sizeof(Row) % sizeof(Number) == 0);
  char text[160];
  if (rows == nullptr || to == nullptr) {
    std::snprintf(text, sizeof text, "%s: null pointer", name);
    return fail(PALPATE_ERROR_ARGUMENT, text);
  }
  if (capacity < rows->size()) {
    std::snprintf(text, sizeof text, "%s: capacity is %zu, and there are %zu", name, capacity,
                  rows->size());
    return fail(PALPATE_ERROR_ARGUMENT, text);
  }
  if (!rows->empty()) std::memcpy(to, rows->data(), rows->size() * sizeof(Row));
  return PALPATE_OK;
}

}  // namespace palpate::runtime
