// SPDX-License-Identifier: AGPL-3.0-or-later
// The part of a displacement field that moves with its contact.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "format/deformation.hpp"
#include "format/vec3.hpp"
#include "runtime/local_displacement.hpp"

namespace palpate::fitting {

/// The skin around one contact, ready to separate many fields into their local part and the rest.
///
/// The local part of a press is P_n(s) n + P_r(s) e_r, of a lateral deflection as in
/// runtime::FromContact: what is symmetric around the contact, and what differs between directions,
/// with profiles that are piecewise linear in the distance s. They are the
/// least-squares profiles of the field, smoothed by a small penalty on their second differences and
/// exact at s = 0 (the depth, or 1 per metre of a lateral deflection), less a smooth field that has
/// the same value at the reach R_c: a translation, a dilation ~ s, a tilt ~ s, a shear ~ s^2, and
/// of each harmonic m of the azimuth the one ~ s^m. So the local part ends at R_c, what is left is
/// smooth at the contact, and a rigid motion has no local part. Immutable.
class LocalPart {
 public:
  /// `knots`: from 0 to the reach, m; must outlive this. `normals`: inward normals of the skin.
  LocalPart(const std::vector<Vec3>& skin, const std::vector<Vec3>& normals,
            const std::vector<double>& knots, const SiteFrame& frame);

  /// Subtracts the local part of a press to `depth` from its field (3 W). @return P_n, then P_r at
  /// the knots.
  std::vector<float> take_press(Eigen::Ref<Eigen::VectorXf> field, double depth) const;

  /// Profiles of lateral deflections at the knots, one after the other.
  struct Lateral {
    std::vector<float> symmetric;    ///< A, then B, then C
    std::vector<float> anisotropic;  ///< runtime::FromContact::anisotropic, tangent by tangent
  };
  /// The same for the fields of lateral deflections along the two tangents, per metre.
  Lateral take_lateral(Eigen::Ref<Eigen::VectorXf> first, Eigen::Ref<Eigen::VectorXf> second) const;

 private:
  struct Near {
    std::size_t vertex;
    runtime::FromContact from;
    runtime::KnotWeights knot;
  };
  Eigen::VectorXd profile(const std::vector<double>& samples, double at_contact) const;
  Eigen::MatrixXd series(const std::vector<double>& samples, const Vec3& t,
                         std::size_t terms) const;
  Eigen::MatrixXd anisotropic(const Eigen::Ref<const Eigen::VectorXf>& field, const Vec3& t) const;
  std::vector<float> take_anisotropic(Eigen::Ref<Eigen::VectorXf> field, const Vec3& t,
                                      Eigen::MatrixXd profiles) const;
  void subtract_symmetric(Eigen::Ref<Eigen::VectorXf> field, const Vec3& t,
                          const Eigen::MatrixXd& profiles) const;
  void end_at_reach(Eigen::Ref<Eigen::VectorXd> profile, double value, int power) const;
  static double value(const Eigen::Ref<const Eigen::VectorXd>& profile, const Near& near);

  const std::vector<double>& knots_;
  Vec3 inward_, first_, second_;
  std::vector<Near> near_;
};

}  // namespace palpate::fitting
