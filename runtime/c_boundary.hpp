// SPDX-License-Identifier: Apache-2.0
// Messages and exceptions at the boundary of the C interface.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>

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

}  // namespace palpate::runtime
