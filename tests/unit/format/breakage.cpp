// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/format/breakage.hpp"

#include <fstream>
#include <utility>

#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::samples {
namespace {

void write_sample(Kind kind, const Path& path) {
  switch (kind) {
    case Kind::Body:
      return write_body(path, body(1));
    case Kind::SprungBody:
      return write_body(path, sprung_body(1));
    case Kind::CurvedBody:
      return write_body(path, curved_body(1));
    case Kind::Curves:
      return write_curves(path, curves(1));
    case Kind::Library:
      return write_library(path, library(1));
    case Kind::CoupledLibrary:
      return write_library(path, coupled_library(1));
    case Kind::RelaxingLibrary:
      return write_library(path, relaxing_library(1));
    case Kind::SoftLibrary:
      return write_library(path, soft_library(1));
    case Kind::Recording:
      return write_recording(path, recording(1));
  }
}

}  // namespace

void copy_sample(Kind kind, const Path& path) {
  static const TemporaryFolder originals;
  const Path original = originals / std::to_string(static_cast<int>(kind));
  if (!std::filesystem::exists(original)) write_sample(kind, original);
  std::filesystem::copy_file(original, path, std::filesystem::copy_options::overwrite_existing);
}

void read_sample(Kind kind, const Path& path) {
  switch (kind) {
    case Kind::Body:
    case Kind::SprungBody:
    case Kind::CurvedBody:
      static_cast<void>(read_body(path));
      return;
    case Kind::Curves:
      static_cast<void>(read_curves(path));
      return;
    case Kind::Library:
    case Kind::CoupledLibrary:
    case Kind::RelaxingLibrary:
    case Kind::SoftLibrary:
      static_cast<void>(read_library(path));
      return;
    case Kind::Recording:
      static_cast<void>(read_recording(path));
      return;
  }
}

Break edit(std::function<void(Hdf5Editor&)> change) {
  return [change = std::move(change)](const Path& path) {
    Hdf5Editor editor(path);
    change(editor);
  };
}
Break poke(const std::string& object, std::size_t position, double value) {
  return edit([=](Hdf5Editor& e) { e.poke(object, position, value); });
}
Break replace(const std::string& object, std::vector<hsize_t> extent, hid_t type, double value) {
  return edit([=](Hdf5Editor& e) { e.replace(object, extent, type, value); });
}
Break remove(const std::string& object) {
  return edit([=](Hdf5Editor& e) { e.remove(object); });
}
Break real(const std::string& object, const std::string& name, double value) {
  return edit([=](Hdf5Editor& e) { e.set_attribute(object, name, value, H5T_NATIVE_DOUBLE); });
}
Break content(const std::string& text) {
  return [=](const Path& path) { std::ofstream(path, std::ios::binary) << text; };
}

void swap_corners(const Path& path) {
  const Tetrahedron first = body(1).tetrahedra[0];
  Hdf5Editor editor(path);
  editor.poke("/tetrahedra", 0, first[1]);
  editor.poke("/tetrahedra", 1, first[0]);
}

void truncate_half(const Path& path) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
}

void PrintTo(const Case& broken, std::ostream* out) {
  *out << broken.name;
}

std::string name_of(const testing::TestParamInfo<Case>& param) {
  return param.param.name;
}

}  // namespace palpate::samples
