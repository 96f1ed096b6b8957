// SPDX-License-Identifier: AGPL-3.0-or-later
// The local model evaluated directly from equations (26)-(32), independent of runtime/, and random
// states of it, for the tests of the bounds.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_jacobian.hpp"
#include "runtime/response_curve.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {

struct Contact {
  Vec3 force{};
  double z = 0, rho = 0, g = 0, h = 0, energy = 0;
  Vec3 n{}, t{};
  Vec3 q{};  ///< unit: t where there are no soft axes
};

inline constexpr double kPresent = std::numeric_limits<double>::quiet_NaN();

/// One triangle with contact points anywhere in its plane, by natural coordinates.
class PlainModel {
 public:
  PlainModel(const Library& library, std::size_t index) {
    for (std::size_t l = 0; l < 3; ++l) {
      const auto v = static_cast<std::size_t>(library.triangles[index][l]);
      x_[l] = library.positions[v];
      u_[l] = library.inward[v];
      normal_[l] = runtime::CompiledCurve(library.responses[v].normal);
      lateral_[l] = runtime::CompiledCurve(library.responses[v].lateral);
      lean_[l] = vec3_of(library.responses[v].lean);
      soft_axis_[l] = vec3_of(library.responses[v].soft_axis);
      if (library.kind == ResponseKind::Decoupled) continue;
      const CouplingCurve& w = library.responses[v].coupling;
      weight_[l] = runtime::CompiledCurve(w.curve, static_cast<double>(w.base));
    }
    facet_ = unit(cross(x_[1] - x_[0], x_[2] - x_[0]));
  }

  std::array<double, 3> natural(const Vec3& c) const {
    const double area = dot(cross(x_[1] - x_[0], x_[2] - x_[0]), facet_);
    const double a = dot(cross(x_[2] - x_[1], c - x_[1]), facet_) / area;
    const double b = dot(cross(x_[0] - x_[2], c - x_[2]), facet_) / area;
    return {a, b, 1 - a - b};
  }
  bool inside(const Vec3& c) const {
    const auto n = natural(c);
    return n[0] >= 0 && n[1] >= 0 && n[2] >= 0;
  }
  Vec3 point(double a, double b) const { return a * x_[0] + b * x_[1] + (1 - a - b) * x_[2]; }

  Vec3 direction(const Vec3& c) const {
    const auto w = natural(c);
    return unit(w[0] * u_[0] + w[1] * u_[1] + w[2] * u_[2]);
  }

  /// sigma of a contact that holds this depth.
  Vec3 lean(const Vec3& c, double held) const {
    const auto w = natural(c);
    Vec3 sum{};
    for (std::size_t l = 0; l < 3; ++l) sum = sum + w[l] * weight_at(l, held) * lean_[l];
    const Vec3 n = direction(c);
    return sum - dot(sum, n) * n;
  }

  /// S v, of v across n(c).
  Vec3 stretched(const Vec3& c, const Vec3& v) const {
    const auto w = natural(c);
    const Vec3 n = direction(c);
    Vec3 sum = v;
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3 b = soft_axis_[l] - dot(soft_axis_[l], n) * n;
      sum = sum - w[l] * dot(b, v) * b;
    }
    return sum;
  }

  /// What a straight press to z shears where the contact holds a depth.
  Vec3 shear(const Vec3& c, double z, double held) const {
    return (coupled() ? z - 0.5 * held : z) * lean(c, held);
  }

  /// held: depth that the contact holds, of coupled responses; NaN: the present one. before: the
  /// depth that it held as the tool moved; NaN: the present one.
  Contact at(const Vec3& x, const Vec3& c, double d0, double held = kPresent,
             double before = kPresent) const {
    const auto w = natural(c);
    Contact state;
    state.n = direction(c);
    const Vec3 delta = x - c - d0 * state.n;
    state.z = dot(state.n, delta);
    const double holds = std::isnan(held) ? state.z : held;
    const Vec3 sheared = shear(c, state.z, std::isnan(before) ? holds : before);
    const Vec3 lateral = delta - state.z * state.n - sheared;
    const Vec3 p = stretched(c, lateral);
    state.rho = norm(p);
    if (state.rho > 0) {
      state.t = (1 / state.rho) * p;
      state.q = unit(lateral);
    }
    for (std::size_t l = 0; l < 3; ++l) {
      const double weight = weight_at(l, holds);
      const double H = lateral_[l].energy(state.rho);
      state.g += w[l] * normal_[l].force(state.z);
      state.h += w[l] * weight * lateral_[l].force(state.rho);
      state.energy += w[l] * (normal_[l].energy(state.z) + weight * H);
    }
    const Vec3 felt = state.h * stretched(c, state.t);
    state.force = (state.g - dot(felt, lean(c, holds))) * state.n + felt;
    return state;
  }

  /// rho_s at a depth that the contact holds, by bisection.
  double slip_limit(const Vec3& c, double z, double limit) const {
    const auto w = natural(c);
    double low = 0;
    double high = 1;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      double h = 0;
      for (std::size_t l = 0; l < 3; ++l) h += w[l] * weight_at(l, z) * lateral_[l].force(middle);
      (h < limit ? low : high) = middle;
    }
    return high;
  }

  Vec3 in_plane(const Vec3& t) const { return unit(t - dot(t, facet_) * facet_); }

  /// The contact point after the slide has come to rest: moved until rho = rho_s.
  std::optional<Vec3> slid(const Vec3& x, Vec3 c, double d0, double mu, double held = kPresent,
                           double before = kPresent) const {
    for (int i = 0; i < 400; ++i) {
      const Contact state = at(x, c, d0, held, before);
      const double depth = std::isnan(held) ? state.z : held;
      const double excess = state.rho - slip_limit(c, depth, mu * state.g);
      if (excess < 1e-16) return c;
      c = c + excess / norm(stretched(c, state.q)) * in_plane(state.q);
    }
    return std::nullopt;
  }

  bool coupled() const { return !weight_[0].pieces().empty(); }

 private:
  double weight_at(std::size_t l, double z) const {
    if (weight_[l].pieces().empty()) return 1;
    return z > 0 ? weight_[l].force(z) : weight_[l].pieces().front().force;
  }

  std::array<Vec3, 3> x_{}, u_{}, lean_{}, soft_axis_{};
  std::array<runtime::CompiledCurve, 3> normal_, lateral_, weight_;
  Vec3 facet_{};
};

inline Library random_triangle(std::mt19937& engine, double lean, double spread) {
  std::normal_distribution<double> tilt(0, lean);
  Library library = flat_triangle();
  for (Vec3& u : library.inward) u = unit({tilt(engine), tilt(engine), -1});
  for (int l = 0; l < 3; ++l) library.responses.push_back(random_response(engine, spread));
  return library;
}

/// Lateral responses that stiffen with depth, each in its own way.
inline void couple(Library& library, std::mt19937& engine, double spread) {
  std::uniform_real_distribution<double> factor(1 - spread, 1 + spread);
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& node : library.responses) {
    const double s = factor(engine);
    const auto f = [&](double value) { return static_cast<float>(s * value); };
    node.coupling = {f(0.3), {{0.0F, 0.001F, 0.003F, 0.008F}, {0.0F, f(280), f(150), f(70)}}};
  }
}

/// Leans up to `most`, each in its own direction across the press.
inline void lean(Library& library, std::mt19937& engine, double most) {
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3& n = library.inward[v];
    const Vec3 any = unit({u(engine), u(engine), u(engine)});
    const Vec3 across = most * std::abs(u(engine)) * unit(any - dot(any, n) * n);
    for (std::size_t i = 0; i < 3; ++i)
      library.responses[v].lean[i] = static_cast<float>(across[i]);
  }
}

/// Soft axes up to `most`, each in its own direction across the press.
inline void soften(Library& library, std::mt19937& engine, double most) {
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3& n = library.inward[v];
    const Vec3 any = unit({u(engine), u(engine), u(engine)});
    const Vec3 across = most * std::sqrt(std::abs(u(engine))) * unit(any - dot(any, n) * n);
    for (std::size_t i = 0; i < 3; ++i)
      library.responses[v].soft_axis[i] = static_cast<float>(across[i]);
  }
}

/// A tool in contact: c inside, z + d0 <= depth, lateral deflection rho in a random direction.
struct Start {
  Vec3 c{}, x{};
  double d0 = 0;
};

inline Start random_start(std::mt19937& engine, const PlainModel& model, double depth,
                          const std::function<double(const Vec3&, double)>& lateral) {
  std::uniform_real_distribution<double> u(0, 1);
  double a = u(engine);
  double b = u(engine);
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  Start start;
  start.c = model.point(0.02 + 0.94 * a, 0.02 + 0.94 * b);
  const double z = depth * (0.02 + 0.98 * u(engine));
  start.d0 = u(engine) < 0.5 ? 0 : (depth - z) * u(engine);
  const Vec3 n = model.direction(start.c);
  const Vec3 any = unit({u(engine) - 0.5, u(engine) - 0.5, u(engine) - 0.5});
  const Vec3 t = unit(any - dot(any, n) * n);
  const double q = lateral(start.c, z) / norm(model.stretched(start.c, t));
  start.x = start.c + (z + start.d0) * n + q * t + model.shear(start.c, z, z);
  return start;
}

/// Where a contact grows, its lateral offset may take the growth, so that w stays; every other
/// step.
inline double held_depth(const Contact& before, const Vec3& step, int k) {
  return k % 2 == 1 && dot(step, before.n) > 0 ? before.z : kPresent;
}

struct SlideCensus {
  double closest = 0;  ///< largest quotient / L_slip
  int slides = 0;
};

/// Quotients |df|/|dx| of small steps that slide, in random directions.
inline void try_slides(std::mt19937& engine, const Library& library, double mu,
                       SlideCensus& census) {
  const PlainModel model(library, 0);
  const double bound = std::max(library.certificate.slip, library.certificate.stick);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 60; ++i) {
    const Start start =
        random_start(engine, model, library.certificate.depth, [&](const Vec3& c, double z) {
          const Vec3 n = model.direction(c);
          return model.slip_limit(c, z, mu * model.at(c + z * n, c, 0).g);
        });
    const Contact before = model.at(start.x, start.c, start.d0);
    for (int k = 0; k < 12; ++k) {
      const Vec3 step = 1e-7 * unit({normal(engine), normal(engine), normal(engine)});
      const double held = held_depth(before, step, k);
      const auto c = model.slid(start.x + step, start.c, start.d0, mu, held, before.z);
      ASSERT_TRUE(c);
      if (!model.inside(*c) || norm(*c - start.c) < 1e-10) continue;
      const Contact after = model.at(start.x + step, *c, start.d0, held, before.z);
      const double quotient = norm(after.force - before.force) / norm(step);
      EXPECT_LE(quotient, bound * (1 + 1e-4));
      census.closest = std::max(census.closest, quotient / bound);
      ++census.slides;
    }
  }
}

/// A random state that slides, for both descriptions of it.
struct SlidingState {
  Start start;
  SlideCell cell;
};

inline SlidingState random_slide(std::mt19937& engine, const PlainModel& model,
                                 const ContactElement& element) {
  std::uniform_real_distribution<double> u(0, 1);
  const double a = 0.1 + 0.4 * u(engine), b = 0.1 + 0.35 * u(engine);
  const double z = element.depth * (0.05 + 0.7 * u(engine));
  const double d0 = (element.depth - z) * u(engine), azimuth = 2 * M_PI * u(engine);
  // tau of the search, from its axes: x along the gradient of the first coordinate.
  const TriangleFrame& frame = element.frame;
  const Vec3 x = unit(frame.gradient[0]), y = cross(frame.normal, x);
  const Vec3 tau = std::cos(azimuth) * x + std::sin(azimuth) * y;
  SlidingState state;
  state.start.c = model.point(a, b);
  state.start.d0 = d0;
  const Vec3 n = model.direction(state.start.c);
  const Vec3 t = unit(tau - (dot(tau, n) / dot(frame.normal, n)) * frame.normal);
  const double g = model.at(state.start.c + z * n, state.start.c, 0).g;
  const double rho = model.slip_limit(state.start.c, z, element.friction * g);
  const double q = rho / norm(model.stretched(state.start.c, t));
  state.start.x = state.start.c + (z + d0) * n + q * t + model.shear(state.start.c, z, z);
  const SlideCell::Natural place{a, b, 1 - a - b};
  state.cell = {{place, place, place}, {azimuth, azimuth}, {z, z}, {z + d0, z + d0}};
  return state;
}

/// Largest |df|/|dx| of small steps from a state that slide.
inline double steepest_step(std::mt19937& engine, const PlainModel& model, const Start& start,
                            double mu) {
  std::normal_distribution<double> normal;
  const Contact before = model.at(start.x, start.c, start.d0);
  double steepest = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3 step = 1e-8 * unit({normal(engine), normal(engine), normal(engine)});
    const double held = held_depth(before, step, k);
    const auto c = model.slid(start.x + step, start.c, start.d0, mu, held, before.z);
    if (!c || norm(*c - start.c) < 1e-11) continue;
    const Vec3 after = model.at(start.x + step, *c, start.d0, held, before.z).force;
    steepest = std::max(steepest, norm(after - before.force) / norm(step));
  }
  return steepest;
}

}  // namespace palpate::fitting
