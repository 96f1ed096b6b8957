// SPDX-License-Identifier: AGPL-3.0-or-later
// The bounds against the force itself: a plain evaluation of the local model, written here from the
// equations (26)-(32), differentiated and slid numerically.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/slide_bound.hpp"
#include "fitting/certificate/slide_jacobian.hpp"
#include "fitting/certificate/triangle_frame.hpp"
#include "runtime/response_curve.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

struct Contact {
  Vec3 force{};
  double z = 0, rho = 0, g = 0, h = 0, energy = 0;
  Vec3 n{}, t{};
};

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

  Contact at(const Vec3& x, const Vec3& c, double d0) const {
    const auto w = natural(c);
    Contact state;
    state.n = direction(c);
    const Vec3 delta = x - c - d0 * state.n;
    state.z = dot(state.n, delta);
    const Vec3 lateral = delta - state.z * state.n;
    state.rho = norm(lateral);
    if (state.rho > 0) state.t = (1 / state.rho) * lateral;
    double normal_force = 0;
    for (std::size_t l = 0; l < 3; ++l) {
      const double weight = weight_at(l, state.z);
      const double H = lateral_[l].energy(state.rho);
      state.g += w[l] * normal_[l].force(state.z);
      normal_force += w[l] * (normal_[l].force(state.z) + weight_[l].slope(state.z) * H);
      state.h += w[l] * weight * lateral_[l].force(state.rho);
      state.energy += w[l] * (normal_[l].energy(state.z) + weight * H);
    }
    state.force = normal_force * state.n + state.h * state.t;
    return state;
  }

  /// rho_s at a depth, by bisection.
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
  std::optional<Vec3> slid(const Vec3& x, Vec3 c, double d0, double mu) const {
    for (int i = 0; i < 400; ++i) {
      const Contact state = at(x, c, d0);
      const double excess = state.rho - slip_limit(c, state.z, mu * state.g);
      if (excess < 1e-16) return c;
      c = c + excess * in_plane(state.t);
    }
    return std::nullopt;
  }

 private:
  double weight_at(std::size_t l, double z) const {
    if (weight_[l].pieces().empty()) return 1;
    return z > 0 ? weight_[l].force(z) : weight_[l].pieces().front().force;
  }

  std::array<Vec3, 3> x_{}, u_{};
  std::array<runtime::CompiledCurve, 3> normal_, lateral_, weight_;
  Vec3 facet_{};
};

Library random_triangle(std::mt19937& engine, double lean, double spread) {
  std::normal_distribution<double> tilt(0, lean);
  Library library = flat_triangle();
  for (Vec3& u : library.inward) u = unit({tilt(engine), tilt(engine), -1});
  for (int l = 0; l < 3; ++l) library.responses.push_back(random_response(engine, spread));
  return library;
}

/// Lateral responses that stiffen with depth, each in its own way.
void couple(Library& library, std::mt19937& engine, double spread) {
  std::uniform_real_distribution<double> factor(1 - spread, 1 + spread);
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& node : library.responses) {
    const double s = factor(engine);
    const auto f = [&](double value) { return static_cast<float>(s * value); };
    node.coupling = {f(0.3), {{0.0F, 0.001F, 0.003F, 0.008F}, {0.0F, f(280), f(150), f(70)}}};
  }
}

/// A tool in contact: c inside, z + d0 <= depth, lateral deflection rho in a random direction.
struct Start {
  Vec3 c{}, x{};
  double d0 = 0;
};

Start random_start(std::mt19937& engine, const PlainModel& model, double depth,
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
  start.x = start.c + (z + start.d0) * n + lateral(start.c, z) * t;
  return start;
}

Eigen::Matrix3d jacobian(const PlainModel& model, const Start& start) {
  Eigen::Matrix3d J;
  constexpr double kStep = 1e-7;
  for (int j = 0; j < 3; ++j) {
    Vec3 e{};
    e[static_cast<std::size_t>(j)] = kStep;
    const Vec3 difference = model.at(start.x + e, start.c, start.d0).force -
                            model.at(start.x - e, start.c, start.d0).force;
    for (int i = 0; i < 3; ++i) J(i, j) = difference[static_cast<std::size_t>(i)] / (2 * kStep);
  }
  return J;
}

TEST(StickBound, NoJacobianIsSteeper) {
  std::mt19937 engine(31);
  std::uniform_real_distribution<double> u(0, 1);
  double closest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Library library = random_triangle(engine, 0.2, 0.5);
    certify(library, {});
    const PlainModel model(library, 0);
    for (int i = 0; i < 250; ++i) {
      const Start start = random_start(engine, model, 0.012,
                                       [&](const Vec3&, double) { return 0.006 * u(engine); });
      const Eigen::Matrix3d J = jacobian(model, start);
      const double lipschitz_bound = Eigen::JacobiSVD<Eigen::Matrix3d>(J).singularValues()[0];
      EXPECT_LE(lipschitz_bound, library.certificate.stick * (1 + 1e-5));
      closest = std::max(closest, lipschitz_bound / library.certificate.stick);
    }
  }
  std::printf("steepest Jacobian seen: %.3f of L_stick\n", closest);
  EXPECT_GT(closest, 0.95);  // reached at a vertex, where the stiffest curve stands alone
}

TEST(StickBound, NoCoupledJacobianWithinTheSlipLimitIsSteeper) {
  std::mt19937 engine(33);
  std::uniform_real_distribution<double> u(0, 1);
  double closest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Library library = random_triangle(engine, 0.2, 0.5);
    couple(library, engine, 0.2);
    CertifySettings settings;
    settings.friction = 0.1 + 0.2 * (trial % 4);
    certify(library, settings);
    const PlainModel model(library, 0);
    double steepest = 0;
    for (int i = 0; i < 250; ++i) {
      const auto up_to_slip = [&](const Vec3& c, double z) {
        const Vec3 n = model.direction(c);
        return u(engine) * model.slip_limit(c, z, settings.friction * model.at(c + z * n, c, 0).g);
      };
      const Start start = random_start(engine, model, library.certificate.depth, up_to_slip);
      const Eigen::Matrix3d J = jacobian(model, start);
      steepest = std::max(steepest, Eigen::JacobiSVD<Eigen::Matrix3d>(J).singularValues()[0]);
    }
    EXPECT_LE(steepest, library.certificate.stick * (1 + 1e-5));
    EXPECT_GE(steepest, 0.5 * library.certificate.stick);  // no idle bound
    closest = std::max(closest, steepest / library.certificate.stick);
  }
  std::printf("steepest coupled Jacobian seen: %.3f of L_stick\n", closest);
}

struct SlideCensus {
  double closest = 0;  ///< largest quotient / L_slip
  int slides = 0;
};

/// Quotients |df|/|dx| of small steps that slide, in random directions.
void try_slides(std::mt19937& engine, const Library& library, double mu, SlideCensus& census) {
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
      const auto c = model.slid(start.x + step, start.c, start.d0, mu);
      ASSERT_TRUE(c);
      if (!model.inside(*c) || norm(*c - start.c) < 1e-10) continue;
      const Contact after = model.at(start.x + step, *c, start.d0);
      const double quotient = norm(after.force - before.force) / norm(step);
      EXPECT_LE(quotient, bound * (1 + 1e-4));
      census.closest = std::max(census.closest, quotient / bound);
      ++census.slides;
    }
  }
}

TEST(SlipBound, NoSlidingPathIsSteeper) {
  std::mt19937 engine(37);
  SlideCensus census;
  for (const double mu : {0.1, 0.3, 0.6}) {
    for (int trial = 0; trial < 40; ++trial) {
      Library library = random_triangle(engine, 0.03, 0.1 + 0.2 * (trial % 3));
      CertifySettings settings;
      settings.friction = mu;
      certify(library, settings);
      if (std::isinf(library.certificate.slip)) continue;
      try_slides(engine, library, mu, census);
    }
  }
  std::printf("steepest slide seen: %.3f of the bound, %d slides\n", census.closest, census.slides);
  EXPECT_GT(census.slides, 10000);
  EXPECT_GT(census.closest, 0.85);  // and the bound is not idle
}

TEST(SlipBound, NoCoupledSlidingPathIsSteeper) {
  std::mt19937 engine(39);
  SlideCensus census;
  int bounded = 0;
  for (const double mu : {0.1, 0.3, 0.6}) {
    for (int trial = 0; trial < 40; ++trial) {
      Library library = random_triangle(engine, 0.03, 0.05 + 0.1 * (trial % 3));
      couple(library, engine, 0.1);
      CertifySettings settings;
      settings.friction = mu;
      certify(library, settings);
      if (std::isinf(library.certificate.slip)) continue;
      ++bounded;
      try_slides(engine, library, mu, census);
    }
  }
  std::printf("steepest coupled slide seen: %.3f of the bound, %d slides on %d triangles\n",
              census.closest, census.slides, bounded);
  EXPECT_GT(census.slides, 10000);
  EXPECT_GT(census.closest, 0.85);
}

/// A random state that slides, for both descriptions of it.
struct SlidingState {
  Start start;
  SlideCell cell;
};

SlidingState random_slide(std::mt19937& engine, const PlainModel& model,
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
  state.start.x = state.start.c + (z + d0) * n + rho * t;
  const SlideCell::Natural place{a, b, 1 - a - b};
  state.cell = {{place, place, place}, {azimuth, azimuth}, {z, z}, {z + d0, z + d0}};
  return state;
}

/// Largest |df|/|dx| of small steps from a state that slide.
double steepest_step(std::mt19937& engine, const PlainModel& model, const Start& start, double mu) {
  std::normal_distribution<double> normal;
  const Vec3 before = model.at(start.x, start.c, start.d0).force;
  double steepest = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3 step = 1e-8 * unit({normal(engine), normal(engine), normal(engine)});
    const auto c = model.slid(start.x + step, start.c, start.d0, mu);
    if (!c || norm(*c - start.c) < 1e-11) continue;
    const Vec3 after = model.at(start.x + step, *c, start.d0).force;
    steepest = std::max(steepest, norm(after - before) / norm(step));
  }
  return steepest;
}

TEST(SlipBound, SlantedPlateHasAClosedForm) {
  // Equal springs k (normal) and r (lateral), all directions leaning by theta against the facet:
  // nothing changes along the surface, yet the contact point runs down the slope. With t along the
  // slope, q = n . tau = sin(theta) (tau downhill), p = cos(theta):
  //   f' = k (n + mu t)(n - q w) . x',  w = (r t - mu k n)/(r p - mu k q).
  constexpr double kTheta = 0.15;
  constexpr double k = 200;
  constexpr double r = 120;
  constexpr double mu = 0.4;
  Library library = flat_triangle();
  library.inward.assign(3, {std::sin(kTheta), 0, -std::cos(kTheta)});
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(r)));
  CertifySettings settings;
  settings.friction = mu;
  certify(library, settings);

  const double q = std::sin(kTheta);
  const double scale = 1 / (r * std::cos(kTheta) - mu * k * q);
  const double along_n = 1 + q * mu * k * scale;
  const double along_t = -q * r * scale;
  const double steepest = k * std::hypot(1.0, mu) * std::hypot(along_n, along_t);

  const PlainModel model(library, 0);
  const Vec3 n = model.direction({0.003, 0.003, 0});
  const Vec3 t{std::cos(kTheta), 0, std::sin(kTheta)};
  const Start start{
      {0.003, 0.003, 0}, Vec3{0.003, 0.003, 0} + 0.004 * n + (mu * k * 0.004 / r) * t, 0};
  // The steepest direction, or its opposite, makes the contact point slide forward.
  const Vec3 step = -1e-7 * unit(along_n * n + along_t * t);
  const auto c = model.slid(start.x + step, start.c, 0, mu);
  ASSERT_TRUE(c);
  ASSERT_GT(norm(*c - start.c), 1e-9);
  const Vec3 difference =
      model.at(start.x + step, *c, 0).force - model.at(start.x, start.c, 0).force;
  EXPECT_NEAR(norm(difference) / norm(step), steepest, 1e-3 * steepest);
  EXPECT_GT(steepest, 1.05 * k * std::hypot(1.0, mu));  // steeper than the level plate
  EXPECT_GE(library.certificate.slip, steepest);
  // Slides aslant are a little steeper than down the slope; sets of states are halved to 1.1.
  const ContactElement element = contact_element(library, 0, library.certificate.depth, mu);
  std::mt19937 engine(29);
  double steepest_anywhere = steepest;
  for (int i = 0; i < 60; ++i) {
    const SlidingState state = random_slide(engine, model, element);
    steepest_anywhere =
        std::max(steepest_anywhere, steepest_step(engine, model, state.start, settings.friction));
  }
  EXPECT_LE(library.certificate.slip, 1.11 * steepest_anywhere);
}

TEST(SlideJacobian, OfOneStateIsItsSteepestStep) {
  std::mt19937 engine(45);
  int alike = 0;
  for (const bool coupled : {false, true}) {
    for (int trial = 0; trial < 60; ++trial) {
      Library library = random_triangle(engine, 0.06, 0.2);
      if (coupled) couple(library, engine, 0.1);
      const double mu = 0.1 + 0.2 * (trial % 3);
      const ContactElement element = contact_element(library, 0, 0.008, mu);
      const PlainModel model(library, 0);
      const SlidingState state = random_slide(engine, model, element);
      const double expected = SlideJacobian(element).bound(state.cell);
      ASSERT_TRUE(std::isfinite(expected));
      const double found = steepest_step(engine, model, state.start, mu);
      EXPECT_LE(found, expected * (1 + 1e-4)) << "coupled " << coupled << ", trial " << trial;
      alike += found > 0.98 * expected ? 1 : 0;  // the others soften as they slide: M_0 is steeper
    }
  }
  std::printf("%d of 120 states as steep as their steepest step\n", alike);
  EXPECT_GT(alike, 60);
}

TEST(SlideJacobian, NoStateOfACellIsSteeperThanItsBound) {
  std::mt19937 engine(47);
  std::uniform_real_distribution<double> u(0, 1);
  int cells = 0;
  double closest = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Library library = random_triangle(engine, 0.1, 0.3);
    if (trial % 2 == 1) couple(library, engine, 0.1);
    const ContactElement element = contact_element(library, 0, 0.008, 0.1 + 0.2 * (trial % 3));
    const SlideJacobian jacobian(element);
    SlideCell cell;
    for (SlideCell::Natural& n : cell.part) {
      const double a = 0.3 + 0.2 * u(engine), b = 0.2 + 0.2 * u(engine);
      n = {a, b, 1 - a - b};
    }
    const double azimuth = 2 * M_PI * u(engine), width = 0.4 * u(engine);
    cell.azimuth = {azimuth, azimuth + width};
    const std::vector<double> depths = element.depth_cells();
    const double z = depths[1] + 0.3 * (depths[2] - depths[1]) * u(engine);
    cell.z = {z, z + 0.3 * (depths[2] - depths[1])};
    cell.reach = {cell.z.low, element.depth};
    const double bound = jacobian.bound(cell);
    if (std::isinf(bound)) continue;
    ++cells;
    for (int i = 0; i < 100; ++i) {
      double p = u(engine), q = u(engine);
      if (p + q > 1) p = 1 - p, q = 1 - q;
      SlideCell::Natural n{};
      for (std::size_t l = 0; l < 3; ++l)
        n[l] = p * cell.part[0][l] + q * cell.part[1][l] + (1 - p - q) * cell.part[2][l];
      const double towards = cell.azimuth.low + width * u(engine);
      const double deep = cell.z.low + (cell.z.high - cell.z.low) * u(engine);
      const double reach = deep + (element.depth - deep) * u(engine);
      const double steep =
          jacobian.bound({{n, n, n}, {towards, towards}, {deep, deep}, {reach, reach}});
      EXPECT_LE(steep, bound * (1 + 1e-9));
      closest = std::max(closest, steep / bound);
    }
  }
  std::printf("%d cells; nearest to a bound %.3f\n", cells, closest);
  EXPECT_GT(cells, 100);
  EXPECT_GT(closest, 0.9);
}

TEST(SteepestSlide, BoundsWhatTheClosedFormDoesNot) {
  std::mt19937 engine(49);
  SlideCensus census;
  int gained = 0, unbounded = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Library library = random_triangle(engine, 0.22, 0.1);
    if (trial % 2 == 1) couple(library, engine, 0.1);
    CertifySettings settings;
    settings.friction = 0.3;
    certify(library, settings);
    const double depth = library.certificate.depth;
    if (std::isfinite(slide_bound(contact_element(library, 0, depth, settings.friction)).total))
      continue;
    ++unbounded;
    if (std::isinf(library.certificate.slip)) continue;
    ++gained;
    try_slides(engine, library, settings.friction, census);
  }
  std::printf("%d of %d triangles gained, steepest slide seen: %.3f of the bound\n", gained,
              unbounded, census.closest);
  EXPECT_GT(gained, 5);
  EXPECT_GT(census.slides, 1000);
}

TEST(SlipBound, HoldsOnTheTrianglesOfASphere) {
  std::mt19937 engine(41);
  Library library = sphere(0.04, 2);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    library.responses.push_back(random_response(engine, 0.1));
  }
  CertifySettings settings;
  settings.friction = 0.3;
  certify(library, settings);
  SlideCensus census;
  for (std::size_t m = 0; m < library.triangles.size(); m += 7) {
    Library one = library;
    one.triangles = {library.triangles[m]};
    one.certificate.stick = library.certificate.triangles[m].stick;
    one.certificate.slip = library.certificate.triangles[m].slip;
    if (std::isinf(one.certificate.slip)) continue;
    try_slides(engine, one, settings.friction, census);
  }
  std::printf(
      "sphere: steepest slide seen: %.3f of the bound, %d slides; L_stick %.0f, L_slip %.0f\n",
      census.closest, census.slides, library.certificate.stick, library.certificate.slip);
  EXPECT_GT(census.slides, 1000);
}

/// Energy before and after a slide of the paper's rule, the tool held: c moves by rho - rho_s.
struct EnergyStep {
  double before = 0, after = 0;
};

std::optional<EnergyStep> slide_once(std::mt19937& engine, const PlainModel& model, double depth,
                                     double mu) {
  constexpr double kExcess = 1e-6;
  const Start start = random_start(engine, model, depth, [&](const Vec3& c, double z) {
    const Vec3 n = model.direction(c);
    return model.slip_limit(c, z, mu * model.at(c + z * n, c, 0).g) + kExcess;
  });
  const Contact before = model.at(start.x, start.c, start.d0);
  const Vec3 c = start.c + kExcess * model.in_plane(before.t);
  if (!model.inside(c)) return std::nullopt;
  return EnergyStep{before.energy, model.at(start.x, c, start.d0).energy};
}

TEST(SlidingPassive, NoSlideRaisesTheEnergyWhereItIsCertified) {
  std::mt19937 engine(43);
  int certified = 0;
  int slides = 0;
  int rises_elsewhere = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double mu = 0.2 + 0.2 * (trial % 3);
    Library library = random_triangle(engine, 0.02, 0.05 + 0.15 * (trial % 4));
    CertifySettings settings;
    settings.friction = mu;
    certify(library, settings);
    const PlainModel model(library, 0);
    const bool passive = library.certificate.triangles[0].sliding_passive;
    certified += passive ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      const auto step = slide_once(engine, model, library.certificate.depth, mu);
      if (!step) continue;
      if (passive) {
        EXPECT_LE(step->after, step->before + 1e-16);
        ++slides;
      } else if (step->after > step->before) {
        ++rises_elsewhere;
      }
    }
  }
  std::printf("certified %d of 150 triangles, %d slides; %d slides elsewhere raise the energy\n",
              certified, slides, rises_elsewhere);
  EXPECT_GT(certified, 30);
  EXPECT_GT(slides, 5000);
  EXPECT_GT(rises_elsewhere, 0);  // the condition tells triangles apart
}

}  // namespace
}  // namespace palpate::fitting
