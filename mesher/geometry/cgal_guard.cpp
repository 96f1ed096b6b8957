// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/cgal_guard.hpp"

#include <CGAL/exceptions.h>

#include "format/error.hpp"

namespace palpate::mesher {

void guard_cgal(const std::string& where, const std::string& remedy,
                const std::function<void()>& work) {
  try {
    work();
  } catch (const CGAL::Failure_exception& failure) {
    const std::string reason = failure.message().empty() ? failure.expression() : failure.message();
    refuse_geometry(where, "a geometric computation fails: " + reason, remedy);
  }
}

}  // namespace palpate::mesher
