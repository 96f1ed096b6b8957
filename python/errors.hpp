// SPDX-License-Identifier: Apache-2.0
// Failures of palpate as exceptions of Python, which palpate/_errors.py defines.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "format/error.hpp"

namespace palpate::python {

/// Throws the exception of this name of palpate/_errors.py. Needs the GIL.
[[noreturn]] void raise(const char* type, const std::string& message);
/// The same with where, problem and remedy apart.
[[noreturn]] void raise(const char* type, const Error& error);
/// Throws TypeError. Needs the GIL.
[[noreturn]] void raise_type_error(const std::string& message);

/// Throws the exception of a failed call of the C interface, with its message; returns where it did
/// not fail. Needs the GIL.
void check_call(int status);

/// Throws FileError unless the path names a regular file that can be opened; `wanted`: "a library".
/// Needs the GIL.
void require_file(const std::filesystem::path& path, const std::string& wanted);

/// What a reader of the formats makes of a file, without the GIL. Throws FileError or FormatError.
template <class Read>
auto read_file(const std::filesystem::path& path, const std::string& wanted, Read&& read) {
  require_file(path, wanted);
  try {
    const pybind11::gil_scoped_release released;
    return std::forward<Read>(read)(path);
  } catch (const Error& error) {
    raise("FormatError", error);
  }
}

}  // namespace palpate::python
