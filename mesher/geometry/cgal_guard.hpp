// SPDX-License-Identifier: AGPL-3.0-or-later
// Failures inside CGAL as errors of the geometry.
#pragma once

#include <functional>
#include <string>

namespace palpate::mesher {

/// Runs the work.
/// @throws Error(Geometry) when an assertion or precondition of CGAL fails in it, which degenerate
///   faces may cause.
void guard_cgal(const std::string& where, const std::string& remedy,
                const std::function<void()>& work);

}  // namespace palpate::mesher
