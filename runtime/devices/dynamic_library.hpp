// SPDX-License-Identifier: Apache-2.0
// A vendor's library, loaded when it is needed.
#pragma once

#include <string>
#include <vector>

namespace palpate::runtime {

/// A shared library opened at run time; closed with the object. Not for the force loop.
class DynamicLibrary {
 public:
  /// Opens the first of `names` that the system finds. `what`: the owner of the library; `remedy`:
  /// how to get it. @throws Error(Configuration).
  DynamicLibrary(const std::vector<std::string>& names, std::string what, std::string remedy);
  ~DynamicLibrary();
  DynamicLibrary(const DynamicLibrary&) = delete;
  DynamicLibrary& operator=(const DynamicLibrary&) = delete;

  /// Finds a function by its name. @throws Error(Configuration) when the library does not have it.
  template <class Function>
  void bind(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(address(name));
  }

 private:
  void* address(const char* name) const;

  std::string what_, remedy_, file_;
  void* handle_ = nullptr;
};

}  // namespace palpate::runtime
