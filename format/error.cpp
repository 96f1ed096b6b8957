// SPDX-License-Identifier: Apache-2.0
#include "format/error.hpp"

#include <utility>

namespace palpate {

Error::Error(ErrorKind kind, std::string where, std::string problem, std::string remedy)
    : std::runtime_error(where + ": " + problem + "; " + remedy),
      kind_(kind),
      where_(std::move(where)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

void refuse(std::string where, std::string problem, std::string remedy) {
  throw Error(ErrorKind::Configuration, std::move(where), std::move(problem), std::move(remedy));
}

void refuse_geometry(std::string where, std::string problem, std::string remedy) {
  throw Error(ErrorKind::Geometry, std::move(where), std::move(problem), std::move(remedy));
}

}  // namespace palpate
