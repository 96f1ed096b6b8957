// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

namespace palpate::fem {

/// @throws Error(Configuration) naming the constant, its value and its range unless `valid`;
/// `where` names the owner of the constant.
void require_constant(bool valid, const std::string& where, const std::string& name, double value,
                      const std::string& range);

}  // namespace palpate::fem
