// SPDX-License-Identifier: AGPL-3.0-or-later
// The bound a user may set on the memory of a campaign.
#pragma once

#include <string>

namespace palpate::fem {

/// Memory of this process that is in use, bytes.
double resident_bytes();

/// How often `each` bytes, for one `what`, fit beside what is in use now and `kept` for later; at
/// most `wanted`. `bound`: bytes, 0 for none. @throws Error(Configuration) when it is not even
/// once.
int fitting_times(double bound, double each, int wanted, const std::string& what, double kept = 0);

/// @throws Error(Internal), always: there is none for the factor of so many unknowns.
[[noreturn]] void out_of_memory(int unknowns);

}  // namespace palpate::fem
