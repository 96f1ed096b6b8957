// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/relaxation.hpp"

#include <sstream>

#include "format/error.hpp"

namespace palpate::fem {

namespace {

void require_isochoric_part(const LawConstants& law, const std::string& where) {
  if (has_isochoric_part(law.law)) return;
  refuse(where, "the law " + law.law + " has no isochoric part that could relax",
         "remove relaxation, or choose another law");
}

}  // namespace

bool has_isochoric_part(std::string_view law) {
  return law != "saint-venant-kirchhoff";
}

LawConstants with_isochoric_scaled(const LawConstants& law, double factor,
                                   const std::string& where) {
  require_isochoric_part(law, where);
  const RestModuli rest = rest_moduli(law);
  const double K = rest.kappa(), mu = factor * rest.mu();
  const double poisson = (3 * K - 2 * mu) / (6 * K + 2 * mu);
  if (!(poisson >= 0)) {
    std::ostringstream problem;
    problem << "the shear modulus " << mu << " Pa over the bulk modulus " << K
            << " Pa makes Poisson's ratio " << poisson;
    refuse(where, problem.str(), "give a larger poisson, or smaller fractions of relaxation");
  }
  LawConstants scaled = law;
  for (auto& [name, value] : scaled.values)
    if (law_constant(law.law, name).is_stress) value *= factor;
  scaled.at("poisson") = poisson;
  // Young's modulus is no isochoric constant: E = 2 (1 + nu) mu.
  if (law.law == "neo-hookean") scaled.at("young") = 2 * (1 + poisson) * mu;
  return scaled;
}

LawConstants instantaneous_law(const LawConstants& law, const RelaxationSeries& series,
                               Moduli moduli, const std::string& where) {
  if (series.empty()) return law;
  check_relaxation(series, where);
  require_isochoric_part(law, where);
  if (moduli == Moduli::Instantaneous) return law;
  return with_isochoric_scaled(law, 1 / long_term_fraction(series), where);
}

}  // namespace palpate::fem
