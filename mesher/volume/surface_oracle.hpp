// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <memory>

#include "mesher/volume/domain.hpp"
#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

/// Answers about a domain of surfaces, by exact predicates: a segment that crosses a triangle is
/// never missed, and the crossing lies on the triangle.
/// @param domain with all closed surfaces oriented outward; copied
/// @param step along which a segment is searched for grazing contact with the wall of a layer, m
std::unique_ptr<Oracle> make_oracle(const Domain& domain, double step);

}  // namespace palpate::mesher
