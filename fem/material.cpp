// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/material.hpp"

#include <sstream>

#include "format/error.hpp"

namespace palpate::fem {

namespace {

void require(bool valid, const std::string& where, const char* name, double value,
             const char* range) {
  if (valid) return;
  std::ostringstream problem;
  problem << name << " = " << value << " is out of range";
  throw Error(ErrorKind::Configuration, where, problem.str(),
              std::string("give a finite ") + name + " with " + range);
}

}  // namespace

NeoHookean NeoHookean::from_young_poisson(double young, double poisson, const std::string& where) {
  require(std::isfinite(young) && young > 0, where, "young (E, Pa)", young, "E > 0");
  require(std::isfinite(poisson) && poisson >= 0 && poisson < 0.5, where, "poisson (nu)", poisson,
          "0 <= nu < 0.5");
  return {young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))};
}

}  // namespace palpate::fem
