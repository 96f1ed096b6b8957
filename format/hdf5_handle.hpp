// SPDX-License-Identifier: Apache-2.0
// Common parts of the reader and the writer. Only the .cpp files of this folder include it.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

#include "format/hdf5_file.hpp"

namespace palpate::hdf5 {

/// Owns an HDF5 identifier; negative means none.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }

  void reset() {
    if (id_ >= 0) close_(id_);
    id_ = -1;
  }
  hid_t get() const { return id_; }
  hid_t release() { return std::exchange(id_, -1); }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// While it lives HDF5 belongs to this thread and prints nothing.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
};

/// The innermost message of the last failure, on one line.
std::string last_hdf5_message();

hid_t native_type(Scalar scalar);  ///< in memory
hid_t stored_type(Scalar scalar);  ///< on disk: little-endian, fixed size
const char* name_of(Scalar scalar);
Handle variable_text_type();

/// `text` between quotes, cut when long, with what is not printable replaced: it may come from a
/// hostile file and goes to a terminal.
std::string quoted(const std::string& text);

}  // namespace palpate::hdf5
