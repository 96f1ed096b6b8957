// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <memory>

#include "mesher/volume/domain.hpp"
#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

/// Answers about a domain of surfaces, by exact predicates; crossings lie on the triangles.
/// @param domain with all closed surfaces oriented outward; copied
/// @param thinnest m: a segment that passes through a thinner body crosses nothing
std::unique_ptr<Oracle> make_oracle(const Domain& domain, double thinnest);

}  // namespace palpate::mesher
