// SPDX-License-Identifier: Apache-2.0
// One stored response made ready for the force loop: force, slope, energy at a deflection.
#pragma once

#include <array>
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
/// at rho >= 0 only, so this is also its odd continuation; its slope at 0 is slope_at_rest.) Beyond
/// the last knot c = 0: linear, with the last slope, hence never steeper than max_slope().
/// Immutable after construction; evaluation is noexcept, allocation-free, and takes O(log K). Any
/// thread may evaluate.
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
  /// w(z) of a curve that starts at another value than 0, which it has at z <= 0 as well: a contact
  /// that only touches already holds. @pre not the zero response
  double weight(double z) const noexcept { return z > 0 ? force(z) : pieces_.front().force; }

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

inline constexpr double kThird = 1.0 / 3.0;  ///< a product takes less time than a quotient

/// A piece as the force loop reads it, two in a cache line. Start and slope are the stored numbers.
struct alignas(32) PackedPiece {
  float start = 0;       ///< d_k, m
  float slope = 0;       ///< s_k, N/m
  double curvature = 0;  ///< c_k, N/m^2
  double force = 0;      ///< f_k, N
  double energy = 0;     ///< E_k, J

  CurveValue evaluate(double d) const noexcept {
    const double x = d - static_cast<double>(start);
    const double s = static_cast<double>(slope);
    return {force + x * (s + x * curvature), s + 2.0 * x * curvature,
            energy + x * (force + x * (s / 2.0 + x * (curvature * kThird)))};
  }
};

/// View of a packed curve, its knots beside its pieces: the same response as the CompiledCurve that
/// was packed, to the last bit. Valid while the memory lives; cheap to copy; evaluation as there.
/// Inline: a step evaluates a dozen of them.
class CurveView {
 public:
  CurveView() = default;  ///< the zero response
  CurveView(const float* knots, const PackedPiece* pieces, std::size_t count) noexcept
      : knots_(knots), pieces_(pieces), count_(count) {}

  CurveValue evaluate(double d) const noexcept {
    if (count_ == 0 || !(d > 0.0)) return {};
    return pieces_[piece_at(d)].evaluate(d);
  }

  /// For a curve that does not start at 0: its first value at d <= 0, with slope 0.
  CurveValue evaluate_from_start(double d) const noexcept {
    if (count_ == 0 || d > 0.0) return evaluate(d);
    return {pieces_[0].force, 0, 0};
  }

  const PackedPiece& piece(std::size_t k) const noexcept { return pieces_[k]; }
  std::size_t size() const noexcept { return count_; }
  double start(std::size_t k) const noexcept { return static_cast<double>(knots_[k]); }
  double last_knot() const noexcept { return count_ == 0 ? 0.0 : start(count_ - 1); }

  /// Index of the piece that contains d; 0 for d <= 0 and for the zero response.
  std::size_t piece_at(double d) const noexcept {
    std::size_t k = 0;
    for (std::size_t left = count_; left > 1;) {  // without branches that could be mispredicted
      const std::size_t half = left / 2;
      k += start(k + half) <= d ? half : 0;
      left -= half;
    }
    return k;
  }

 private:
  const float* knots_ = nullptr;
  const PackedPiece* pieces_ = nullptr;
  std::size_t count_ = 0;
};

inline constexpr std::size_t kCacheLine = 64;  ///< bytes that the processor fetches at once

/// Unit of the memory of a surface.
struct alignas(kCacheLine) CacheLine {
  std::array<std::byte, kCacheLine> bytes{};
};

/// Numbers of pieces of the responses of a node.
struct CurveSizes {
  std::uint16_t normal = 0, lateral = 0, coupling = 0;
  std::size_t sum() const noexcept { return std::size_t{normal} + lateral + coupling; }
};

/// The responses of a node, side by side in memory: f^z, then f^r, then w when they are coupled.
/// First all knots, so that a search reads one cache line instead of one for each comparison; then
/// the pieces.
class NodeCurves {
 public:
  NodeCurves() = default;
  /// A view of curves that write() has written.
  NodeCurves(const CacheLine* memory, CurveSizes sizes) noexcept : memory_(memory), sizes_(sizes) {}

  /// Number of cache lines for curves of these sizes.
  static std::size_t lines(const CurveSizes& sizes) noexcept;
  /// Writes the compiled curves to that many lines.
  static NodeCurves write(CacheLine* memory, const CompiledCurve& normal,
                          const CompiledCurve& lateral,
                          const CompiledCurve& coupling = {}) noexcept;

  CurveView normal() const noexcept { return view(0, sizes_.normal); }                ///< f^z
  CurveView lateral() const noexcept { return view(sizes_.normal, sizes_.lateral); }  ///< f^r
  CurveView coupling() const noexcept {                                               ///< w
    return view(std::size_t{sizes_.normal} + sizes_.lateral, sizes_.coupling);
  }
  bool coupled() const noexcept { return sizes_.coupling > 0; }

  /// Number of lines of the knots, and the lines of the pieces at a deflection, counted from the
  /// first; 0 for w of decoupled responses.
  struct InUse {
    std::size_t knots = 0, normal = 0, lateral = 0, coupling = 0;
  };
  InUse in_use(double depth, double lateral_deflection) const noexcept;

 private:
  static constexpr std::size_t kKnotsALine = kCacheLine / sizeof(float);
  static constexpr std::size_t kPiecesALine = kCacheLine / sizeof(PackedPiece);
  static std::size_t knot_lines(const CurveSizes& sizes) noexcept {
    return (sizes.sum() + kKnotsALine - 1) / kKnotsALine;
  }
  CurveView view(std::size_t first, std::size_t count) const noexcept {
    const auto* knots = reinterpret_cast<const float*>(memory_);
    const auto* pieces = reinterpret_cast<const PackedPiece*>(memory_ + knot_lines(sizes_));
    return {knots + first, pieces + first, count};
  }

  const CacheLine* memory_ = nullptr;
  CurveSizes sizes_;
};

/// A piece of a CompiledCurve, packed.
PackedPiece pack(const CompiledCurve::Piece& piece) noexcept;

}  // namespace palpate::runtime
