// SPDX-License-Identifier: Apache-2.0
#include "python/errors.hpp"

#include <fstream>

#include "format/regular_file.hpp"
#include "runtime/palpate.h"

namespace py = pybind11;

namespace palpate::python {
namespace {

py::object error_class(const char* type) {
  return py::module_::import("palpate._errors").attr(type);
}

const char* class_of_status(int status) {
  switch (status) {
    case PALPATE_ERROR_ARGUMENT:
      return "ArgumentError";
    case PALPATE_ERROR_FILE:
      return "FileError";
    case PALPATE_ERROR_FORMAT:
      return "FormatError";
    case PALPATE_ERROR_MISMATCH:
      return "MismatchError";
    default:
      return "Error";
  }
}

}  // namespace

void raise(const char* type, const std::string& message) {
  PyErr_SetObject(error_class(type).ptr(), py::str(message).ptr());
  throw py::error_already_set();
}

void raise(const char* type, const Error& error) {
  const py::object what = error_class(type)(error.what());
  what.attr("where") = error.where();
  what.attr("problem") = error.problem();
  what.attr("remedy") = error.remedy();
  PyErr_SetObject(error_class(type).ptr(), what.ptr());
  throw py::error_already_set();
}

void raise_type_error(const std::string& message) {
  throw py::type_error(message);
}

void check_call(int status) {
  if (status >= 0) return;
  if (status == PALPATE_ERROR_MEMORY) throw std::bad_alloc();
  raise(class_of_status(status), palpate_last_error());
}

void require_file(const std::filesystem::path& path, const std::string& wanted) {
  const std::string kind = other_kind_of_file(path);
  if (!kind.empty()) {
    raise("FileError", Error(ErrorKind::Configuration, path.string(),
                             "is not a regular file but " + kind, "name " + wanted));
  }
  if (!std::ifstream(path, std::ios::binary)) {
    raise("FileError", Error(ErrorKind::Configuration, path.string(), "cannot be opened",
                             "check path and permissions"));
  }
}

}  // namespace palpate::python
