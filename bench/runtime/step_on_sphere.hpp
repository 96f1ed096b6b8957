// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <benchmark/benchmark.h>

namespace palpate::bench {

/// The force step of the C interface along a trajectory, on the octasphere of range(0) divisions
/// with decoupled (range(1) = 0) or coupled (1) responses; 2 and 3: the same with three relaxation
/// times, whose fractions differ from node to node; 4 and 5: coupled ones, elastic and relaxing,
/// that lean and have soft axes, as `palpate fit` makes them. range(2): the motion.
void step_on_sphere(benchmark::State& state);

}  // namespace palpate::bench
