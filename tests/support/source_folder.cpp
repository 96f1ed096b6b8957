// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/source_folder.hpp"

namespace palpate::test {

std::filesystem::path source_folder() {
  return PALPATE_SOURCE_DIR;
}

}  // namespace palpate::test
