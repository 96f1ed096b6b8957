// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {

/// Kinds of numbers in images.
enum class VoxelType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float, Double };

inline std::size_t bytes_of(VoxelType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// The number at the start of the bytes.
inline double voxel_at(std::string_view bytes, VoxelType type, bool swapped) {
  switch (type) {
    case VoxelType::Int8:
      return Scanner::decoded<std::int8_t>(bytes, swapped);
    case VoxelType::UInt8:
      return Scanner::decoded<std::uint8_t>(bytes, swapped);
    case VoxelType::Int16:
      return Scanner::decoded<std::int16_t>(bytes, swapped);
    case VoxelType::UInt16:
      return Scanner::decoded<std::uint16_t>(bytes, swapped);
    case VoxelType::Int32:
      return Scanner::decoded<std::int32_t>(bytes, swapped);
    case VoxelType::UInt32:
      return Scanner::decoded<std::uint32_t>(bytes, swapped);
    case VoxelType::Int64:
      return static_cast<double>(Scanner::decoded<std::int64_t>(bytes, swapped));
    case VoxelType::UInt64:
      return static_cast<double>(Scanner::decoded<std::uint64_t>(bytes, swapped));
    case VoxelType::Float:
      return Scanner::decoded<float>(bytes, swapped);
    case VoxelType::Double:
      return Scanner::decoded<double>(bytes, swapped);
  }
  return 0;
}

/// A voxel as a label. @throws Error(Geometry) for a value that is no integer of 32 bits.
inline std::int32_t label_of(double value, std::size_t voxel, const std::string& where) {
  constexpr double largest = std::numeric_limits<std::int32_t>::max();
  if (std::abs(value) <= largest && value == std::round(value))
    return static_cast<std::int32_t>(value);
  refuse_geometry(where, text("voxel ", voxel, " has the value ", value, ", which is no label"),
                  "give a segmentation: an image of whole numbers, 0 outside");
}

}  // namespace palpate::mesher
