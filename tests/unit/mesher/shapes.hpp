// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces of known geometry, written as OFF files for the mesher to read.
#pragma once

#include <filesystem>
#include <string>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher::test {

/// Latitude-longitude sphere.
Surface sphere(const Vec3& centre, double radius, int meridians);

/// Solid cylinder about z from 0 to `length`, flat caps.
Surface cylinder(double radius, double length, int around);

/// Axis-aligned box.
Surface box(const Vec3& low, const Vec3& high);

/// A file in the temporary folder, removed with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// OFF text with every digit, so that the file has exactly the shape.
std::string off_text(const Surface& surface);

}  // namespace palpate::mesher::test
