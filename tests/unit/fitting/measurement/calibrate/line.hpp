// SPDX-License-Identifier: AGPL-3.0-or-later
// A least squares problem whose solution is known in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {

/// y = k x through the origin, with four degrees of freedom.
struct Line {
  std::vector<double> x{1, 2, 3, 4, 5}, y{1.1, 1.8, 3.3, 3.9, 5.2};

  LeastSquares problem(double low = -10, double high = 10) const {
    LeastSquares p;
    p.constants = {{"k", "1", std::clamp(0.0, low, high), low, high}};
    p.residuals = x.size();
    p.model = [this](const double* c, double* r, double* J) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        r[i] = c[0] * x[i] - y[i];
        if (J != nullptr) J[i] = x[i];
      }
      return true;
    };
    return p;
  }
  double xx() const { return std::inner_product(x.begin(), x.end(), x.begin(), 0.0); }
  double best() const { return std::inner_product(x.begin(), x.end(), y.begin(), 0.0) / xx(); }
  double squares(double k) const {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(k * x[i] - y[i], 2);
    return sum;
  }
};

}  // namespace palpate::calibrate
