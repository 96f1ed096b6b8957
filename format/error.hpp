// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace palpate {

/// Kind of a failure; the values are the exit codes of the command.
enum class ErrorKind {
  Internal = 1,       ///< a defect of palpate or of the machine (disk full, out of memory)
  Configuration = 2,  ///< usage, case file, constants, artifacts that do not fit together
  Geometry = 3        ///< a surface or body that cannot be used as it is
};

/// The exception of palpate. It says where, what is wrong, and what to do about it; `what()` is one
/// line: "<where>: <problem>; <remedy>".
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string where, std::string problem, std::string remedy);

  ErrorKind kind() const noexcept { return kind_; }
  const std::string& where() const noexcept { return where_; }
  const std::string& problem() const noexcept { return problem_; }
  const std::string& remedy() const noexcept { return remedy_; }

 private:
  ErrorKind kind_;
  std::string where_;
  std::string problem_;
  std::string remedy_;
};

/// Throws Error(Configuration).
[[noreturn]] void refuse(std::string where, std::string problem, std::string remedy);
/// Throws Error(Geometry).
[[noreturn]] void refuse_geometry(std::string where, std::string problem, std::string remedy);

}  // namespace palpate
