// SPDX-License-Identifier: AGPL-3.0-or-later
// The numbers of a DataArray of a VTK XML file, in any of the encodings of that format.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::mesher {

/// How the numbers of a file are encoded [VTK file formats, "XML file formats"].
struct VtkEncoding {
  bool is_swapped = false;       ///< big-endian
  std::size_t header_bytes = 4;  ///< of each count before the data
  bool is_compressed = false;    ///< by zlib, in blocks
  bool appended_is_base64 = false;
  std::string_view appended;  ///< behind the underscore
};

/// What a DataArray element says of itself.
struct VtkArrayText {
  std::string type;    ///< "Float64", ...
  std::string format;  ///< "ascii", "binary", "appended"
  std::string_view text;
  std::size_t offset = 0;  ///< into the appended data
};

/// The numbers of the array. @param count how many there must be; where it is not given, any
/// @throws Error(Geometry) at `where`; nothing is allocated that the file cannot hold.
std::vector<double> numbers_of(const VtkArrayText& array, const VtkEncoding& encoding,
                               std::optional<std::size_t> count, const std::string& where);

}  // namespace palpate::mesher
