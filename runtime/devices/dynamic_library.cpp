// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/dynamic_library.hpp"

#include <dlfcn.h>

#include <utility>

#include "format/error.hpp"

namespace palpate::runtime {

DynamicLibrary::DynamicLibrary(const std::vector<std::string>& names, std::string what,
                               std::string remedy)
    : what_(std::move(what)), remedy_(std::move(remedy)) {
  std::string tried;
  for (const std::string& name : names) {
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      file_ = name;
      return;
    }
    const char* reason = dlerror();
    tried += (tried.empty() ? "" : ", ") + (reason != nullptr ? std::string(reason) : name);
  }
  throw Error(ErrorKind::Configuration, what_, "its library cannot be loaded (" + tried + ")",
              remedy_);
}

DynamicLibrary::~DynamicLibrary() {
  dlclose(handle_);
}

void* DynamicLibrary::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (found == nullptr) {
    throw Error(ErrorKind::Configuration, what_,
                file_ + " has no function " + name + "; it is another version", remedy_);
  }
  return found;
}

}  // namespace palpate::runtime
