// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/challenge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "fitting/certificate/contact_element.hpp"
#include "format/error.hpp"
#include "format/tangent_frame.hpp"
#include "runtime/local_model.hpp"
#include "runtime/sliding.hpp"
#include "runtime/surface.hpp"

namespace palpate::fitting {
namespace {

using runtime::LocalModel;
using runtime::SurfacePoint;

constexpr double kStepOverDepth = 2e-5;  // of the tool, over the certified depth
constexpr double kRestOverStep = 1e-9;   // excess over the slip limit at which a slide has ended
constexpr int kSlideSteps = 400;
/// Round-off and curvature in a difference of forces over a step, relative to the bound.
constexpr double kDifference = 1e-4;
constexpr double kFirstStride = 0.2, kLastStride = 1e-3;  // of a hill climb

enum class Mode { Sticking, Sliding };

/// A state of the contact in coordinates from 0 to 1, and the direction in which the tool moves.
struct Attempt {
  std::int32_t triangle = 0;
  double a = 0, b = 0;  ///< position in the triangle
  double depth = 0;     ///< z over the certified depth D
  double offset = 0;    ///< d0 over D - z
  double lateral = 0;   ///< Sticking: rho over the slip limit
  double azimuth = 0;   ///< of the lateral deflection, turns
  Vec3 move{};          ///< not zero
};

class Challenger {
 public:
  Challenger(const Library& library, unsigned seed)
      : library_(library), surface_(library), engine_(seed) {}

  Attempt draw(std::int32_t triangle) {
    Attempt attempt{triangle, uniform(), uniform(), uniform(), 0, uniform(), uniform(), {}};
    attempt.offset = uniform() < 0.5 ? 0 : uniform();
    attempt.move = {normal(), normal(), normal()};
    return attempt;
  }

  Attempt near(const Attempt& from, double stride) {
    Attempt attempt = from;
    for (double* x : {&attempt.a, &attempt.b, &attempt.depth, &attempt.offset, &attempt.lateral})
      *x = std::clamp(*x + stride * normal(), 0.0, 1.0);
    attempt.azimuth += 0.5 * stride * normal();
    const double length = norm(from.move);
    attempt.move = from.move + (stride * length) * Vec3{normal(), normal(), normal()};
    return attempt;
  }

  /// |df|/|dx|; absent when the slide leaves the triangle, sticks, or there is no slip limit.
  std::optional<double> quotient(const Attempt& attempt, Mode mode) const {
    const SurfacePoint point = point_of(attempt);
    const double deepest = library_.certificate.depth;
    const double z = std::max(1e-3, attempt.depth) * deepest;
    const double d0 = attempt.offset * (deepest - z);
    LocalModel model(surface_, point, d0);
    model.set_grip({z, {}});
    const Vec3& n = model.normal();
    runtime::Deflection pressed;
    pressed.geometric = z + d0;
    pressed.depth = z;
    const double limit = model.slip_limit(pressed, library_.certificate.friction);
    if (!std::isfinite(limit)) return std::nullopt;
    const double rho = mode == Mode::Sticking ? attempt.lateral * limit : limit;
    const Vec3 side = sideways(n, attempt.azimuth);
    const double stretch = norm(model.soft_axes().stretch(side));
    const Vec3 x =
        model.contact_point() + (z + d0) * n + model.shear(pressed) + rho / stretch * side;
    const double step = step_length();
    const Vec3 dx = (step / norm(attempt.move)) * attempt.move;
    const Vec3 before = model.respond(model.deflection(x)).force;
    if (mode == Mode::Sticking) return norm(force_at(model, x + dx) - before) / step;
    const auto after = slide(x + dx, point, d0, model.grip());
    if (!after) return std::nullopt;
    return norm(*after - before) / step;
  }

 private:
  double step_length() const { return kStepOverDepth * library_.certificate.depth; }  // m
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  double normal() { return std::normal_distribution<double>(0, 1)(engine_); }

  static SurfacePoint point_of(const Attempt& attempt) {
    const bool fold = attempt.a + attempt.b > 1;
    const double a = fold ? 1 - attempt.a : attempt.a, b = fold ? 1 - attempt.b : attempt.b;
    return {attempt.triangle, {a, b, 1 - a - b}};
  }

  static Vec3 sideways(const Vec3& n, double turns) {
    const auto [first, second] = tangent_frame(n);
    return std::cos(2 * M_PI * turns) * first + std::sin(2 * M_PI * turns) * second;
  }

  /// Force with the tip at x, with c fixed.
  static Vec3 force_at(LocalModel model, const Vec3& x) {
    runtime::ToolPieces pieces;
    runtime::Deflection d = model.deflection(x);
    runtime::LocalResponse response = model.respond(d, pieces);
    model.renew_grip(d, response, pieces);
    return response.force;
  }

  /// Force after the contact point has moved and come to rest inside its triangle.
  std::optional<Vec3> slide(const Vec3& x, SurfacePoint point, double d0,
                            const runtime::Grip& grip) const {
    const Vec3 start = surface_.position(point);
    const std::int32_t triangle = point.element;
    for (int i = 0; i < kSlideSteps; ++i) {
      LocalModel model(surface_, point, d0);
      model.set_grip(grip);
      runtime::Deflection d = model.deflection(x);
      if (d.depth < grip.depth) {
        runtime::ToolPieces pieces;
        runtime::LocalResponse response = model.respond(d, pieces);
        model.renew_grip(d, response, pieces);
      }
      const double excess = d.lateral - model.slip_limit(d, library_.certificate.friction);
      if (!(excess > kRestOverStep * step_length())) {
        if (norm(model.contact_point() - start) < 1e-3 * step_length()) return std::nullopt;
        return model.respond(d).force;
      }
      const Vec3 path = excess * model.soft_axes().restore(d.tangent);
      const runtime::Walk walked = runtime::walk(surface_, point, path, norm(path));
      if (walked.at_border || walked.point.element != triangle) return std::nullopt;
      point = walked.point;
    }
    return std::nullopt;
  }

  const Library& library_;
  runtime::Surface surface_;
  std::mt19937 engine_;
};

struct Found {
  Attempt attempt;
  double quotient = 0, bound = 0;
};

void update(const Found& found, Steepest& steepest) {
  ++steepest.tries;
  steepest.max_ratio = std::max(steepest.max_ratio, found.quotient / found.bound);
  if (found.quotient <= steepest.quotient) return;
  steepest.quotient = found.quotient;
  steepest.triangle = found.attempt.triangle;
}

/// Hill climb by random steps of decreasing length.
void climb(Challenger& challenger, Mode mode, int steps, Found found, Steepest& steepest) {
  const double shrink = std::pow(kLastStride / kFirstStride, 1.0 / std::max(1, steps));
  double stride = kFirstStride;
  for (int i = 0; i < steps; ++i, stride *= shrink) {
    const Attempt next = challenger.near(found.attempt, stride);
    const auto quotient = challenger.quotient(next, mode);
    if (!quotient) continue;
    update({next, *quotient, found.bound}, steepest);
    if (*quotient > found.quotient) found = {next, *quotient, found.bound};
  }
}

Steepest search(const Library& library, Mode mode, const ChallengeSettings& settings) {
  const bool sticking = mode == Mode::Sticking;
  Steepest steepest;
  steepest.bound = sticking ? library.certificate.stick : library.certificate.slip;
  Challenger challenger(library, settings.seed);
  std::vector<Found> best;  // of each triangle
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    if (!has_responses(library, library.triangles[m])) continue;
    const TriangleCertificate& triangle = library.certificate.triangles[m];
    // Theorem 1 takes the larger of both bounds, so a slide may be as steep as the stick bound.
    const double bound = sticking ? triangle.stick : std::max(triangle.stick, triangle.slip);
    if (!std::isfinite(bound)) continue;
    Found top;
    for (int i = 0; i < settings.tries; ++i) {
      const Attempt attempt = challenger.draw(static_cast<std::int32_t>(m));
      const auto quotient = challenger.quotient(attempt, mode);
      if (!quotient) continue;
      const Found found{attempt, *quotient, bound};
      update(found, steepest);
      if (found.quotient > top.quotient) top = found;
    }
    if (top.quotient > 0) best.push_back(top);
  }
  std::sort(best.begin(), best.end(),
            [](const Found& x, const Found& y) { return x.quotient > y.quotient; });
  if (best.size() > static_cast<std::size_t>(settings.climbs))
    best.resize(static_cast<std::size_t>(settings.climbs));
  for (const Found& found : best) climb(challenger, mode, settings.steps, found, steepest);
  return steepest;
}

}  // namespace

bool ChallengeResult::confirms() const {
  return sticking.max_ratio <= 1 + kDifference && sliding.max_ratio <= 1 + kDifference;
}

ChallengeResult challenge(const Library& library, const ChallengeSettings& settings) {
  if (library.certificate.triangles.size() != library.triangles.size() ||
      library.triangles.empty()) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'", "it has no certificate",
                "certify it first");
  }
  return {search(library, Mode::Sticking, settings), search(library, Mode::Sliding, settings)};
}

}  // namespace palpate::fitting
