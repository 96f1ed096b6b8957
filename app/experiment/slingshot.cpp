// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/slingshot.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "format/error.hpp"
#include "format/library.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/device_simulated.hpp"
#include "runtime/handles.hpp"
#include "runtime/lockstep_search.hpp"

namespace palpate::app {
namespace {

constexpr double kMass = 0.0845;    // kg
constexpr double kDamping = 0.081;  // N s/m
constexpr double kFriction = 0.01;  // N
constexpr double kBand = 20;        // N/m
constexpr double kAnchor = 0.0584;  // m
constexpr double kRelease = -0.03;  // m
constexpr double kCurved = 0.005;   // m: the wall is quadratic up to here
constexpr double kWindow = 0.5;     // s
constexpr double kRest = 2e-3;      // m/s
constexpr double kDrift = 2e-5;     // m/s
constexpr double kLongest = 400;    // s
constexpr std::size_t kMeanOf = 5;  // windows

constexpr double kRadius = 0.04;          // m
constexpr double kLength = 0.2;           // m
constexpr int kAround = 25, kAlong = 20;  // patches of 10 mm

double wall_force(double k, double x) {
  if (x <= 0) return 0;
  return x < kCurved ? 100 * k * x * x : k * (x - kCurved / 2);
}

NodeResponse response_of(double k) {
  const auto slope = static_cast<float>(k);
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  r.normal = {{0.0F, static_cast<float>(kCurved), 0.02F}, {0.0F, slope, slope}};
  r.lateral = {{0.0F, 0.02F}, {slope, slope}};
  return r;
}

Library cylinder(double k) {
  Library library;
  library.name = "cylinder";
  for (int j = 0; j <= kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vec3 out{std::cos(angle), std::sin(angle), 0};
      library.positions.push_back(kRadius * out + Vec3{0, 0, kLength * j / kAlong});
      library.inward.push_back(-out);
      library.responses.push_back(response_of(k));
    }
  }
  for (int j = 0; j < kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i;
      const int b = j * kAround + (i + 1) % kAround;
      library.triangles.push_back({a, b, b + kAround});
      library.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  return library;
}

/// The body, felt along a line: depth in, force against the motion out.
class LineOfTouch {
 public:
  LineOfTouch(const SlingshotSetup& setup, double k) : setup_(setup), k_(k) {
    if (setup.body == VirtualBody::Wall) return;
    body_ = std::make_unique<palpate_library>(cylinder(k));
    contact_.emplace(body_->surface, body_->tree, runtime::ContactSettings{setup.friction, 5e-3});
    entry_ = std::sqrt(kRadius * kRadius - setup.off_axis * setup.off_axis);
    if (setup.search_rate <= 0) return;
    const auto period = static_cast<int>(std::lround(setup.rate / setup.search_rate));
    search_ = std::make_unique<runtime::LockstepSearch>(body_->surface, body_->tree, period);
  }

  double force(double depth) {
    if (!contact_) return wall_force(k_, depth);
    const Vec3 tip{entry_ - depth, setup_.off_axis, kLength / 2};
    if (search_) {
      search_->step(*contact_, tip);
    } else {
      contact_->step(tip);
    }
    return -contact_->observation().force[0];
  }

 private:
  SlingshotSetup setup_;
  double k_;
  double entry_ = 0;  ///< m, of the line into the undeformed cylinder
  std::unique_ptr<palpate_library> body_;
  std::optional<runtime::ContactState> contact_;
  std::unique_ptr<runtime::LockstepSearch> search_;
};

/// Watches the velocity in windows and says when the swing is decided.
class Verdict {
 public:
  explicit Verdict(double rate) : window_(std::llround(kWindow * rate)) {}

  void see(double velocity) {
    low_ = std::min(low_, velocity);
    high_ = std::max(high_, velocity);
    if (++count_ % window_ != 0) return;
    amplitudes_.push_back((high_ - low_) / 2);
    low_ = high_ = velocity;
  }
  bool at_rest() const { return !amplitudes_.empty() && amplitudes_.back() < kRest; }
  bool steady() const {
    const std::size_t n = amplitudes_.size();
    if (count_ % window_ != 0 || n < 4 * kMeanOf) return false;
    return std::abs(mean(n - kMeanOf) - mean(n - 2 * kMeanOf)) < kDrift;
  }
  double amplitude() const { return amplitudes_.empty() ? 0 : amplitudes_.back(); }

 private:
  double mean(std::size_t from) const {
    double sum = 0;
    for (std::size_t i = from; i < from + kMeanOf; ++i) sum += amplitudes_[i];
    return sum / kMeanOf;
  }

  long long window_;
  long long count_ = 0;
  double low_ = 0, high_ = 0;
  std::vector<double> amplitudes_;
};

}  // namespace

SlingshotOutcome sling(const SlingshotSetup& setup, double k, bool keep_path) {
  LineOfTouch line(setup, k);
  runtime::SimulatedDevice device({kMass, kDamping, kFriction, kBand, 0, 1});
  device.place({kRelease, 0, 0}, {});
  device.set_target({kAnchor, 0, 0}, {});
  Verdict verdict(setup.rate);
  SlingshotOutcome outcome;
  const double period = 1 / setup.rate;
  while (outcome.seconds < kLongest && !verdict.at_rest() && !verdict.steady()) {
    const double x = device.position()[0];
    const double v = device.velocity()[0];
    if (keep_path) outcome.path.push_back({x, v});
    if (x > 0 && outcome.impact == 0) outcome.impact = v;
    device.step(period, {-line.force(x), 0, 0});
    verdict.see(v);
    outcome.seconds += period;
  }
  outcome.decayed = verdict.at_rest();
  outcome.amplitude = verdict.amplitude();
  return outcome;
}

double passivity_margin(const SlingshotSetup& setup, double low, double high, double tolerance) {
  if (!sling(setup, low).decayed || sling(setup, high).decayed) {
    throw Error(
        ErrorKind::Internal, "passivity margin",
        "it does not lie between " + std::to_string(low) + " and " + std::to_string(high) + " N/m",
        "widen the range");
  }
  while (high - low > tolerance) {
    const double middle = (low + high) / 2;
    (sling(setup, middle).decayed ? low : high) = middle;
  }
  return (low + high) / 2;
}

namespace {

/// Of wall and band, J.
double potential(double k, double x) {
  const double wall = x <= 0        ? 0
                      : x < kCurved ? 100 * k * x * x * x / 3
                                    : k * (x * x / 2 - kCurved * x / 2 + kCurved * kCurved / 6);
  return wall + kBand * (x - kAnchor) * (x - kAnchor) / 2;
}

/// Where the band and the wall balance, m.
double potential_minimum(double k) {
  double low = 0, high = kAnchor;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (wall_force(k, middle) < kBand * (kAnchor - middle) ? low : high) = middle;
  }
  return high;
}

/// No swing is larger than the one that the release begins.
bool within_release(double k, double turn) {
  return potential(k, turn) <= potential(k, kRelease);
}

/// Energy that one swing gains, J: the conservative orbit that turns back at depth `turn`.
double gain_of_swing(double k, double period, double turn) {
  constexpr int kPoints = 2000;
  const double energy = potential(k, turn);
  const double rest = potential_minimum(k);
  double low = kRelease, high = rest;  // the other turning point lies between
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (potential(k, middle) > energy ? low : high) = middle;
  }
  // x = m + r cos(phi): the velocity vanishes like sin(phi) at both ends, so the integrand is
  // smooth.
  const double m = (turn + high) / 2;
  const double r = (turn - high) / 2;
  double gain = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double phi = std::numbers::pi * (i + 0.5) / kPoints;
    const double x = m + r * std::cos(phi);
    const double v = std::sqrt(std::max(0.0, 2 * (energy - potential(k, x)) / kMass));
    const double slope = x <= 0        ? 0
                         : x < kCurved ? 200 * k * x
                                       : k;  // the band is no sample of ours
    const double dx = r * std::sin(phi) * std::numbers::pi / kPoints;
    gain += 2 * ((1.5 * period * slope - kDamping) * v - kFriction) * dx;  // dt = dx/v, both ways
  }
  return gain;
}

}  // namespace

double margin_by_energy_balance(double rate) {
  const auto best_gain = [&](double k) {
    double best = -1;
    for (double turn = potential_minimum(k) + 5e-4; within_release(k, turn); turn += 1e-4) {
      best = std::max(best, gain_of_swing(k, 1 / rate, turn));
    }
    return best;
  };
  double low = 10, high = 2000;
  while (high - low > 0.02) {
    const double middle = (low + high) / 2;
    (best_gain(middle) > 0 ? high : low) = middle;
  }
  return (low + high) / 2;
}

}  // namespace palpate::app
