// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/history_model.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/relaxation/hereditary.hpp"

namespace palpate::calibrate {
namespace {

using Jet = ceres::Jet<double, 3 + 2 * static_cast<int>(kMostTerms)>;

/// Between samples the travel is linear in time. The elastic force is made linear over parts of it
/// of this fraction of the largest travel.
constexpr double kPart = 0.01;

template <class T>
T elastic_of(const BodyConstants<T>& c, double x) {
  if (!(x > 0)) return T(0);
  using std::pow;
  return c.force * pow(T(x), c.exponent) * (T(1) + c.second_power * (T(x) - T(1)));
}

double value_of(double v) {
  return v;
}
double value_of(const Jet& v) {
  return v.a;
}

/// x of an elastic force. The power law is inverted; Newton's method brings in the second power.
template <class T>
T depth_of(const BodyConstants<T>& c, const T& force) {
  if (!(value_of(force) > 0)) return T(0);
  using std::log;
  using std::pow;
  T x = pow(force / c.force, T(1) / c.exponent);
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps && value_of(c.second_power) > 0; ++i) {
    // In logarithms the curve is nearly straight: no step overshoots.
    const T bracket = T(1) + c.second_power * (x - T(1));
    const T off = log(c.force * pow(x, c.exponent) * bracket / force);
    x = x * pow(T(2.718281828459045), -off / (c.exponent + c.second_power * x / bracket));
    if (std::abs(value_of(off)) < 1e-14 && i > 2) break;
  }
  return x;
}

}  // namespace

HistoryModel::HistoryModel(const RelaxationRecord& record, double largest_travel)
    : record_(record), largest_travel_(largest_travel) {
  const auto& m = measured();
  scale_ = std::abs(*std::max_element(m.begin(), m.end()));
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    const double x = record.travel[i] / largest_travel;
    if (i > 0 && !record.force_is_held) {
      const double t0 = record.time[i - 1], x0 = record.travel[i - 1] / largest_travel;
      const int parts = static_cast<int>(std::ceil(std::abs(x - x0) / kPart));
      for (int k = 1; k < parts; ++k) {
        time_.push_back(t0 + (record.time[i] - t0) * k / parts);
        depth_.push_back(x0 + (x - x0) * k / parts);
      }
    }
    sample_.push_back(time_.size());
    time_.push_back(record.time[i]);
    depth_.push_back(x);
  }
}

template <class T>
std::vector<T> HistoryModel::predicted(const BodyConstants<T>& c) const {
  const PronySeries<T> series{c.fraction, c.time};
  std::vector<T> out;
  out.reserve(sample_.size());
  if (record_.force_is_held) {
    for (const T& e : elastic_force(time_, record_.force, series))
      out.push_back(largest_travel_ * depth_of(c, e));
    return out;
  }
  std::vector<T> elastic;
  elastic.reserve(time_.size());
  for (const double x : depth_) elastic.push_back(elastic_of(c, x));
  const std::vector<T> force = hereditary_force(time_, elastic, series);
  for (const std::size_t i : sample_) out.push_back(value_of(force[i]) > 0 ? force[i] : T(0));
  return out;
}

std::vector<double> HistoryModel::predict(const BodyConstants<double>& c) const {
  return predicted(c);
}

void HistoryModel::differentiate(const BodyConstants<double>& c, double* r,
                                 std::vector<double>& slopes) const {
  const std::size_t terms = c.fraction.size(), n = columns(terms);
  BodyConstants<Jet> jets{Jet(c.force, 0), Jet(c.exponent, 1), Jet(c.second_power, 2), {}, {}};
  for (std::size_t i = 0; i < terms; ++i) {
    jets.fraction.emplace_back(c.fraction[i], static_cast<int>(3 + i));
    Jet time(c.time[i]);
    time.v[static_cast<Eigen::Index>(3 + terms + i)] = c.time[i];  // d tau/d ln tau
    jets.time.push_back(time);
  }
  const std::vector<Jet> values = predicted(jets);
  slopes.resize(values.size() * n);
  for (std::size_t i = 0; i < values.size(); ++i) {
    r[i] = (values[i].a - measured()[i]) / scale_;
    for (std::size_t k = 0; k < n; ++k)
      slopes[i * n + k] = values[i].v[static_cast<Eigen::Index>(k)] / scale_;
  }
}

std::vector<double> HistoryModel::elastic(double exponent) const {
  std::vector<double> out;
  for (const double travel : record_.travel)
    out.push_back(elastic_of<double>({1, exponent, 0, {}, {}}, travel / largest_travel_));
  return out;
}

std::vector<double> HistoryModel::memory(double exponent, double time) const {
  std::vector<double> e, out;
  e.reserve(depth_.size());
  for (const double x : depth_) e.push_back(elastic_of<double>({1, exponent, 0, {}, {}}, x));
  const std::vector<double> m = hereditary_force<double>(time_, e, {{1}, {time}});
  for (const std::size_t i : sample_) out.push_back(m[i]);
  return out;
}

}  // namespace palpate::calibrate
