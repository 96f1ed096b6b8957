// SPDX-License-Identifier: AGPL-3.0-or-later
// The page bundled at build time from app/report/page, cut where the report is put in.
#pragma once

#include <string_view>

namespace palpate::report {

std::string_view page_before_title();
std::string_view page_before_data();
std::string_view page_after_data();

}  // namespace palpate::report
