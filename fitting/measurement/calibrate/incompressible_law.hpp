// SPDX-License-Identifier: AGPL-3.0-or-later
// The laws of fem/laws that tests in homogeneous deformations can calibrate, in their
// incompressible form. Names, constants and energies are those of the table of laws.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fem/laws/law_table.hpp"
#include "fitting/measurement/calibrate/homogeneous.hpp"

namespace palpate::calibrate {

/// Poisson's ratio of the case that receives the constants, unless another one is given. The tests
/// are evaluated as incompressible, but for confined compression; the ratio is not fitted.
inline constexpr double kCasePoisson = 0.49;

/// Names of the laws that can be calibrated, in the order of the table: all but
/// "saint-venant-kirchhoff" and "holzapfel-gasser-ogden".
std::vector<std::string_view> homogeneous_laws();

/// A law with functions of its constants. The constants are those of the table, in its order,
/// without Poisson's ratio. Every method may be called from several threads.
class IncompressibleLaw {
 public:
  /// @param poisson  Poisson's ratio of the case; Young's modulus of "neo-hookean" and the stress
  ///   of confined compression refer to it.
  /// @throws Error(Configuration) for an unknown law, and for one that homogeneous tests cannot
  ///   calibrate, with the reason.
  explicit IncompressibleLaw(std::string_view law, double poisson = kCasePoisson);

  std::string_view name() const { return entry_->name; }
  double poisson() const { return poisson_; }
  /// The constants that are fitted.
  std::vector<fem::LawConstant> constants() const;

  /// Nominal stress at the deformation s, Pa. Its derivatives by the constants go to `slope`, one
  /// each, unless it is null. NaN where the law has no value.
  double stress(const double* c, Mode mode, double s, double* slope = nullptr) const;

  /// Smaller eigenvalue of the Hessian of W by the logarithmic strains (e1, e2), e3 = -e1 - e2, Pa:
  /// the law resists every small further deformation where it is positive [Drucker 1957; as a test
  /// of fitted rubber laws, Ogden 1972].
  double least_tangent(const double* c, const std::array<double, 3>& strain) const;

  /// The law as a case declares it: the constants and Poisson's ratio.
  fem::LawConstants for_case(const std::vector<double>& c) const;

 private:
  const fem::LawEntry* entry_;
  double poisson_;
};

/// Nominal stress of a law at given constants, Pa.
double law_stress(std::string_view law, const std::vector<double>& constants, Mode mode, double s);

/// Smaller eigenvalue of the tangent, Pa; see IncompressibleLaw::least_tangent.
double law_tangent(std::string_view law, const std::vector<double>& constants, Mode mode, double s);

}  // namespace palpate::calibrate
