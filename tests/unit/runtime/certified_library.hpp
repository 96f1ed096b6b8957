// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "format/library.hpp"

namespace palpate::test {

/// The library with its certificate at a friction coefficient. Each test is a process, and the
/// certificate of a body takes many times as long as what most of them do with it: it is kept in a
/// file beside the program, which counts as long as it is younger than the program.
Library certified(Library library, double friction);

}  // namespace palpate::test
