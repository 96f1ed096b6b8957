// SPDX-License-Identifier: AGPL-3.0-or-later
// The forces of a sphere on a slab, computed once over stiffening and thickness.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "fem/specimen/slab.hpp"

namespace palpate::app {

/// A law with one stress and one number, which says how it stiffens.
struct StiffeningLaw {
  std::string name;          ///< of the law in the table of laws
  std::string stiffening;    ///< "b"; "C20/C10" of yeoh, whose C30 is 0
  double low = 0, high = 0;  ///< of the number, where nothing else is said

  /// The constants at a shear modulus at rest, Pa.
  fem::LawConstants at(double shear_modulus, double stiffening, double poisson) const;
};
/// @throws Error(Configuration) for a law that has no such form, with those that have.
StiffeningLaw stiffening_law(const std::string& name);

struct SlabTableSettings {
  StiffeningLaw law;
  double poisson = 0.49;
  fem::ToolGeometry tool;
  fem::ToolFriction friction = fem::ToolFriction::Frictionless;
  std::vector<double> depths;                    ///< m, ascending
  double thickness_low = 0, thickness_high = 0;  ///< m
  int stiffenings = 5, thicknesses = 6;          ///< presses along each axis
  int threads = 1;
  std::function<void(int done, int all)> advanced;  ///< from one thread at a time; may be empty
};

/// The force is proportional to the shear modulus at rest. Its logarithm, at each depth, is a
/// polynomial in stiffening and inverse thickness through presses at Chebyshev's points.
class SlabTable {
 public:
  /// @throws Error(Configuration) for ranges that are none, a slab that is not thicker than the
  ///   deepest press, a press that ends early.
  explicit SlabTable(const SlabTableSettings& settings);

  /// Forces at the depths of the settings, N per Pa of the shear modulus at rest.
  using Press = std::function<std::vector<double>(double stiffening, double thickness)>;
  /// A table of any other slab.
  SlabTable(const SlabTableSettings& settings, const Press& press);

  struct Force {
    double value = 0;                 ///< N per Pa of the shear modulus at rest
    double by_stiffening = 0;         ///< its derivatives
    double by_inverse_thickness = 0;  ///< by 1/m
  };
  Force at(std::size_t depth, double stiffening, double inverse_thickness) const;

  const SlabTableSettings& settings() const { return settings_; }
  /// The largest error of the interpolation at a press between the points, relative.
  double error() const { return error_; }

 private:
  void check_between_points(const Press& press);

  SlabTableSettings settings_;
  std::vector<double> stiffening_, inverse_thickness_;  ///< points of the table
  std::vector<double> log_force_;                       ///< by stiffening, thickness, depth
  double error_ = 0;
};

}  // namespace palpate::app
