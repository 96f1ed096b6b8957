// SPDX-License-Identifier: Apache-2.0
// The curves of one site as bytes: what the journal of a campaign keeps, and what digests are of.
#pragma once

#include <string>
#include <string_view>

#include "format/curves.hpp"

namespace palpate {

/// Little-endian, the fields in the order of their declaration, each list after its length.
std::string site_bytes(const SiteCurves& site);

/// The reverse. @throws Error(Configuration) named after `where` when the bytes are no site.
SiteCurves site_from_bytes(std::string_view bytes, const std::string& where);

/// SHA-256 of what was computed: the tool, the depths and the curves. Neither the provenance nor
/// the processor times are in it, so that two campaigns agree in it exactly when their results do.
std::string content_sha256(const Curves& curves);

}  // namespace palpate
