// SPDX-License-Identifier: AGPL-3.0-or-later
// Raw curves -> compact passive responses. Simulated and measured curves are treated alike.
#pragma once

#include "fitting/response/fit_settings.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Whether a site has a normal response over at least half of the requested depth, and a lateral
/// one: its curves can be fitted.
bool usable(const SiteCurves& site, double depth);

/// Fits the responses of every site. They are monotone, passive and C1 by construction (see
/// ResponseCurve and docs/theory-fitting.md).
/// A site is usable when its normal path reaches half of the requested depth and a lateral path has
/// a sample. Other sites become holes, or are filled on request. Sites without curves become holes,
/// or are interpolated on request.
/// Decoupled: f^r is the mean over azimuths and lateral depths; lateral_error is the largest
/// distance to any single path, so it includes the loss by averaging. Coupled: one f^r and a weight
/// w(z) (see CoupledLateral).
/// Vertices keep their numbers; triangles with a fixed vertex are left out. Deterministic.
/// @throws Error(Configuration) when the curves belong to another body or no site is usable.
Library fit(const Body& body, const Curves& curves, const FitSettings& settings);

}  // namespace palpate::fitting
