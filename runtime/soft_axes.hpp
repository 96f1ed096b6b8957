// SPDX-License-Identifier: Apache-2.0
// How the lateral response of a contact point differs from one direction to another.
#pragma once

#include "format/vec3.hpp"

namespace palpate::runtime {

/// S = I - B with B = sum n_l (P b_l)(P b_l)^T: b_l the soft axes of the vertices, n_l the natural
/// coordinates, P the projector across the press direction n, theory-runtime (R34). The lateral
/// response is that of p = S q: it is softer along the axes. S is symmetric, S n = n, and as no b_l
/// is longer than kMostSoftAxis, its eigenvalues are between 1/2 and 1. noexcept, allocation-free.
class SoftAxes {
 public:
  /// None: S = I.
  SoftAxes() = default;

  /// Adds n_l (P b_l)(P b_l)^T.
  void add(double natural, const Vec3& across) noexcept {
    const Vec3 v = natural * across;
    x_ = x_ + v[0] * across;
    y_ = y_ + v[1] * across;
    z_ = z_ + v[2] * across;
    any_ = true;
  }
  /// To be called when all are added: S^-1 is then known.
  void finish() noexcept {
    trace_ = x_[0] + y_[1] + z_[2];
    const double squares = dot(x_, x_) + dot(y_, y_) + dot(z_, z_);
    inverse_determinant_ = 1 / (1 - trace_ + 0.5 * (trace_ * trace_ - squares));
  }

  bool any() const noexcept { return any_; }
  /// S v, of v across n.
  Vec3 stretch(const Vec3& v) const noexcept { return any_ ? v - softened(v) : v; }
  /// S^-1 v, of v across n: that of a symmetric tensor of the plane, (tr S - S)/det S.
  Vec3 restore(const Vec3& v) const noexcept {
    return any_ ? inverse_determinant_ * ((1 - trace_) * v + softened(v)) : v;
  }

 private:
  Vec3 softened(const Vec3& v) const noexcept { return {dot(x_, v), dot(y_, v), dot(z_, v)}; }

  Vec3 x_{}, y_{}, z_{};  ///< rows of B
  double trace_ = 0;      ///< of B
  double inverse_determinant_ = 1;
  bool any_ = false;
};

}  // namespace palpate::runtime
