// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/slab_table.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <thread>

#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

constexpr double kShearModulus = 1000;  ///< Pa, of the presses

/// Extremes of Chebyshev's polynomial [Trefethen 2013, ch. 2], ascending.
std::vector<double> chebyshev(double low, double high, int count) {
  std::vector<double> points;
  for (int i = 0; i < count; ++i)
    points.push_back(0.5 * (low + high) -
                     0.5 * (high - low) * std::cos(std::numbers::pi * i / (count - 1)));
  return points;
}

/// Lagrange's basis at x, with its derivatives.
struct Basis {
  std::vector<double> value, slope;
};

Basis basis_at(const std::vector<double>& points, double x) {
  Basis basis;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double value = 1, slope = 0;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j == k) continue;
      const double width = points[k] - points[j];
      slope = slope * (x - points[j]) / width + value / width;
      value *= (x - points[j]) / width;
    }
    basis.value.push_back(value);
    basis.slope.push_back(slope);
  }
  return basis;
}

void check(const SlabTableSettings& s) {
  if (!(s.law.low < s.law.high))
    refuse("stiffening", "the range is none", "give two ascending numbers");
  if (!(s.thickness_low < s.thickness_high))
    refuse("thickness", "the range is none", "give two ascending lengths");
  if (!(s.thickness_low > s.depths.back()))
    refuse("thickness",
           "slabs from " + length_text(s.thickness_low) + " on are pressed by " +
               length_text(s.depths.back()),
           "begin the range above the deepest press");
}

/// Calls `task` for 0 to count - 1 on several threads; the first exception is thrown again.
void in_parallel(int threads, int count, const std::function<void(int)>& task) {
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex lock;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard guard(lock);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int t = 1; t < std::min(threads, count); ++t) workers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

/// By finite elements.
std::vector<double> pressed(const SlabTableSettings& settings, double stiffening,
                            double thickness) {
  const fem::SlabPress press{settings.tool, settings.friction,
                             settings.law.at(kShearModulus, stiffening, settings.poisson),
                             thickness, settings.depths};
  fem::SlabForces found = fem::press_slab(press);
  if (found.force.size() < settings.depths.size())
    refuse("press of a slab of " + length_text(thickness) + " with " + settings.law.stiffening +
               " = " + number_text(stiffening),
           found.reason.empty() ? "it did not reach its depth" : found.reason,
           "narrow the ranges of thickness and stiffening");
  for (double& force : found.force) force /= kShearModulus;
  return found.force;
}

}  // namespace

fem::LawConstants StiffeningLaw::at(double shear_modulus, double number, double poisson) const {
  if (name == "yeoh")
    return {name,
            {{"C10", 0.5 * shear_modulus},
             {"C20", 0.5 * shear_modulus * number},
             {"C30", 0},
             {"poisson", poisson}}};
  if (name == "veronda-westmann")
    return {name, {{"C1", shear_modulus / number}, {"C2", number}, {"poisson", poisson}}};
  const std::string stress = name == "ogden-1" ? "mu_1" : "mu";
  return {name, {{stress, shear_modulus}, {stiffening, number}, {"poisson", poisson}}};
}

StiffeningLaw stiffening_law(const std::string& name) {
  for (const StiffeningLaw& law :
       {StiffeningLaw{"demiray-fung", "b", 0.01, 5}, StiffeningLaw{"ogden-1", "alpha_1", -25, -1},
        StiffeningLaw{"veronda-westmann", "C2", 0.01, 5}, StiffeningLaw{"yeoh", "C20/C10", 0, 5}})
    if (law.name == name) return law;
  refuse("law '" + name + "'", "it does not have one stress and one number",
         "choose demiray-fung, ogden-1, veronda-westmann or yeoh");
}

SlabTable::SlabTable(const SlabTableSettings& settings)
    : SlabTable(settings, [&settings](double stiffening, double thickness) {
        return pressed(settings, stiffening, thickness);
      }) {}

SlabTable::SlabTable(const SlabTableSettings& settings, const Press& press) : settings_(settings) {
  check(settings_);
  stiffening_ = chebyshev(settings_.law.low, settings_.law.high, settings_.stiffenings);
  inverse_thickness_ =
      chebyshev(1 / settings_.thickness_high, 1 / settings_.thickness_low, settings_.thicknesses);
  const std::size_t depths = settings_.depths.size(), columns = inverse_thickness_.size();
  const std::size_t all = stiffening_.size() * columns;
  log_force_.resize(all * depths);
  int done = 0;
  std::mutex lock;
  in_parallel(settings_.threads, static_cast<int>(all), [&](int task) {
    const auto i = static_cast<std::size_t>(task);
    const std::vector<double> force =
        press(stiffening_[i / columns], 1 / inverse_thickness_[i % columns]);
    for (std::size_t d = 0; d < depths; ++d) log_force_[i * depths + d] = std::log(force[d]);
    const std::lock_guard guard(lock);
    if (settings_.advanced) settings_.advanced(++done, static_cast<int>(all));
  });
  check_between_points(press);
}

void SlabTable::check_between_points(const Press& press) {
  const auto middle = [](const std::vector<double>& points) {
    const std::size_t i = points.size() / 2;
    return 0.5 * (points[i - 1] + points[i]);
  };
  const double c = middle(stiffening_), s = middle(inverse_thickness_);
  const std::vector<double> force = press(c, 1 / s);
  for (std::size_t d = 0; d < force.size(); ++d)
    error_ = std::max(error_, std::abs(at(d, c, s).value / force[d] - 1));
}

SlabTable::Force SlabTable::at(std::size_t depth, double stiffening,
                               double inverse_thickness) const {
  const Basis by_c = basis_at(stiffening_, stiffening);
  const Basis by_s = basis_at(inverse_thickness_, inverse_thickness);
  double log_force = 0, by_stiffening = 0, by_inverse = 0;
  for (std::size_t i = 0; i < stiffening_.size(); ++i)
    for (std::size_t j = 0; j < inverse_thickness_.size(); ++j) {
      const double known =
          log_force_[(i * inverse_thickness_.size() + j) * settings_.depths.size() + depth];
      log_force += by_c.value[i] * by_s.value[j] * known;
      by_stiffening += by_c.slope[i] * by_s.value[j] * known;
      by_inverse += by_c.value[i] * by_s.slope[j] * known;
    }
  const double force = std::exp(log_force);
  return {force, force * by_stiffening, force * by_inverse};
}

}  // namespace palpate::app
