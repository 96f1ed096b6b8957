// SPDX-License-Identifier: AGPL-3.0-or-later
// Annealing for motions that get energy out of the samples of a loop, against the damping and the
// dry friction of docs/theory-certificate.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/unit/runtime/adversary.hpp"

namespace palpate::test {
namespace {

using runtime::ContactSettings;
using runtime::EnergyBudget;

/// What a device with the damping of (C1) gives and takes on the straight path between samples
/// whose forces act d samples late: the work on the body, plus (d + 1/2) L |x_{k+1} - x_k|^2, the
/// least that this damping dissipates there, whatever the period; with responses that relax more,
/// (C9). Positions are reported in steps of `resolution`, for which the dry friction of (C2) pays.
class SampledLoop {
 public:
  static constexpr std::size_t kDelays = 3;

  /// relaxing: relaxing_factor times sum g_i, at least the same times theta of (C9) at any period
  SampledLoop(WatchedContact& contact, double lipschitz_bound, double resolution, double relaxing)
      : contact_(contact), bound_(lipschitz_bound), resolution_(resolution), relaxing_(relaxing) {}

  /// Damping of the theorem for d samples of delay, over L T.
  static double samples(std::size_t delay, double relaxing) {
    const auto d = static_cast<double>(delay);
    return d + 0.5 + d * d * relaxing / 2;
  }

  void step(const Vec3& x) {
    if (begun_) account(x - last_);
    contact_.step(reported(x));
    std::rotate(force_.begin(), force_.end() - 1, force_.end());
    force_[0] = contact_.seen().force;
    last_ = x;
    begun_ = true;
  }
  /// Energy returned with d samples of delay over L sum |x_{k+1} - x_k|^2: at most samples(d).
  double ratio(std::size_t d) const { return squares_ > 0 ? -work_[d] / (bound_ * squares_) : 0; }

  /// Energy returned with d samples of delay over all that the device dissipates: at most 1.
  double exhausted(std::size_t d) const {
    const double damped = samples(d, relaxing_) * bound_ * squares_;
    const double rubbed = 0.5 * std::sqrt(3.0) * bound_ * resolution_ * path_;
    return path_ > 0 ? -work_[d] / (damped + rubbed) : 0;
  }

  std::array<double, kDelays> lowest{};  ///< J: least balance at any time so far

 private:
  Vec3 reported(Vec3 x) const {
    if (resolution_ > 0)
      for (double& value : x) value = resolution_ * std::round(value / resolution_);
    return x;
  }
  void account(const Vec3& travel) {
    squares_ += dot(travel, travel);
    path_ += norm(travel);
    const double rubbed = 0.5 * std::sqrt(3.0) * bound_ * resolution_ * path_;
    for (std::size_t d = 0; d < kDelays; ++d) {
      work_[d] += dot(force_[d], travel);
      const double damped = samples(d, relaxing_) * bound_ * squares_;
      lowest[d] = std::min(lowest[d], work_[d] + damped + rubbed);
    }
  }

  WatchedContact& contact_;
  double bound_, resolution_, relaxing_;
  Vec3 last_{};
  bool begun_ = false;
  std::array<Vec3, kDelays> force_{};  ///< f_k, f_{k-1}, ...
  std::array<double, kDelays> work_{};
  double squares_ = 0;  ///< m^2
  double path_ = 0;     ///< m
};

/// One sample moved: anew, or by nanometres up to centimetres, or all samples alike.
std::vector<Vec3> varied(std::vector<Vec3> motion, const Library& library, Random& random) {
  const Vec3 shift = std::pow(10, between(random, -6, -2)) * random_unit(random);
  Vec3& one = motion[random() % motion.size()];
  const auto kind = random() % 8;
  if (kind == 0) {
    one = near_surface(library, random, between(random, -0.008, 0.002));
  } else if (kind == 1) {
    for (Vec3& x : motion) x = x + shift;
  } else if (kind == 2) {
    one = motion[random() % motion.size()];
  } else {
    one = one + shift;
  }
  return motion;
}

/// To and fro along the press direction of a vertex, at constant speed, deep enough to stay in
/// contact.
std::vector<Vec3> stab(const Library& library, Random& random, std::size_t samples) {
  const std::size_t v = random() % library.positions.size();
  const double low = between(random, 0.002, 0.006), high = low + between(random, 0.0005, 0.003);
  std::vector<Vec3> motion;
  for (std::size_t i = 0; i < samples; ++i) {
    const double s = 2 * static_cast<double>(i) / static_cast<double>(samples);
    const double depth = low + (s < 1 ? s : 2 - s) * (high - low);
    motion.push_back(library.positions[v] + depth * library.inward[v]);
  }
  return motion;
}

struct Annealed {
  /// Best: energy over damping with one sample of delay, or over all dissipation without delay.
  double ratio = 0;
  std::array<double, SampledLoop::kDelays> lowest{};  ///< J, of all tries
};

/// From where a contact with x begins: 1 mm above the surface there.
Vec3 outside(const Vec3& x, const palpate_library& body) {
  const runtime::SurfacePoint p = body.tree.nearest(x, 1);
  return body.surface.position(p) - 0.001 * body.surface.normal(p);
}

/// Simulated annealing for the closed motion, repeated, that returns most energy per damping.
Annealed anneal(const Library& library, const palpate_library& body,
                const ContactSettings& settings, double lipschitz_bound, int tries,
                double resolution = 0, double relaxing = 0) {
  constexpr int kRepeats = 30, kStarts = 100;
  constexpr std::size_t kSamples = 16;
  Random random(21);
  Annealed found;
  const auto play_samples = [&](const std::vector<Vec3>& motion) {
    WatchedContact contact(library, body, settings);
    SampledLoop loop(contact, lipschitz_bound, resolution, relaxing);
    loop.step(outside(motion.front(), body));
    for (int r = 0; r < kRepeats; ++r)
      for (const Vec3& x : motion) loop.step(x);
    for (std::size_t d = 0; d < SampledLoop::kDelays; ++d)
      found.lowest[d] = std::min(found.lowest[d], loop.lowest[d]);
    return resolution > 0 ? loop.exhausted(0) : loop.ratio(1);
  };
  std::vector<Vec3> now;
  double reached = -1;
  for (int i = 0; i < kStarts; ++i) {
    const std::vector<Vec3> start = stab(library, random, kSamples);
    const double ratio = play_samples(start);
    if (ratio <= reached) continue;
    now = start;
    reached = ratio;
  }
  for (int i = 0; i < tries; ++i) {
    const double temperature = 0.01 * std::pow(1e-3, static_cast<double>(i) / tries);
    const std::vector<Vec3> next = varied(now, library, random);
    const double ratio = play_samples(next);
    found.ratio = std::max(found.ratio, ratio);
    if (between(random, 0, 1) >= std::exp((ratio - reached) / temperature)) continue;
    now = next;
    reached = ratio;
  }
  return found;
}

class SampledAdversary : public CertifiedBody {
 protected:
  /// relaxing_factor times the largest sum of g_i.
  double relaxing() const {
    double largest = 0;
    for (const NodeResponse& node : library_.responses) {
      double sum = 0;
      for (const float g : node.relaxation) sum += static_cast<double>(g);
      largest = std::max(largest, sum);
    }
    return relaxing_factor(GetParam().friction) * largest;
  }
};

TEST_P(SampledAdversary, AnAnnealedMotionGetsNoEnergyPastTheDampingOfTheTheorem) {
  const double bound = library_.certificate.min_lipschitz_bound;
  const Annealed found = anneal(library_, body_, settings(bound), bound, 400, 0, relaxing());
  for (std::size_t d = 0; d < SampledLoop::kDelays; ++d) EXPECT_GE(found.lowest[d], -1e-12) << d;
  EXPECT_LE(found.ratio, SampledLoop::samples(1, relaxing()));
  EXPECT_GT(found.ratio, 0);  // it does get energy out of the samples
}

TEST_P(SampledAdversary, AnAnnealedMotionGetsNoneFromQuantizedPositionsEither) {
  const double bound = library_.certificate.min_lipschitz_bound;
  for (const double resolution : {1e-5, 1e-3}) {
    const Annealed found =
        anneal(library_, body_, settings(bound), bound, 250, resolution, relaxing());
    for (const double lowest : found.lowest) EXPECT_GE(lowest, -1e-12) << resolution;
    EXPECT_GT(found.ratio, 0);
  }
}

TEST(AnnealedMotion, NearlyNeedsTheDampingOfTheTheoremOnAPlateOfLinearSprings) {
  Library springs = plate(4, 0.04, [](const Vec3&) {
    NodeResponse node = wall_response(200, 200);
    node.normal = node.lateral = linear_curve(200);
    return node;
  });
  springs = certified(springs, 0);
  const palpate_library body(springs);
  ASSERT_NEAR(body.lipschitz_bound, 200, 1e-3);
  const Annealed found = anneal(springs, body, {0, 0, EnergyBudget::Enforced, 200}, 200, 3000);
  for (std::size_t d = 0; d < SampledLoop::kDelays; ++d) EXPECT_GE(found.lowest[d], -1e-12) << d;
  EXPECT_LE(found.ratio, 1.5);
  EXPECT_GT(found.ratio, 1.15);
}

INSTANTIATE_TEST_SUITE_P(Bodies, SampledAdversary, adversary_cases(), case_name);

}  // namespace
}  // namespace palpate::test
