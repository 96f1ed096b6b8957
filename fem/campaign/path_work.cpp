// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/path_work.hpp"

#include <cmath>

namespace palpate::fem {

std::vector<double> running_integral(const std::vector<double>& x, const std::vector<double>& y) {
  // Integral over [x1, x2] of the parabola through three samples that include x1 and x2.
  const auto piece = [&](std::size_t a, std::size_t b, std::size_t other) {
    const double h = x[b] - x[a];
    const double curvature =
        ((y[other] - y[a]) / (x[other] - x[a]) - (y[b] - y[a]) / h) / (x[other] - x[b]);
    return 0.5 * h * (y[a] + y[b]) - curvature * h * h * h / 6;
  };
  std::vector<double> sum(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) {
    double step = 0.5 * (x[i] - x[i - 1]) * (y[i] + y[i - 1]);
    const bool before = i >= 2, after = i + 1 < x.size();
    if (before && after)
      step = 0.5 * (piece(i - 1, i, i - 2) + piece(i - 1, i, i + 1));
    else if (before)
      step = piece(i - 1, i, i - 2);
    else if (after)
      step = piece(i - 1, i, i + 1);
    sum[i] = sum[i - 1] + step;
  }
  return sum;
}

double first_increment_work(const std::vector<double>& s, const std::vector<double>& f,
                            double otherwise) {
  if (s.size() < 3 || !(f[1] > 0 && f[2] > f[1])) return otherwise;
  const double exponent = std::log(f[2] / f[1]) / std::log(s[2] / s[1]);
  return exponent < 1 || exponent > 2.5 ? otherwise : f[1] * s[1] / (1 + exponent);
}

void fill_work(CurvePath& path, double start, const std::vector<std::optional<double>>& found) {
  std::vector<double> s, f;
  for (const auto& sample : path.samples) {
    s.push_back(sample.displacement);
    f.push_back(dot(sample.force, path.direction));
  }
  const auto through = running_integral(s, f);
  path.samples.front().tool_work = start;
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const auto known = i <= found.size() ? found[i - 1] : std::nullopt;
    double between = through[i] - through[i - 1];
    if (path.kind == PathKind::Normal && i == 1) between = first_increment_work(s, f, between);
    path.samples[i].tool_work = path.samples[i - 1].tool_work + known.value_or(between);
  }
}

}  // namespace palpate::fem
