// SPDX-License-Identifier: AGPL-3.0-or-later
// The keys by which a sidecar or a fit file chooses the table of a record.
#pragma once

#include "app/case/describe/case.hpp"
#include "fitting/measurement/records/table_file.hpp"

namespace palpate::app {

template <class V>
void describe_table_choice(V& v, measured::TableChoice& s) {
  v.integer(s.table, {"table", "which table of the file, from 1; needed when it has several",
                      kOptional, kNotNegative});
  v.text(s.sheet, {"sheet", "of a workbook; needed when it has several"});
  v.text(s.range, {"range",
                   "cells of the sheet, header included: \"B4:E900\" or \"B:E\"; of other files "
                   "rows of numbers, from 1: \"120:900\", \"120:\""});
}

}  // namespace palpate::app
