// SPDX-License-Identifier: Apache-2.0
// Exceptions of the WebAssembly build, whose C++ library cannot unwind: the host is told the
// message and ends the call by an exception of its own. The instance is not used again.
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <typeinfo>

#include "format/error.hpp"

#pragma clang diagnostic ignored "-Wreserved-identifier"  // the names are those of the ABI
// NOLINTBEGIN(readability-identifier-naming)

/// Provided by the host. Must not return.
extern "C" [[noreturn]] __attribute__((import_module("host"), import_name("fail"))) void host_fail(
    const char* message);

extern "C" {

void* __cxa_allocate_exception(std::size_t size) noexcept {
  void* memory = std::malloc(size);
  if (memory == nullptr) host_fail("out of memory");
  return memory;
}

void __cxa_free_exception(void* exception) noexcept {
  std::free(exception);
}

[[noreturn]] void __cxa_throw(void* exception, std::type_info* type, void (*)(void*)) {
  if (*type == typeid(palpate::Error)) host_fail(static_cast<palpate::Error*>(exception)->what());
  host_fail(type->name());
}

[[noreturn]] void __cxa_rethrow() {
  host_fail("an exception was passed on");
}

}  // extern "C"

// NOLINTEND(readability-identifier-naming)
