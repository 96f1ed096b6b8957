// SPDX-License-Identifier: AGPL-3.0-or-later
// The force of a press along n as it is rendered.
#pragma once

#include "format/library.hpp"

namespace palpate::report {

/// Force along n of a press along n: g, and what the lean adds to it (fitting::LeaningResponse). A
/// curve of the same kind as g, through more knots: within a thousandth of the largest force.
/// Without a lean it is g.
ResponseCurve straight_press(const NodeResponse& node, ResponseKind kind);

}  // namespace palpate::report
