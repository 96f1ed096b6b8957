// SPDX-License-Identifier: AGPL-3.0-or-later
// The isochoric energies behind the names of the table, for the solver and for the calibration.
#pragma once

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "fem/laws/invariant_energies.hpp"
#include "fem/laws/ogden.hpp"

namespace palpate::fem {

/// Ogden's law as the sum of its terms.
template <class C>
struct OgdenEnergy {
  using Scalar = C;
  std::vector<OgdenTerm<C>> terms;
};

/// Whether a law of the table is the sum of an isotropic isochoric energy and a volumetric one, so
/// that it has an incompressible form. The others are Saint Venant-Kirchhoff, which is not split,
/// and the laws with fibres.
inline bool has_isotropic_energy(std::string_view law) {
  return law != "saint-venant-kirchhoff" && law != "holzapfel-gasser-ogden";
}

/// Calls `f` with the energy of a law. The result of `f` must have the same type for all energies.
/// @param law  a law with has_isotropic_energy().
/// @param c    its constants in the order of the table, Poisson's ratio included; SI.
template <class C, class F>
auto with_energy(std::string_view law, std::span<const C> c, F&& f) {
  if (law == "mooney-rivlin") return f(MooneyRivlinEnergy<C>{c[0], c[1]});
  if (law == "mooney-rivlin-5") return f(MooneyRivlin5Energy<C>{c[0], c[1], c[2], c[3], c[4]});
  if (law == "yeoh") return f(YeohEnergy<C>{c[0], c[1], c[2]});
  if (law == "demiray-fung") return f(DemirayFungEnergy<C>{c[0], c[1]});
  if (law == "veronda-westmann") return f(VerondaWestmannEnergy<C>{c[0], c[1]});
  if (law == "gent") return f(GentEnergy<C>{c[0], c[1]});
  if (law == "arruda-boyce") return f(ArrudaBoyceEnergy<C>{c[0], c[1]});
  if (law.starts_with("ogden")) {
    OgdenEnergy<C> energy;
    for (std::size_t i = 0; i + 1 < c.size(); i += 2) energy.terms.push_back({c[i], c[i + 1]});
    return f(energy);
  }
  return f(NeoHookeanEnergy<C>{c[0] / (2.0 * (1.0 + c[1]))});
}

/// Principal Kirchhoff stresses of an isochoric deformation, up to a pressure that is the same in
/// all three directions: tau_i = 2 W1 l_i^2 - 2 W2/l_i^2, l_i = exp(e_i) [Ogden 1984, sec. 4.3].
/// @param strain  principal logarithmic strains e_i; their sum is zero.
template <class Energy>
PrincipalStresses<typename Energy::Scalar> incompressible_stresses(
    const Energy& energy, const std::array<double, 3>& strain) {
  using C = typename Energy::Scalar;
  std::array<double, 3> l2{}, over{};
  for (std::size_t i = 0; i < 3; ++i) {
    l2[i] = std::exp(2 * strain[i]);
    over[i] = 1 / l2[i];
  }
  const C x(l2[0] + l2[1] + l2[2] - 3), y(over[0] + over[1] + over[2] - 3);
  const InvariantSlopes<C> W = energy.slopes(x, y);
  PrincipalStresses<C> s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.tau[i] = W.W1 * (2 * l2[i]) - W.W2 * (2 * over[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      s.slope[i][j] = W.W11 * (4 * l2[i] * l2[j]) + W.W22 * (4 * over[i] * over[j]) -
                      W.W12 * (4 * (l2[i] * over[j] + over[i] * l2[j]));
    }
    s.slope[i][i] += W.W1 * (4 * l2[i]) + W.W2 * (4 * over[i]);
  }
  return s;
}
template <class C>
PrincipalStresses<C> incompressible_stresses(const OgdenEnergy<C>& energy,
                                             const std::array<double, 3>& strain) {
  return principal_stresses(energy.terms,
                            std::array<C, 3>{C(strain[0]), C(strain[1]), C(strain[2])});
}

}  // namespace palpate::fem
