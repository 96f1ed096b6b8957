// SPDX-License-Identifier: AGPL-3.0-or-later
// Changes single things of a file with the bare HDF5 API, to see what the readers make of it.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::samples {

class Hdf5Editor {
 public:
  explicit Hdf5Editor(const std::filesystem::path& path)
      : file_(checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT))) {}
  ~Hdf5Editor() { H5Fclose(file_); }
  Hdf5Editor(const Hdf5Editor&) = delete;
  Hdf5Editor& operator=(const Hdf5Editor&) = delete;

  hid_t file() const { return file_; }

  void remove(const std::string& object) { checked(H5Ldelete(file_, object.c_str(), H5P_DEFAULT)); }

  /// Overwrite one number of a dataset, counted through all its dimensions.
  template <class T>
  void poke(const std::string& object, std::size_t position, T value, hid_t type) {
    const hid_t dataset = checked(H5Dopen2(file_, object.c_str(), H5P_DEFAULT));
    const hid_t space = H5Dget_space(dataset);
    std::vector<T> all(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    checked(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
    all.at(position) = value;
    checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
    H5Sclose(space);
    H5Dclose(dataset);
  }
  void poke(const std::string& object, std::size_t position, double value) {
    poke(object, position, value, H5T_NATIVE_DOUBLE);
  }

  /// A dataset of another shape or type in the place of the old one, of the same units, its data
  /// all `value`.
  void replace(const std::string& object, const std::vector<hsize_t>& extent, hid_t type,
               double value = 0) {
    const bool has_units = has_attribute(object, "units");
    const std::string units = has_units ? text(object, "units") : "";
    remove(object);
    const hid_t space = dataspace(extent);
    const hid_t dataset = checked(
        H5Dcreate2(file_, object.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    const std::vector<double> data(count, value);
    checked(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()));
    H5Dclose(dataset);
    H5Sclose(space);
    if (has_units) add_text(object, "units", units.c_str());
  }

  /// A dataset that claims `extent` but holds nothing, stored as `properties` say.
  void claim(const std::string& object, const std::vector<hsize_t>& extent, hid_t type,
             hid_t properties = H5P_DEFAULT) {
    remove(object);
    const hid_t space = dataspace(extent);
    H5Dclose(checked(
        H5Dcreate2(file_, object.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT)));
    H5Sclose(space);
  }

  template <class T>
  void set_attribute(const std::string& object, const std::string& name, T value, hid_t type) {
    remove_attribute(object, name);
    add_attribute(object, name, value, type);
  }
  bool has_attribute(const std::string& object, const std::string& name) const {
    return H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
  }
  void remove_attribute(const std::string& object, const std::string& name) {
    checked(H5Adelete_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT));
  }
  void set_text(const std::string& object, const std::string& name, const char* value) {
    remove_attribute(object, name);
    add_text(object, name, value);
  }
  std::string text(const std::string& object, const std::string& name) {
    const hid_t type = text_type();
    const hid_t attribute =
        checked(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
    char* value = nullptr;
    checked(H5Aread(attribute, type, static_cast<void*>(&value)));
    std::string result = value == nullptr ? "" : value;
    H5free_memory(value);
    H5Aclose(attribute);
    H5Tclose(type);
    return result;
  }

 private:
  template <class T>
  void add_attribute(const std::string& object, const std::string& name, T value, hid_t type) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = checked(H5Acreate_by_name(
        file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    checked(H5Awrite(attribute, type, &value));
    H5Aclose(attribute);
    H5Sclose(space);
  }
  static hid_t text_type() {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
  }
  void add_text(const std::string& object, const std::string& name, const char* value) {
    const hid_t type = text_type();
    add_attribute(object, name, value, type);
    H5Tclose(type);
  }

  template <class T>
  static T checked(T result) {
    if (result < 0) throw std::runtime_error("the test's own HDF5 call failed");
    return result;
  }
  static hid_t dataspace(const std::vector<hsize_t>& extent) {
    return checked(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  }

  hid_t file_;
};

}  // namespace palpate::samples
