// SPDX-License-Identifier: Apache-2.0
#include "format/hdf5_handle.hpp"

namespace palpate::hdf5 {
namespace {

std::recursive_mutex& hdf5_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

// With H5E_WALK_UPWARD the first entry is where the failure began, the most telling one.
herr_t take_first(unsigned position, const H5E_error2_t* entry, void* sink) {
  if (position == 0 && entry->desc != nullptr) *static_cast<std::string*>(sink) = entry->desc;
  return 0;
}

}  // namespace

Session::Session() : lock_(hdf5_mutex()) {
  H5open();
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() {
  H5Eset_auto2(H5E_DEFAULT, print_, print_data_);
}

std::string last_hdf5_message() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text.empty() ? "no message" : text;
}

hid_t native_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::Float32:
      return H5T_NATIVE_FLOAT;
    case Scalar::Float64:
      return H5T_NATIVE_DOUBLE;
    case Scalar::Int32:
      return H5T_NATIVE_INT32;
    case Scalar::Int64:
      return H5T_NATIVE_INT64;
    case Scalar::UInt8:
      return H5T_NATIVE_UINT8;
    case Scalar::UInt32:
      return H5T_NATIVE_UINT32;
  }
  return -1;
}

hid_t stored_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::Float32:
      return H5T_IEEE_F32LE;
    case Scalar::Float64:
      return H5T_IEEE_F64LE;
    case Scalar::Int32:
      return H5T_STD_I32LE;
    case Scalar::Int64:
      return H5T_STD_I64LE;
    case Scalar::UInt8:
      return H5T_STD_U8LE;
    case Scalar::UInt32:
      return H5T_STD_U32LE;
  }
  return -1;
}

const char* name_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::Float32:
      return "32-bit float";
    case Scalar::Float64:
      return "64-bit float";
    case Scalar::Int32:
      return "32-bit signed integer";
    case Scalar::Int64:
      return "64-bit signed integer";
    case Scalar::UInt8:
      return "8-bit unsigned integer";
    case Scalar::UInt32:
      return "32-bit unsigned integer";
  }
  return "unknown";
}

Handle variable_text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

std::string quoted(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    result += control ? '?' : c;
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace palpate::hdf5
