// SPDX-License-Identifier: Apache-2.0
// The curves of one site as bytes, for the journal of a campaign and for digests.
#pragma once

#include <string>
#include <string_view>

#include "format/curves.hpp"

namespace palpate {

/// Little-endian, the fields in the order of their declaration, each list after its length; the
/// isochoric energies of relaxing tissue follow all others, after the number of regions.
std::string site_bytes(const SiteCurves& site);

/// The reverse. @throws Error(Configuration) named after `where` when the bytes are not a site.
SiteCurves site_from_bytes(std::string_view bytes, const std::string& where);

/// SHA-256 of the results: the tool, the depths and the curves, without provenance and processor
/// times, so that it is equal for two campaigns exactly when their results are.
std::string content_sha256(const Curves& curves);

}  // namespace palpate
