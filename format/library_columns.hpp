// SPDX-License-Identifier: Apache-2.0
// The tables of a response library, for every kind of file.
#pragma once

#include <tuple>

#include "format/column.hpp"
#include "format/library.hpp"

namespace palpate {

inline constexpr auto kResponseColumns = std::make_tuple(
    column("status", &NodeResponse::status, "1", "0 fitted, 1 interpolated, 2 hole.",
           rules::up_to(2, "a status (0, 1 or 2)")),
    column("normal_error", &NodeResponse::normal_error, "N",
           "Largest |fit - sample| of the normal curve.", rules::kNonNegative),
    column("lateral_error", &NodeResponse::lateral_error, "N",
           "Largest |fit - sample| of the lateral curve.", rules::kNonNegative));

inline constexpr auto kTriangleColumns = std::make_tuple(
    column("stick", &TriangleCertificate::stick, "N/m",
           "L_stick, largest Jacobian norm with the contact point fixed.", rules::kBound),
    column("slip", &TriangleCertificate::slip, "N/m",
           "L_slip, Lipschitz bound along the path while sliding.", rules::kBound),
    column("kappa", &TriangleCertificate::kappa, "1/m", "Bound on the turning rate of n.",
           rules::kBound),
    column("cos_theta", &TriangleCertificate::cos_theta, "1",
           "Cosine of the worst angle between n and the facet normal.", rules::kCosine),
    column("sliding_passive", &TriangleCertificate::sliding_passive, "1",
           "1 where sliding needs no energy correction.", rules::kFlag));

inline constexpr auto kDeviceColumns = std::make_tuple(
    column("damping", &DeviceCertificate::damping, "N s/m",
           "Smallest damping singular value sigma_0(B).", rules::kKnownBound),
    column("lowest_rate", &DeviceCertificate::lowest_rate, "Hz",
           "Rate from which on damping makes up for hold and delay.", rules::kKnownBound),
    column("linear_limit", &DeviceCertificate::linear_limit, "N/m",
           "Stiffest linear wall at 1 kHz with one sample of delay, 2 b/(3 T).",
           rules::kKnownBound),
    column("no_delay_limit", &DeviceCertificate::no_delay_limit, "N/m",
           "Stiffest linear wall at 1 kHz without delay, 2 b/T.", rules::kKnownBound),
    column("coulomb_friction", &DeviceCertificate::coulomb_friction, "N",
           "Smallest dry friction sigma_0(S).", rules::kKnownBound, true),
    column("delay", &DeviceCertificate::delay, "s", "Delay beyond that of the loop.",
           rules::kKnownBound, true),
    column("position_resolution", &DeviceCertificate::position_resolution, "m",
           "Step of the reported position along an axis.", rules::kKnownBound, true),
    column("force_resolution", &DeviceCertificate::force_resolution, "N",
           "Step of the force along an axis.", rules::kKnownBound, true),
    column("published_rate", &DeviceCertificate::published_rate, "Hz",
           "2 L/sigma_0(B), of Mahvash & Hayward 2005, eq. 5.", rules::kKnownBound, true),
    column("largest_position_step", &DeviceCertificate::largest_position_step, "m",
           "Largest position_resolution that dry friction certifies.", rules::kKnownBound, true));

}  // namespace palpate
