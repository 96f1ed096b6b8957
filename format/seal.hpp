// SPDX-License-Identifier: Apache-2.0
// A digest at the end of a file. HDF5 reads a damaged file as other numbers, or crashes on it: of
// files with one to four damaged bytes, one in fifty ends HDF5 1.10 with a signal or a loop. So the
// seal is looked at before HDF5 looks at the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

/// What to append to `content`: "\npalpate-sha256:<64 hexadecimal digits>\n". HDF5 ignores bytes
/// after its own end, and cuts them off when a program changes the file.
std::string seal_of(std::string_view content);
/// The same where the SHA-256 of the content is known.
std::string seal_of_digest(std::string_view digest);

/// Compare the seal of a file with its content. A file without a seal passes: another program wrote
/// or changed it. @throws Error(Configuration) when they differ, saying `remedy`.
void require_unbroken_seal(const std::filesystem::path& file, const std::string& remedy);

}  // namespace palpate
