// SPDX-License-Identifier: AGPL-3.0-or-later
// Good files of every kind, and ways to break one thing in them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/format/hdf5_editor.hpp"

namespace palpate::samples {

using Path = std::filesystem::path;
using Break = std::function<void(const Path&)>;

inline const double kNaN = std::numeric_limits<double>::quiet_NaN();
inline const double kInfinity = std::numeric_limits<double>::infinity();

enum class Kind {
  Body,
  SprungBody,
  CurvedBody,
  Curves,
  Library,
  CoupledLibrary,
  RelaxingLibrary,
  SoftLibrary,
  Recording
};

/// Each kind is written once: a test copies it and breaks the copy.
void copy_sample(Kind kind, const Path& path);

/// By the reader of that kind; the data are thrown away.
void read_sample(Kind kind, const Path& path);

Break edit(std::function<void(Hdf5Editor&)> change);
Break poke(const std::string& object, std::size_t position, double value);
Break replace(const std::string& object, std::vector<hsize_t> extent, hid_t type, double value = 0);
Break remove(const std::string& object);
Break real(const std::string& object, const std::string& name, double value);
Break content(const std::string& text);

/// Turns the first tetrahedron of a body inside out.
void swap_corners(const Path& path);
void truncate_half(const Path& path);

/// One broken thing, and what the message must say of it.
struct Case {
  std::string name;
  Kind kind;
  Break damage;
  std::string object;   ///< named in the message
  std::string problem;  ///< part of the message
  std::string remedy = "make it again with";
};

void PrintTo(const Case& broken, std::ostream* out);

/// The sample of each case is read, and refused once it is broken, with a line that names file,
/// object and remedy.
class Rejection : public testing::TestWithParam<Case> {};

std::string name_of(const testing::TestParamInfo<Case>& param);

}  // namespace palpate::samples
