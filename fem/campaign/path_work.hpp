// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool along a path.
#pragma once

#include <optional>
#include <vector>

#include "format/curves.hpp"

namespace palpate::fem {

/// Integral of y over x by parabolas through neighbouring samples, third-order accurate for uneven
/// steps; running value at each sample.
std::vector<double> running_integral(const std::vector<double>& x, const std::vector<double>& y);

/// Integral from 0 to s[1] of the power law through (s[1], f[1]) and (s[2], f[2]), where the
/// samples suggest one, else `otherwise`. A contact that grows from a point starts like a power law
/// (Hertz: 3/2), which no parabola follows.
double first_increment_work(const std::vector<double>& s, const std::vector<double>& f,
                            double otherwise);

/// Fills tool_work, J, starting from `start`. `found`: the work of each increment as the solver
/// integrated it, without the first sample; where empty, the integral of force . direction through
/// the samples.
void fill_work(CurvePath& path, double start, const std::vector<std::optional<double>>& found);

}  // namespace palpate::fem
