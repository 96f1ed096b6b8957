// SPDX-License-Identifier: Apache-2.0
// The static conservative force field f_i(x) of a fixed contact point.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "format/vec3.hpp"
#include "runtime/contact_place.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/kept_pieces.hpp"
#include "runtime/soft_axes.hpp"
#include "runtime/surface.hpp"
#include "runtime/tissue_memory.hpp"

namespace palpate::runtime {

class Relaxation;

/// The deflection of the tip in the response coordinates at a contact point. depth and lateral are
/// apart: side by side they would be loaded at once, which waits until both are stored.
struct Deflection {
  double depth = 0;      ///< z = geometric - d0, m
  double geometric = 0;  ///< n . (x - c), m: depth of the tip below the surface at rest
  double lateral = 0;    ///< rho = |S q| >= 0, m, q the lateral part minus s and the shear
  Vec3 tangent{};        ///< t = S q/rho, unit; zero when rho = 0
};

/// The pieces of the responses around the tool, from one evaluation to the next; those of responses
/// that relax, and those of all others. Results do not depend on them.
struct ToolPieces {
  PiecesInUse elastic;
  TipPieces relaxing;
};

/// Force and energy of a local model at one tip position.
struct LocalResponse {
  double normal_force = 0;   ///< dE/dz at fixed q, N: g(z)
  double lateral_force = 0;  ///< dE/drho, N; h(rho) of decoupled responses without memory
  double energy = 0;  ///< E = sum n_l (G_l(z) + H_l(rho)), J [Mahvash & Hayward 2005, eq. 32]
  Vec3 force{};       ///< f = g n + h (S t - (S t . sigma) n), of the tool ON the body, N [eq. 28]
  double friction_normal_force = 0;  ///< g(z), or psi g(z), N: friction is limited to mu times it
  RelaxedResponse relaxed{};         ///< for responses that relax only
  double instant_lateral_force = 0;  ///< h(rho) or w h(rho), N, of responses that relax only
};

/// How the contact holds the tissue, of coupled responses: its width is that at a depth, and what
/// has come into contact since holds tissue that was sheared by then.
struct Grip {
  double depth = 0;   ///< z_w >= 0, m: lateral response and lean are those of scale w(z_w)
  Vec3 micro_slip{};  ///< e, m, across n: lateral deflection without force
  double scale = 1;   ///< below 1 only in tissue that relaxes
};

/// From one grip to the next, in tissue that relaxes.
struct GripChange {
  Vec3 wide{};         ///< n_l w_l at the present depth
  double scale = 1;    ///< of all weights, where the contact shrinks
  bool grows = false;  ///< by more than kLeastGrowth

  bool any() const noexcept { return scale < 1 || grows; }
};

/// Slip with c fixed that brings the lateral force down to a limit.
struct LateralSlip {
  double distance = 0;  ///< m
  double scale = 0;     ///< the slip is scale * direction, m
  Vec3 direction{};     ///< of any length: a quotient less to wait for
  double lateral = 0;   ///< rho after it, m
  Vec3 tangent{};       ///< t after it

  Vec3 part(double fraction) const noexcept { return (fraction * scale) * direction; }  ///< m
};

/// With c, n = n(c), the lean sigma, the offset d0 and the lateral offset s fixed, where s and
/// sigma are across n:
///   r = x - c,  z = n . r - d0,  q = r - (n . r) n - s - sigma z,  rho = |q|,  t = q/rho,
///   f(x) = g(z) n + h(rho) (t - (t . sigma) n) = grad E(x),
/// those of Mahvash & Hayward 2005, eqs. 26-32, for s = sigma = 0.
/// s is slip that c has not followed; a = c + s, the anchor, is the position of c without that.
/// sigma = sum n_l sigma_l is how a straight press shears the tissue: beside a support its force
/// leans. Coupled responses: E = sum n_l (G_l(z) + w_l(z_w) H_l(rho)), sigma = sum n_l w_l(z_w)
/// sigma_l, q = r - (n . r) n - s - e - sigma (z - z_w/2), and again f = grad E: the grip is fixed
/// as well, and renew_grip() changes it. Where vertices have soft axes, p = S q takes the place of
/// q in E: rho = |p|, t = p/rho, and f = g n + h (S t - (S t . sigma) n). |S| <= 1, so that no
/// bound gets larger, and friction limits h to mu g, so that |S t| h <= mu g. The Jacobian is A^T
/// (g' n n^T + h' t t^T + (h/rho) b b^T) A with b = n x t and A = I - sigma n^T: its norm does not
/// exceed the largest stored slope (times w) times |A|^2. Responses that relax have a memory, which
/// is fixed as well: V of (R18) replaces G, and psi g replaces g in every equation above; H - M . q
/// + K replaces H, and grad H - M replaces h t (R23). noexcept, allocation-free.
class LocalModel {
 public:
  LocalModel(const Surface& surface, const SurfacePoint& point, double offset) noexcept
      : LocalModel(surface, point, offset, Grip{}) {
    hold(coupled() ? response_.lateral_weights(0) : response_.natural());
  }
  /// The same contact at another point, with its offset and its grip. s is zero, memory none.
  LocalModel moved_to(const SurfacePoint& point, ToolPieces& pieces) const noexcept;

  Deflection deflection(const Vec3& x) const noexcept {
    Deflection d;
    const Vec3 r = x - c_;
    d.geometric = dot(n_, r);
    d.depth = d.geometric - offset_;
    const Vec3 lateral =
        soft_axes_.stretch(r - d.geometric * n_ - lateral_offset_ - shear(d) - grip_.micro_slip);
    d.lateral = norm(lateral);
    if (d.lateral > 0) d.tangent = (1.0 / d.lateral) * lateral;
    return d;
  }
  /// sigma (z - z_w/2), m: what a straight press shears, where half of it has come into contact
  /// since. Of decoupled responses sigma z.
  Vec3 shear(const Deflection& d) const noexcept { return (d.depth - 0.5 * grip_.depth) * lean_; }
  /// q + e and the shear, m: how far the tip is from the anchor, across n.
  Vec3 lateral_displacement(const Deflection& d) const noexcept {
    return unstretched(d) + shear(d) + grip_.micro_slip;
  }
  double lateral_distance(const Deflection& d) const noexcept {  ///< its length
    const bool is_p = lean_ == Vec3{} && grip_.micro_slip == Vec3{} && !soft_axes_.any();
    return is_p ? d.lateral : norm(lateral_displacement(d));
  }
  /// pieces: of the last evaluation; on return of this one.
  LocalResponse respond(const Deflection& d, ToolPieces& pieces) const noexcept {
    LocalResponse r;
    respond(d, pieces, r);
    return r;
  }
  /// The same in its place: a copy would wait for what has just been stored.
  void respond(const Deflection& d, ToolPieces& pieces, LocalResponse& r) const noexcept {
    r = {};
    if (memory_)
      relaxing_response(d, pieces.relaxing, r);
    else
      response(d, pieces.elastic, r);
  }
  LocalResponse respond(const Deflection& d) const noexcept {
    LocalResponse r;
    if (memory_) {
      TipPieces pieces;
      relaxing_response(d, pieces, r);
    } else {
      PiecesInUse pieces;
      response(d, pieces, r);
    }
    return r;
  }
  double energy(const Deflection& d) const noexcept;
  /// rho_s = h^{-1}(mu g(z)): the lateral deflection at which slip begins, m. Without memory.
  double slip_limit(const Deflection& d, double friction) const noexcept;

  /// The lateral deflection at which the lateral force is `limit` (N), where the response is known
  /// and exceeds it, m.
  double lateral_below(const Deflection& d, double limit, ToolPieces& pieces) const noexcept {
    return response_.lateral_inverse_below(limit, d.lateral, lateral_weights(), pieces.elastic);
  }

  /// The slip with c fixed after which the lateral force is `limit` (N), where the response is
  /// known and exceeds it. Without memory it goes along q. With one the force keeps its direction
  /// (R25). Neither raises E.
  LateralSlip slip_within(const Deflection& d, const LocalResponse& at, double limit,
                          ToolPieces& pieces) const noexcept {
    if (memory_ && memory_->lateral.any) return relaxed_slip_within(d, at, limit, pieces.relaxing);
    const double rho = lateral_below(d, limit, pieces);
    LateralSlip slip{d.lateral - rho, d.lateral - rho, d.tangent, rho,
                     rho > 0 ? d.tangent : Vec3{}};
    if (soft_axes_.any()) restore_direction(slip);
    return slip;
  }

  /// Makes that slip: it goes into s. The depth does not change; the deflection and the response
  /// are updated.
  void slip(const LateralSlip& by, Deflection& d, LocalResponse& at, ToolPieces& pieces) noexcept;

  /// Takes w at the present depth, where responses are coupled and do not relax; E does not rise.
  /// As the contact shrinks, so does the lateral force. As it grows, the lateral force stays: what
  /// comes into contact holds tissue as it is [Mindlin & Deresiewicz 1953], and e takes the rest of
  /// q, up to kMostMicroSlip of the tool's radius; beyond it s does. Where E would rise, as a
  /// lateral response that stiffens sharply lets it, the grip stays. The lean grows and shrinks
  /// with w, and q stays with it. The deflection and the response are updated.
  void renew_grip(Deflection& d, LocalResponse& at, ToolPieces& pieces) noexcept;
  /// What renewing the grip at the present depth does to that of coupled responses that relax.
  GripChange grip_change(const Deflection& d, ToolPieces& pieces) const noexcept;
  /// The same of responses that relax, theory-runtime (R33). memories: those at this place; what
  /// they store is known where anything is remembered of drags.
  void renew_grip(const GripChange& change, Deflection& d, LocalResponse& at, ToolPieces& pieces,
                  const Relaxation& memories) noexcept;
  const Grip& grip() const noexcept { return grip_; }
  void set_grip(const Grip& grip) noexcept {
    grip_ = {grip.depth, grip.micro_slip - dot(grip.micro_slip, n_) * n_, grip.scale};
    if (coupled()) hold(weights_of(grip_));
  }
  /// Weights of the three lateral responses with a grip, of coupled responses.
  Vec3 weights_of(const Grip& grip) const noexcept {
    return grip.scale * response_.lateral_weights(grip.depth);
  }
  static constexpr double kMostMicroSlip = 0.1;
  /// Tissue that relaxes is held by up to this less than sum n_l w_l: renewing its memories takes
  /// time.
  static constexpr double kLeastGrowth = 1.0 / 512;

  /// Rate of change of E when c moves by unit length along d in its element and the anchor c + s by
  /// a', while x stays, J/m:
  ///   n' = P (sum u_l grad n_l . d)/|sum n_l u_l|, P the projector normal to n,
  ///   sigma' = sum sigma_l (grad n_l . d), across n, less the part that turns with n,
  ///   z' = (q + s + e + sigma z) . n' - n . d,
  ///   dE/ds = sum (grad n_l . d)(G_l + H_l) + (g - h (t . sigma)) z'
  ///           - h (t . a' + (z + d0)(t . n') + z (t . sigma')),
  /// with S t for t and h t . (S' q) more where there are soft axes, with H_l and sigma_l times
  /// w_l(z_w), and z - z_w/2 beside sigma, where responses are coupled. In an ordinary slide the
  /// anchor moves with c, a' = d; where c catches up with the anchor, a' = 0. Without memory.
  double energy_slope(const Deflection& at, const Vec3& d, const Vec3& anchor_rate) const noexcept;
  double energy_slope(const Deflection& at, const Vec3& d) const noexcept {
    return energy_slope(at, d, d);
  }

  const SurfacePoint& point() const noexcept { return point_; }
  const Vec3& contact_point() const noexcept { return c_; }
  const Vec3& normal() const noexcept { return n_; }
  const Vec3& lean() const noexcept { return lean_; }  ///< sigma, 1
  const SoftAxes& soft_axes() const noexcept { return soft_axes_; }
  double offset() const noexcept { return offset_; }
  void set_offset(double offset) noexcept { offset_ = offset; }
  const Vec3& lateral_offset() const noexcept { return lateral_offset_; }
  /// Sets s such that q = 0 with the tip at x, where it is longer than a tolerance, m.
  void let_go(const Vec3& x, double tolerance) noexcept {
    const Deflection d = deflection(x);
    if (d.lateral > tolerance) set_lateral_offset(x - c_ - shear(d));
  }
  /// Sets s to the part of the vector across n.
  void set_lateral_offset(const Vec3& s) noexcept { lateral_offset_ = s - dot(s, n_) * n_; }
  /// The responses relax, and this is what they remember.
  void set_memory(const TissueMemory& memory) noexcept { memory_.emplace(memory); }
  /// @pre the responses relax
  const TissueMemory& memory() const noexcept { return *memory_; }
  /// The energies of the memory, which were not known, and that of a response without them.
  /// @pre the responses relax
  void add_stored(const TissueMemory& memory, LocalResponse& at) noexcept {
    memory_->normal.stored_and_locked = memory.normal.stored_and_locked;
    memory_->lateral.stored_and_carried = memory.lateral.stored_and_carried;
    const double stored = at.relaxed.scale > 0 ? memory.normal.stored() : memory.normal.locked();
    at.relaxed.energy += stored;
    at.energy += stored + memory.lateral.stored();
  }
  /// The response of another memory, from that of the present one at the same deflection.
  void replace_memory(const TissueMemory& memory, const Deflection& d, LocalResponse& at) noexcept;
  const InterpolatedResponse& response() const noexcept { return response_; }
  ContactPlace place() const noexcept { return {point_, response_, n_, lateral_weights()}; }
  bool coupled() const noexcept { return response_.coupled(); }
  double deepest() const noexcept { return response_.deepest(); }
  NodeCurves::InUse curves_in_use(const Deflection& d) const noexcept {
    return response_.node(0).in_use(d.depth, d.lateral);
  }

 private:
  /// Without weights and lean.
  LocalModel(const Surface& surface, const SurfacePoint& point, double offset,
             const Grip& grip) noexcept
      : surface_(&surface),
        point_(point),
        c_(surface.position(point)),
        n_(surface.normal(point)),
        response_(surface.response(point)),
        offset_(offset),
        grip_(grip) {
    if (surface.has_soft_axes()) soft_axes_ = surface.soft_axes(point, n_);
  }
  /// q, m.
  Vec3 unstretched(const Deflection& d) const noexcept {
    return soft_axes_.restore(d.lateral * d.tangent);
  }
  /// What q loses where rho falls to `lateral`, m.
  Vec3 shortened(const Deflection& d, double lateral) const noexcept {
    return soft_axes_.restore((d.lateral - lateral) * d.tangent);
  }
  /// From a slip in p to that in q.
  void restore_direction(LateralSlip& slip) const noexcept {
    slip.direction = soft_axes_.restore(slip.direction);
    slip.distance = slip.scale * norm(slip.direction);
  }
  const Vec3& lateral_weights() const noexcept {
    return coupled() ? weights_ : response_.natural();
  }
  void response(const Deflection& d, PiecesInUse& pieces, LocalResponse& r) const noexcept {
    const InterpolatedResponse::Decoupled at =
        coupled() ? response_.weighted_at(d.depth, d.lateral, weights_, pieces)
                  : response_.decoupled_at(d.depth, d.lateral, pieces);
    take({at.normal.force, at.lateral.force, at.normal.energy + at.lateral.energy}, d, r);
    r.friction_normal_force = r.normal_force;
  }
  /// The same of responses that relax.
  [[gnu::always_inline]] void relaxing_response(const Deflection& d, TipPieces& pieces,
                                                LocalResponse& r) const noexcept {
    pieces.keep_for(response_.nodes(), response_.natural(), lateral_weights());
    const ReachedForces at = pieces.evaluate(0, Pair{d.depth, d.lateral});
    r.relaxed = relaxed_response(memory_->normal, {d.depth, at.force[0], at.energy[0]});
    take({r.relaxed.force, at.force[1], r.relaxed.energy + at.energy[1]}, d, r);
    r.instant_lateral_force = at.force[1];
    const LateralMemory& lateral = memory_->lateral;
    if (lateral.any) relax_laterally(lateral.relaxed(), lateral.relaxed(), lateral.stored(), d, r);
    r.friction_normal_force = r.normal_force;
  }
  /// Forces along n and t, N, and energy, J.
  struct Value {
    double normal = 0, lateral = 0, energy = 0;
  };
  void take(const Value& value, const Deflection& d, LocalResponse& r) const noexcept {
    r.normal_force = value.normal;
    r.lateral_force = value.lateral;
    r.energy = value.energy;
    r.force = value.normal * n_ + felt(value.lateral * d.tangent);
  }
  /// A^T S h t: the part of the force of a lateral force in the response coordinates, N.
  Vec3 felt(const Vec3& lateral) const noexcept { return leaning(soft_axes_.stretch(lateral)); }
  /// A^T of a lateral force, N.
  Vec3 leaning(const Vec3& lateral) const noexcept { return lateral - dot(lateral, lean_) * n_; }
  double turning_of_soft_axes(const Deflection& at, const Vec3& d, const Vec3& turn) const noexcept;
  /// Takes these weights W_l of the lateral responses, and the lean sum W_l sigma_l.
  void hold(const Vec3& weights) noexcept {
    if (coupled()) weights_ = weights;
    if (surface_->leans()) lean_ = surface_->lean(surface_->element(point_.element), weights, n_);
  }
  void take_shear(const Vec3& by) noexcept;
  void add_micro_slip(const Vec3& by) noexcept;
  void shrink_grip(double scale, const Deflection& d, LocalResponse& at) noexcept;
  void grow_grip(const Vec3& wide, Deflection& d, LocalResponse& at, ToolPieces& pieces,
                 const Relaxation& memories) noexcept;
  double lateral_reached(const LocalResponse& at, double force, TipPieces& pieces) const noexcept;
  /// Puts M (N) into a response, from which it differs by `change` (N), and K by `stored` (J).
  void relax_laterally(const Vec3& relaxed, const Vec3& change, double stored, const Deflection& d,
                       LocalResponse& r) const noexcept {
    r.lateral_force = norm(r.instant_lateral_force * d.tangent - relaxed);
    r.energy += stored - d.lateral * dot(change, d.tangent);
    r.force = r.force - felt(change);
  }
  LateralSlip relaxed_slip_within(const Deflection& d, const LocalResponse& at, double limit,
                                  TipPieces& pieces) const noexcept;
  /// A copy that an optional makes only where there is one: a step copies its model several times,
  /// and elastic tissue shall not pay for a memory.
  struct CopiedIfAny : TissueMemory {
    explicit CopiedIfAny(const TissueMemory& memory) noexcept : TissueMemory(memory) {}
    CopiedIfAny(const CopiedIfAny& other) noexcept : TissueMemory(other) {}
    CopiedIfAny& operator=(const CopiedIfAny& other) noexcept {
      if (this != &other) TissueMemory::operator=(other);
      return *this;
    }
    ~CopiedIfAny() = default;
  };

  const Surface* surface_;
  SurfacePoint point_;
  Vec3 c_;
  Vec3 n_;
  Vec3 lean_{};  ///< sigma
  SoftAxes soft_axes_;
  InterpolatedResponse response_;
  double offset_;
  Vec3 lateral_offset_{};
  Grip grip_;
  Vec3 weights_{};                     ///< those of the grip, where responses are coupled
  std::optional<CopiedIfAny> memory_;  ///< none: the responses do not relax
};

}  // namespace palpate::runtime
