// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/slingshot.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::app {

using namespace slingshot;

namespace {

constexpr double kWindow = 0.5;     // s
constexpr double kRest = 2e-3;      // m/s
constexpr double kDrift = 2e-5;     // m/s
constexpr double kLongest = 400;    // s
constexpr double kGrown = 1.5;      // of the energy of the release
constexpr std::size_t kMeanOf = 5;  // windows

/// Watches the velocity in windows and decides whether the oscillation lasts.
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

/// Energy of device and band, J; what the body stores comes on top.
double energy_of(const SlingDevice& device, double x, double v) {
  const double stretch = device.anchor - x;
  return (device.mass * v * v + device.band * stretch * stretch) / 2;
}

/// Waits for `seconds` after `begin`. @return whether that was more than `tolerated` (s) ago.
bool wait_until(std::chrono::steady_clock::time_point begin, double seconds, double tolerated) {
  const std::chrono::duration<double> due(seconds);
  std::this_thread::sleep_until(begin + due);
  return std::chrono::steady_clock::now() - begin > due + std::chrono::duration<double>(tolerated);
}

}  // namespace

SlingshotOutcome sling(const SlingshotSetup& setup, double k, bool keep_path) {
  LineOfTouch line(setup, k);
  const SlingDevice& d = setup.device;
  runtime::SimulatedDevice device({d.mass, d.damping, d.friction, d.band, 0, 1});
  device.place({published::kRelease, 0, 0}, {});
  device.set_target({d.anchor, 0, 0}, {});
  Verdict verdict(setup.rate);
  SlingshotOutcome outcome;
  const double period = 1 / setup.rate;
  const auto begin = std::chrono::steady_clock::now();
  const double released = energy_of(d, published::kRelease, 0);
  while (outcome.seconds < kLongest && !verdict.at_rest() && !verdict.steady()) {
    const double x = device.position()[0];
    const double v = device.velocity()[0];
    if (line.body() && energy_of(d, x, v) > kGrown * released) return outcome;
    if (keep_path) outcome.path.push_back({x, v});
    if (x > 0 && outcome.impact == 0) outcome.impact = v;
    device.step(period, {-line.force(x), 0, 0});
    verdict.see(v);
    outcome.seconds += period;
    ++outcome.steps;
    if (setup.real_time) outcome.late += wait_until(begin, outcome.seconds, period) ? 1 : 0;
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

}  // namespace palpate::app
