// SPDX-License-Identifier: Apache-2.0
// One stored response made ready for the force loop: force, slope, energy at a deflection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/library.hpp"

namespace palpate::runtime {

/// Value of a response at one deflection.
struct CurveValue {
  double force = 0;   ///< f(d), N
  double slope = 0;   ///< f'(d), N/m
  double energy = 0;  ///< integral of f from 0 to d, J
};

/// A ResponseCurve with its cumulative force and energy at every knot, in double precision.
/// With x = d - d_k on piece k and c_k = (s_{k+1} - s_k) / (2 (d_{k+1} - d_k)):
///   f' = s_k + 2 c_k x,   f = f_k + s_k x + c_k x^2,   E = E_k + f_k x + s_k x^2/2 + c_k x^3/3.
/// For d <= 0 there is no contact: force, slope and energy are 0. (A lateral response is evaluated
/// at rho >= 0 only, so that this is its odd continuation as well; its slope at 0 is asked with
/// slope_at_rest.) Beyond the last knot c = 0: linear, with the last slope, hence never steeper
/// than max_slope(). Immutable after construction; evaluation is noexcept, allocation-free, and
/// takes O(log K). Any thread may evaluate.
class CompiledCurve {
 public:
  /// One polynomial piece, starting at `start`; the last one has no end.
  struct Piece {
    double start = 0;      ///< d_k, m
    double force = 0;      ///< f_k, N
    double slope = 0;      ///< s_k, N/m
    double curvature = 0;  ///< c_k, N/m^2
    double energy = 0;     ///< E_k, J
  };

  CompiledCurve() = default;  ///< the zero response

  /// @throws Error(Configuration) for fewer than two knots, knots that do not increase from 0,
  /// slopes
  ///   negative or not finite, unequal lengths.
  explicit CompiledCurve(const ResponseCurve& curve);
  /// The same with the value `start` at 0 instead of 0: w of a coupled response. "Force" is then w,
  /// "slope" w', and the energy means nothing.
  CompiledCurve(const ResponseCurve& curve, double start);

  CurveValue evaluate(double d) const noexcept;
  double force(double d) const noexcept { return evaluate(d).force; }
  double slope(double d) const noexcept { return evaluate(d).slope; }
  double energy(double d) const noexcept { return evaluate(d).energy; }

  double slope_at_rest() const noexcept { return pieces_.empty() ? 0.0 : pieces_.front().slope; }
  /// Largest slope over all d, exactly: the slope is piecewise linear. N/m
  double max_slope() const noexcept { return max_slope_; }
  /// Deepest knot, m: beyond it the response is a continuation.
  double last_knot() const noexcept { return pieces_.empty() ? 0.0 : pieces_.back().start; }
  /// Every piece in ascending order, the linear continuation last. Empty for the zero response.
  const std::vector<Piece>& pieces() const noexcept { return pieces_; }

 private:
  std::vector<Piece> pieces_;
  double max_slope_ = 0;
};

/// A piece as the force loop reads it, two to a cache line. Start and slope are the stored numbers.
struct alignas(32) PackedPiece {
  float start = 0;       ///< d_k, m
  float slope = 0;       ///< s_k, N/m
  double curvature = 0;  ///< c_k, N/m^2
  double force = 0;      ///< f_k, N
  double energy = 0;     ///< E_k, J
};

/// View of a curve in a row of packed pieces: the same response as the CompiledCurve that was
/// packed, to the last bit. Valid while the row lives; cheap to copy; evaluation as there. Inline:
/// a step evaluates a dozen of them.
class CurveView {
 public:
  CurveView() = default;  ///< the zero response
  CurveView(const PackedPiece* pieces, std::size_t count) noexcept
      : pieces_(pieces), count_(count) {}

  CurveValue evaluate(double d) const noexcept {
    if (count_ == 0 || !(d > 0.0)) return {};
    const PackedPiece& p = pieces_[piece_at(d)];
    const double x = d - static_cast<double>(p.start);
    const double slope = static_cast<double>(p.slope);
    return {p.force + x * (slope + x * p.curvature), slope + 2.0 * x * p.curvature,
            p.energy + x * (p.force + x * (slope / 2.0 + x * p.curvature / 3.0))};
  }

  /// Of a curve that does not start at 0: at d <= 0 its first value, flat.
  CurveValue evaluate_from_start(double d) const noexcept {
    if (count_ == 0 || d > 0.0) return evaluate(d);
    return {pieces_[0].force, 0, 0};
  }

  const PackedPiece& piece(std::size_t k) const noexcept { return pieces_[k]; }
  std::size_t size() const noexcept { return count_; }
  double start(std::size_t k) const noexcept { return static_cast<double>(pieces_[k].start); }
  double last_knot() const noexcept { return count_ == 0 ? 0.0 : start(count_ - 1); }

  /// Index of the piece that holds d; 0 for d <= 0 and for the zero response.
  std::size_t piece_at(double d) const noexcept {
    std::size_t k = 0;
    for (std::size_t left = count_; left > 1;) {  // a search without branches to mispredict
      const std::size_t half = left / 2;
      k += start(k + half) <= d ? half : 0;
      left -= half;
    }
    return k;
  }

 private:
  const PackedPiece* pieces_ = nullptr;
  std::size_t count_ = 0;
};

/// The responses of a node, side by side in memory: f^z, then f^r, then w when they are coupled.
class NodeCurves {
 public:
  NodeCurves() = default;
  NodeCurves(const PackedPiece* pieces, std::uint16_t normal, std::uint16_t lateral,
             std::uint16_t coupling = 0) noexcept
      : pieces_(pieces), normal_(normal), lateral_(lateral), coupling_(coupling) {}

  CurveView normal() const noexcept { return {pieces_, normal_}; }              ///< f^z
  CurveView lateral() const noexcept { return {pieces_ + normal_, lateral_}; }  ///< f^r
  CurveView coupling() const noexcept {                                         ///< w
    return {pieces_ + normal_ + lateral_, coupling_};
  }
  bool coupled() const noexcept { return coupling_ > 0; }
  /// Asks the processor to have the curves at hand soon.
  void prefetch() const noexcept;

 private:
  const PackedPiece* pieces_ = nullptr;
  std::uint16_t normal_ = 0, lateral_ = 0, coupling_ = 0;
};

/// A piece of a CompiledCurve, packed.
PackedPiece pack(const CompiledCurve::Piece& piece) noexcept;

}  // namespace palpate::runtime
