// SPDX-License-Identifier: AGPL-3.0-or-later
// What the identification of a device sees: positions and commands, sample by sample.
#pragma once

#include <cstddef>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::identify {

/// One excitation along one axis. The command of a row was computed from its position. Rows before
/// the first jump are of the sines, those from it on of the square wave.
struct MotionRecord {
  std::size_t axis = 0;           ///< excited: 0, 1 or 2
  std::vector<double> time;       ///< (N) s, increasing
  std::vector<Vec3> position;     ///< (N) m
  std::vector<Vec3> command;      ///< (N) N, constant until the command of the next row replaces it
  std::vector<std::size_t> jump;  ///< rows whose command reverses the square wave

  std::size_t sine_rows() const { return jump.empty() ? time.size() : jump.front(); }
};

}  // namespace palpate::identify
