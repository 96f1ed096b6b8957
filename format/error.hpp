// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace palpate {

/// What a failure means to the caller of the command; the values are its exit codes.
enum class ErrorKind {
  Internal = 1,       ///< a defect of palpate or of the machine (disk full, out of memory)
  Configuration = 2,  ///< usage, case file, constants, artifacts that do not fit together
  Geometry = 3        ///< a surface or body that cannot be used as it is
};

/// The one exception of the offline side. It says what is wrong, where, and what to do about it;
/// `what()` joins the three in one line: "<where>: <problem>; <remedy>".
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

}  // namespace palpate
