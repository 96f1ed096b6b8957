// SPDX-License-Identifier: AGPL-3.0-or-later
// Laws whose isochoric stress relaxes: their constants at once and in the long term.
#pragma once

#include <string>

#include "fem/laws/law_table.hpp"
#include "format/relaxation.hpp"

namespace palpate::fem {

/// The state of a relaxing material that the constants of its law describe.
enum class Moduli {
  Instantaneous,  ///< at once after a step of strain
  LongTerm        ///< after it, when everything has relaxed
};

/// Whether the law is the sum of an isochoric and a volumetric energy, so that one of them can
/// relax alone.
bool has_isochoric_part(std::string_view law);

/// The law with its isochoric energy times `factor` and the volumetric one as it is. Every stress
/// among the constants is multiplied, for Psi_iso is homogeneous of degree one in them; the bulk
/// modulus K stays, so that Poisson's ratio becomes nu = (3 K - 2 mu)/(6 K + 2 mu) with the new
/// shear modulus mu.
/// @throws Error(Configuration), named after `where`, for a law without an isochoric part, and
/// where nu would be negative.
LawConstants with_isochoric_scaled(const LawConstants& law, double factor,
                                   const std::string& where);

/// The instantaneous law: that with mu_0 = mu_inf/(1 - sum of g_i) where `moduli` are those of the
/// long term, and `law` itself where they are instantaneous or the series is empty.
/// @throws Error(Configuration) as check_relaxation and with_isochoric_scaled.
LawConstants instantaneous_law(const LawConstants& law, const RelaxationSeries& series,
                               Moduli moduli, const std::string& where);

}  // namespace palpate::fem
