// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/incompressible_law.hpp"

#include <ceres/jet.h>

#include <cmath>
#include <span>

#include "fem/laws/energy_of_law.hpp"
#include "format/error.hpp"

namespace palpate::calibrate {
namespace {

/// The largest number of constants of a law that can be calibrated (ogden-3, Poisson's ratio
/// included).
constexpr int kMostConstants = 7;
using Jet = ceres::Jet<double, kMostConstants>;

constexpr std::string_view kPoissonName = "poisson";

std::string names_of_laws() {
  std::string names;
  for (const std::string_view law : homogeneous_laws())
    names += (names.empty() ? "" : ", ") + std::string(law);
  return names;
}

const fem::LawEntry& checked_entry(std::string_view law) {
  const std::string where = "law '" + std::string(law) + "'";
  for (const fem::LawEntry& entry : fem::law_table()) {
    if (entry.name != law) continue;
    if (fem::has_isotropic_energy(law)) return entry;
    throw Error(ErrorKind::Configuration, where,
                entry.has_fibres
                    ? "homogeneous tests cannot calibrate it: they do not say how its fibres lie"
                    : "homogeneous tests cannot calibrate it: it has no incompressible form",
                "use one of " + names_of_laws());
  }
  throw Error(ErrorKind::Configuration, where, "it is not known", "use one of " + names_of_laws());
}

/// All constants of the table, Poisson's ratio in its place.
template <class C>
std::vector<C> with_poisson(const fem::LawEntry& entry, const std::vector<C>& c, double poisson) {
  std::vector<C> all;
  std::size_t next = 0;
  for (const fem::LawConstant& constant : entry.constants)
    all.push_back(constant.name == kPoissonName ? C(poisson) : c[next++]);
  return all;
}

template <class C>
fem::PrincipalStresses<C> stresses_of(const fem::LawEntry& entry, const std::vector<C>& c,
                                      double poisson, const std::array<double, 3>& strain) {
  const std::vector<C> all = with_poisson(entry, c, poisson);
  return fem::with_energy(entry.name, std::span<const C>(all), [&](const auto& energy) {
    return fem::incompressible_stresses(energy, strain);
  });
}

/// What Poisson's ratio adds to the nominal stress: dU/ds = kappa/2 (s - 1/s), where the volume
/// changes by s.
template <class C>
C volumetric_stress(const fem::LawEntry& entry, const std::vector<C>& c, double poisson, Mode mode,
                    double s) {
  if (mode != Mode::Confined) return C(0);
  const auto slope = stresses_of(entry, c, poisson, {0, 0, 0}).slope;
  const C mu = (slope[0][0] - slope[0][1] - slope[1][0] + slope[1][1]) / 4.0;
  const double bulk_over_shear = 2 * (1 + poisson) / (3 * (1 - 2 * poisson));
  return mu * (0.5 * bulk_over_shear * (s - 1 / s));
}

template <class C>
C stress_of(const fem::LawEntry& entry, const std::vector<C>& c, double poisson, Mode mode,
            double s) {
  const auto tau = stresses_of(entry, c, poisson, logarithmic_strains(mode, s)).tau;
  return nominal_stress(tau, mode, s) + volumetric_stress(entry, c, poisson, mode, s);
}

}  // namespace

std::vector<std::string_view> homogeneous_laws() {
  std::vector<std::string_view> names;
  for (const fem::LawEntry& entry : fem::law_table())
    if (fem::has_isotropic_energy(entry.name)) names.push_back(entry.name);
  return names;
}

IncompressibleLaw::IncompressibleLaw(std::string_view law, double poisson)
    : entry_(&checked_entry(law)), poisson_(poisson) {}

std::vector<fem::LawConstant> IncompressibleLaw::constants() const {
  std::vector<fem::LawConstant> fitted;
  for (const fem::LawConstant& constant : entry_->constants)
    if (constant.name != kPoissonName) fitted.push_back(constant);
  return fitted;
}

double IncompressibleLaw::stress(const double* c, Mode mode, double s, double* slope) const {
  const std::size_t n = entry_->constants.size() - 1;
  if (slope == nullptr) return stress_of(*entry_, std::vector<double>(c, c + n), poisson_, mode, s);
  std::vector<Jet> varied;
  for (std::size_t i = 0; i < n; ++i) varied.emplace_back(c[i], static_cast<int>(i));
  const Jet P = stress_of(*entry_, varied, poisson_, mode, s);
  for (std::size_t i = 0; i < n; ++i) slope[i] = P.v[static_cast<Eigen::Index>(i)];
  return P.a;
}

double IncompressibleLaw::least_tangent(const double* c,
                                        const std::array<double, 3>& strain) const {
  const std::vector<double> values(c, c + entry_->constants.size() - 1);
  const auto s = stresses_of(*entry_, values, poisson_, strain).slope;
  // dW/de_i = tau_i - tau_3 for i = 1, 2, and e_3 falls as e_1 and e_2 grow.
  const auto hessian = [&](std::size_t i, std::size_t j) {
    return s[i][j] - s[2][j] - s[i][2] + s[2][2];
  };
  const double a = hessian(0, 0), b = hessian(0, 1), d = hessian(1, 1);
  return 0.5 * (a + d) - std::sqrt(0.25 * (a - d) * (a - d) + b * b);
}

fem::LawConstants IncompressibleLaw::for_case(const std::vector<double>& c) const {
  fem::LawConstants law(std::string(entry_->name), {});
  const std::vector<double> all = with_poisson(*entry_, c, poisson_);
  for (std::size_t i = 0; i < all.size(); ++i)
    law.values.emplace_back(entry_->constants[i].name, all[i]);
  return law;
}

double law_stress(std::string_view law, const std::vector<double>& constants, Mode mode, double s) {
  return IncompressibleLaw(law).stress(constants.data(), mode, s);
}

double law_tangent(std::string_view law, const std::vector<double>& constants, Mode mode,
                   double s) {
  return IncompressibleLaw(law).least_tangent(constants.data(), logarithmic_strains(mode, s));
}

}  // namespace palpate::calibrate
