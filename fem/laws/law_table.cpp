// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/law_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fem/laws/energy_of_law.hpp"
#include "fem/laws/law.hpp"
#include "fem/laws/require.hpp"
#include "fem/laws/saint_venant_kirchhoff.hpp"
#include "format/error.hpp"
#include "format/numbers.hpp"

namespace palpate::fem {

void require_constant(bool valid, const std::string& where, const std::string& name, double value,
                      const std::string& range) {
  if (valid) return;
  std::ostringstream problem;
  problem << name << " = " << value << " is out of range";
  throw Error(ErrorKind::Configuration, where, problem.str(),
              "give a finite " + name + " with " + range);
}

namespace {

LawConstant positive_stress(std::string_view name, std::string_view about) {
  return {.name = name, .about = about, .is_stress = true, .low = 0};
}
LawConstant any_stress(std::string_view name, std::string_view about) {
  return {.name = name, .about = about, .is_stress = true};
}
LawConstant pure(std::string_view name, std::string_view about, double low, double high) {
  return {.name = name, .about = about, .low = low, .high = high};
}

LawConstant poisson() {
  return {.name = "poisson",
          .about = "Poisson's ratio at small strain; sets the bulk modulus",
          .low = 0,
          .high = 0.5,
          .low_open = false};
}

/// Powers beyond this overflow at stretches that a palpated body sees.
constexpr double kLargestPower = 100;

std::vector<LawConstant> ogden_constants(int terms) {
  constexpr std::array<std::string_view, 3> mu{"mu_1", "mu_2", "mu_3"};
  constexpr std::array<std::string_view, 3> alpha{"alpha_1", "alpha_2", "alpha_3"};
  std::vector<LawConstant> constants;
  for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i) {
    constants.push_back(any_stress(mu[i], "part of the term in the shear modulus; their sum > 0"));
    constants.push_back(pure(alpha[i], "exponent, not 0", -kLargestPower, kLargestPower));
  }
  constants.push_back(poisson());
  return constants;
}

constexpr std::string_view kOgdenFormula =
    "sum of 2 mu_i/alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3)";

/// Polynomials of the invariants or of the principal stretches.
std::vector<LawEntry> polynomial_laws() {
  const LawConstant young = positive_stress("young", "Young's modulus at small strain");
  return {
      {"neo-hookean", "mu/2 (I1 - 3)", "Treloar 1943", false, {young, poisson()}},
      {"mooney-rivlin",
       "C10 (I1 - 3) + C01 (I2 - 3)",
       "Rivlin 1948",
       false,
       {any_stress("C10", "of I1 - 3; C10 + C01 > 0"), any_stress("C01", "of I2 - 3"), poisson()}},
      {"mooney-rivlin-5",
       "C10 (I1 - 3) + C01 (I2 - 3) + C20 (I1 - 3)^2 + C11 (I1 - 3) (I2 - 3) + C02 (I2 - 3)^2",
       "Rivlin & Saunders 1951",
       false,
       {any_stress("C10", "of I1 - 3; C10 + C01 > 0"), any_stress("C01", "of I2 - 3"),
        any_stress("C20", "of (I1 - 3)^2"), any_stress("C11", "of (I1 - 3) (I2 - 3)"),
        any_stress("C02", "of (I2 - 3)^2"), poisson()}},
      {"yeoh",
       "C10 (I1 - 3) + C20 (I1 - 3)^2 + C30 (I1 - 3)^3",
       "Yeoh 1993",
       false,
       {positive_stress("C10", "of I1 - 3: half the shear modulus"),
        any_stress("C20", "of (I1 - 3)^2"), any_stress("C30", "of (I1 - 3)^3"), poisson()}},
      {"ogden-1", kOgdenFormula, "Ogden 1972", false, ogden_constants(1)},
      {"ogden-2", kOgdenFormula, "Ogden 1972", false, ogden_constants(2)},
      {"ogden-3", kOgdenFormula, "Ogden 1972", false, ogden_constants(3)}};
}

/// Isotropic laws that stiffen towards large strains.
std::vector<LawEntry> stiffening_laws() {
  return {{"demiray-fung",
           "mu/(2 b) (exp(b (I1 - 3)) - 1)",
           "Demiray 1972",
           false,
           {positive_stress("mu", "shear modulus at small strain"),
            pure("b", "growth of the stiffness with strain", 0, 1000), poisson()}},
          {"veronda-westmann",
           "C1 (exp(C2 (I1 - 3)) - 1) - C1 C2/2 (I2 - 3)",
           "Veronda & Westmann 1970",
           false,
           {positive_stress("C1", "C1 C2 is the shear modulus at small strain"),
            pure("C2", "growth of the stiffness with strain", 0, 1000), poisson()}},
          {"gent",
           "-mu J_m/2 ln(1 - (I1 - 3)/J_m)",
           "Gent 1996",
           false,
           {positive_stress("mu", "shear modulus at small strain"),
            pure("J_m", "limit of I1 - 3, where the stress grows without bound", 0, kInfinity),
            poisson()}},
          {"arruda-boyce",
           "eight chains, series of five terms",
           "Arruda & Boyce 1993",
           false,
           {positive_stress("mu", "shear modulus at small strain"),
            pure("lambda_m", "locking stretch of the chains", 1, kInfinity), poisson()}}};
}

/// A law without an isochoric part of its own, and one with fibres.
std::vector<LawEntry> other_laws() {
  const LawConstant young = positive_stress("young", "Young's modulus at small strain");
  return {
      {"saint-venant-kirchhoff",
       "lambda/2 (tr E)^2 + mu E:E; for comparison: it locks towards nu = 1/2 and softens under "
       "compression",
       "Ciarlet 1988",
       false,
       {young, poisson()}},
      {"holzapfel-gasser-ogden",
       "c/2 (I1 - 3) + sum over families of k1/(2 k2) (exp(k2 <E>^2) - 1), E = kappa I1 + (1 - 3 "
       "kappa) I4 - 1",
       "Holzapfel, Gasser & Ogden 2000; Gasser, Ogden & Holzapfel 2006",
       true,
       {positive_stress("c", "shear modulus of the matrix"),
        {.name = "k1",
         .about = "stiffness of the fibres",
         .is_stress = true,
         .low = 0,
         .low_open = false},
        pure("k2", "growth of that stiffness with strain", 0, 10000),
        {.name = "kappa",
         .about = "dispersion of the fibres: 0 aligned, 1/3 isotropic",
         .low = 0,
         .high = 1.0 / 3,
         .low_open = false,
         .high_open = false},
        poisson()}}};
}

std::vector<LawEntry> make_table() {
  std::vector<LawEntry> table = polynomial_laws();
  for (const auto& more : {stiffening_laws(), other_laws()})
    table.insert(table.end(), more.begin(), more.end());
  return table;
}

std::string range_of(const LawConstant& c) {
  const bool below = std::isfinite(c.low), above = std::isfinite(c.high);
  std::ostringstream text;
  if (below) text << c.low << (c.low_open ? " < " : " <= ");
  text << c.name;
  if (above) text << (c.high_open ? " < " : " <= ") << c.high;
  return below || above ? text.str() : "any value";
}

template <class List>
auto* find_value(List& values, std::string_view name) {
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; });
  return found == values.end() ? nullptr : &found->second;
}

void check_constants(const LawConstants& given, const LawEntry& entry, const std::string& where) {
  for (const LawConstant& constant : entry.constants) {
    const double* value = find_value(given.values, constant.name);
    if (value == nullptr)
      refuse(where, "the constant " + std::string(constant.name) + " is missing",
             "give " + range_of(constant));
    require_constant(std::isfinite(*value) && constant.holds(*value), where,
                     std::string(constant.name), *value, range_of(constant));
  }
  for (const auto& value : given.values) {
    const bool known = std::any_of(entry.constants.begin(), entry.constants.end(),
                                   [&](const LawConstant& c) { return c.name == value.first; });
    if (!known)
      refuse(where, "the law " + given.law + " has no constant " + value.first, "remove it");
  }
}

/// The constants of a law in the order of the table.
std::vector<double> in_order(const LawConstants& c) {
  std::vector<double> values;
  for (const LawConstant& constant : law_entry(c.law).constants)
    values.push_back(c.at(constant.name));
  return values;
}

double shear_modulus(const LawConstants& c) {
  if (c.law == "mooney-rivlin" || c.law == "mooney-rivlin-5")
    return 2 * (c.at("C10") + c.at("C01"));
  if (c.law == "yeoh") return 2 * c.at("C10");
  if (c.law == "demiray-fung" || c.law == "gent" || c.law == "arruda-boyce") return c.at("mu");
  if (c.law == "veronda-westmann") return c.at("C1") * c.at("C2");
  if (c.law == "holzapfel-gasser-ogden") return c.at("c");
  if (c.law.starts_with("ogden")) {
    double mu = 0;
    for (const auto& [name, value] : c.values)
      if (name.starts_with("mu_")) mu += value;
    return mu;
  }
  return c.at("young") / (2 * (1 + c.at("poisson")));
}

/// Conditions on several constants together.
void check_together(const LawConstants& c, const std::string& where) {
  if (c.law.starts_with("mooney-rivlin"))
    require_constant(c.at("C10") + c.at("C01") > 0, where, "C10 + C01", c.at("C10") + c.at("C01"),
                     "C10 + C01 > 0");
  if (!c.law.starts_with("ogden")) return;
  for (const char term : {'1', '2', '3'}) {
    const std::string alpha = std::string("alpha_") + term;
    if (const double* value = find_value(c.values, alpha))
      require_constant(*value != 0, where, alpha, *value, alpha + " not 0");
  }
  require_constant(shear_modulus(c) > 0, where, "the sum of mu_i", shear_modulus(c), "sum > 0");
}

}  // namespace

std::span<const LawEntry> law_table() {
  static const std::vector<LawEntry> table = make_table();
  return table;
}

const LawEntry& law_entry(std::string_view name) {
  std::string names;
  for (const LawEntry& entry : law_table()) {
    if (entry.name == name) return entry;
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  refuse("law '" + std::string(name) + "'", "it is not known", "use one of " + names);
}

const LawConstant& law_constant(std::string_view law, std::string_view name) {
  std::string names;
  for (const LawConstant& constant : law_entry(law).constants) {
    if (constant.name == name) return constant;
    names += (names.empty() ? "" : ", ") + std::string(constant.name);
  }
  refuse("law '" + std::string(law) + "'", "it has no constant " + std::string(name),
         "use one of " + names);
}

LawConstants::LawConstants(double young, double poisson)
    : values{{"young", young}, {"poisson", poisson}} {}

double LawConstants::at(std::string_view name) const {
  if (const double* value = find_value(values, name)) return *value;
  refuse("law '" + law + "'", "it has no constant " + std::string(name) + " here",
         "use a constant of the law");
}
double& LawConstants::at(std::string_view name) {
  if (double* value = find_value(values, name)) return *value;
  refuse("law '" + law + "'", "it has no constant " + std::string(name) + " here",
         "use a constant of the law");
}

RestModuli rest_moduli(const LawConstants& constants) {
  const double nu = constants.at("poisson");
  return {2 * (1 + nu) * shear_modulus(constants), nu};
}

void check_law(const LawConstants& c, const std::string& where) {
  const LawEntry& entry = law_entry(c.law);
  check_constants(c, entry, where);
  check_together(c, where);
  if (entry.has_fibres) c.fibres.check(where);
}

Law make_law(const LawConstants& c, const std::string& where) {
  check_law(c, where);
  return unchecked_law(c);
}

Law unchecked_law(const LawConstants& c) {
  const RestModuli rest = rest_moduli(c);
  const double kappa = rest.kappa();
  if (c.law == "neo-hookean") return NeoHookean::from_moduli(rest.mu(), kappa);
  if (c.law == "saint-venant-kirchhoff")
    return SaintVenantKirchhoff(rest.kappa() - 2.0 / 3.0 * rest.mu(), rest.mu());
  if (c.law == "holzapfel-gasser-ogden")
    return HolzapfelGasserOgden(
        {.c = c.at("c"), .k1 = c.at("k1"), .k2 = c.at("k2"), .dispersion = c.at("kappa")}, c.fibres,
        kappa);
  const std::vector<double> values = in_order(c);
  return with_energy(c.law, std::span<const double>(values), [kappa]<class Energy>(Energy energy) {
    if constexpr (std::is_same_v<Energy, OgdenEnergy<double>>)
      return Law(Ogden(std::move(energy.terms), kappa));
    else
      return Law(InvariantLaw<Energy>(energy, kappa));
  });
}

}  // namespace palpate::fem
