// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/energy_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "app/experiment/line_of_touch.hpp"

namespace palpate::app {

using namespace slingshot;

namespace {

/// (34) or (35): force, slope and energy at a deflection.
struct Response {
  double force = 0, slope = 0, energy = 0;
};

Response response_at(double k, double d) {
  if (d <= 0) return {};
  if (d < kCurved) return {wall_force(k, d), 200 * k * d, 100 * k * d * d * d / 3};
  return {wall_force(k, d), k, k * (d * d / 2 - kCurved * d / 2 + kCurved * kCurved / 6)};
}

/// A body at a fixed contact point along a line at an angle to its normal: two springs, and
/// the band.
class BondedBody {
 public:
  BondedBody(const SlingDevice& device, double k, double angle)
      : device_(device), k_(k), cos_(std::cos(angle)), sin_(std::sin(angle)) {
    double low = 0, high = device_.anchor;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (at(middle).force < device_.band * (device_.anchor - middle) ? low : high) = middle;
    }
    rest_ = high;
  }

  /// Force and slope of the body without the band, along the line.
  Response at(double x) const {
    const Response n = response_at(k_, cos_ * x);
    const Response t = response_at(k_, sin_ * x);
    return {cos_ * n.force + sin_ * t.force, cos_ * cos_ * n.slope + sin_ * sin_ * t.slope,
            n.energy + t.energy};
  }
  /// With the band, J.
  double potential(double x) const {
    return at(x).energy + device_.band * (x - device_.anchor) * (x - device_.anchor) / 2;
  }
  double rest() const { return rest_; }  ///< m, where band and body balance

  /// No swing is larger than the one that the release begins.
  bool within_release(double turn) const {
    return potential(turn) <= potential(published::kRelease);
  }
  double gain_of_swing(double period, double turn) const;

 private:
  SlingDevice device_;
  double k_, cos_, sin_;
  double rest_ = 0;
};

/// Energy that one swing gains, J: the conservative orbit that turns back at depth `turn`.
double BondedBody::gain_of_swing(double period, double turn) const {
  constexpr int kPoints = 2000;
  const double energy = potential(turn);
  double low = published::kRelease, high = rest_;  // the other turning point lies between
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (potential(middle) > energy ? low : high) = middle;
  }
  // x = m + r cos(phi): the velocity vanishes like sin(phi) at both ends, so the integrand is
  // smooth.
  const double m = (turn + high) / 2;
  const double r = (turn - high) / 2;
  double gain = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double phi = std::numbers::pi * (i + 0.5) / kPoints;
    const double x = m + r * std::cos(phi);
    const double v = std::sqrt(std::max(0.0, 2 * (energy - potential(x)) / device_.mass));
    const double slope = at(x).slope;  // the band is no sample of ours
    const double dx = r * std::sin(phi) * std::numbers::pi / kPoints;
    gain += 2 * ((1.5 * period * slope - device_.damping) * v - device_.friction) *
            dx;  // dt = dx/v, both ways
  }
  return gain;
}

}  // namespace

double bonded_margin_by_energy_balance(const SlingDevice& device, double rate, double angle) {
  const auto best_gain = [&](double k) {
    const BondedBody body(device, k, angle);
    double best = -1;
    for (double turn = body.rest() + 5e-4; body.within_release(turn); turn += 1e-4) {
      best = std::max(best, body.gain_of_swing(1 / rate, turn));
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

namespace {

/// Half a swing between two turning points of a conservative force: position over time.
class Swing {
 public:
  /// force: against the motion, at equal distances from `low` to `turn`, band included. The lower
  /// turning point is where the work up to `turn` vanishes: beyond `low` only if the swing is wider
  /// than that, then one step further is taken.
  Swing(const SlingDevice& device, const std::vector<double>& force, double low, double turn)
      : device_(device) {
    const std::size_t last = force.size() - 1;
    const double dx = (turn - low) / static_cast<double>(last);
    std::vector<double> x{turn}, v{0};
    double kinetic = 0;  // J
    for (std::size_t i = last; i-- > 0;) {
      const double before = kinetic;
      kinetic += (force[i] + force[i + 1]) / 2 * dx;
      const double here = low + static_cast<double>(i) * dx;
      if (kinetic <= 0) {
        x.push_back(here + dx * -kinetic / (before - kinetic));
        v.push_back(0);
        break;
      }
      x.push_back(here);
      v.push_back(std::sqrt(2 * kinetic / device.mass));
    }
    if (v.back() > 0) {
      x.push_back(low - std::clamp(kinetic / std::max(-force[0], 1e-9), 1e-5, 2e-3));
      v.push_back(0);
    }
    position_.assign(x.rbegin(), x.rend());
    velocity_.assign(v.rbegin(), v.rend());
    time_.assign(1, 0.0);
    for (std::size_t i = 1; i < position_.size(); ++i)
      time_.push_back(time_.back() +
                      2 * (position_[i] - position_[i - 1]) / (velocity_[i] + velocity_[i - 1]));
  }

  bool is_one() const { return position_.size() > 5; }
  double low() const { return position_.front(); }
  double period() const { return 2 * time_.back(); }
  /// There and back, again and again.
  double at(double time) const {
    time = std::fmod(time, period());
    time = std::min(time, period() - time);
    const auto after = std::upper_bound(time_.begin() + 1, time_.end() - 1, time);
    const auto j = static_cast<std::size_t>(after - time_.begin());
    const double s = time - time_[j - 1];
    const double a = (velocity_[j] - velocity_[j - 1]) / (time_[j] - time_[j - 1]);
    return position_[j - 1] + (velocity_[j - 1] + a * s / 2) * s;
  }
  /// What damping and dry friction of the device take in a period, J.
  double loss() const {
    double sum = 0;
    for (std::size_t i = 1; i < position_.size(); ++i) {
      const double v = (velocity_[i] + velocity_[i - 1]) / 2;
      sum += 2 * (device_.damping * v + device_.friction) * (position_[i] - position_[i - 1]);
    }
    return sum;
  }

 private:
  SlingDevice device_;
  std::vector<double> position_, velocity_, time_;
};

/// The swing of the mass between the body and the band that turns at depth `turn`; none when it
/// would begin beyond the release. The force is felt slowly, there and back, until the contact and
/// the lower turning point have settled.
std::optional<Swing> settled_swing(LineOfTouch& line, const SlingDevice& device, double turn) {
  constexpr int kPoints = 800, kPasses = 5;
  double low = published::kRelease;
  std::optional<Swing> swing;
  for (int pass = 0; pass < kPasses; ++pass) {
    const double dx = (turn - low) / kPoints;
    std::vector<double> force(kPoints + 1);
    for (int i = 0; i <= kPoints; ++i)
      force[static_cast<std::size_t>(i)] = line.force(low + i * dx);
    for (int i = kPoints; i >= 0; --i) {
      double& f = force[static_cast<std::size_t>(i)];
      f = (f + line.force(low + i * dx)) / 2 + device.band * (low + i * dx - device.anchor);
    }
    swing.emplace(device, force, low, turn);
    low = swing->low();
    if (!swing->is_one() || low < published::kRelease) return {};
  }
  return swing;
}

/// Energy that the device gains in a period when the swing is played to the force loop, its forces
/// held and a sample late, J.
double gain_of_played(LineOfTouch& line, const Swing& swing, double rate) {
  constexpr int kSettling = 2, kPlayed = 6;  // periods
  const double dt = 1 / rate;
  const auto samples = [&](double periods) { return std::llround(periods * swing.period() / dt); };
  const long long first = samples(kSettling), last = first + samples(kPlayed);
  double work = 0, commanded = 0;
  for (long long n = 0; n < last; ++n) {
    const double now = static_cast<double>(n) * dt;
    const double force = line.force(swing.at(now));
    if (n >= first) work -= commanded * (swing.at(now + dt) - swing.at(now));
    commanded = force;
  }
  return work / kPlayed - swing.loss();
}

/// The most that a swing of any depth gains, J.
double best_played_gain(const SlingshotSetup& setup, double k) {
  constexpr double kShallowest = 0.009, kStep = 4e-4;  // m
  double best = -1;
  for (double turn = kShallowest; turn < setup.device.anchor; turn += kStep) {
    LineOfTouch line(setup, k);
    const auto swing = settled_swing(line, setup.device, turn);
    if (swing) best = std::max(best, gain_of_played(line, *swing, setup.rate));
    if (!swing && turn > 2 * kShallowest) break;
  }
  return best;
}

}  // namespace

double margin_by_played_swings(const SlingshotSetup& setup) {
  double low = 100, high = 600;
  while (high - low > 0.5) {
    const double middle = (low + high) / 2;
    (best_played_gain(setup, middle) > 0 ? high : low) = middle;
  }
  return (low + high) / 2;
}

}  // namespace palpate::app
