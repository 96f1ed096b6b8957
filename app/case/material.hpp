// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "app/case/case.hpp"
#include "fem/laws/law_table.hpp"

namespace palpate::app {

/// The law that a [[material]] table declares.
fem::LawConstants law_of(const MaterialSection& material);

}  // namespace palpate::app
