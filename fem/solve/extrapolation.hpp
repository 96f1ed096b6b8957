// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::fem {

/// Weights w of the polynomial through values v_i at s_i: its value at `at` is sum w_i v_i
/// [Lagrange]. The s_i are different.
std::vector<double> extrapolation_weights(std::span<const double> s, double at);

}  // namespace palpate::fem
