// SPDX-License-Identifier: Apache-2.0
#include "format/foreign_hdf5.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "format/error.hpp"
#include "format/hdf5_handle.hpp"
#include "format/matrix_path.hpp"

namespace palpate::hdf5 {
namespace {

/// More numbers than that are no record, and would not fit the memory of a small machine.
constexpr hsize_t kMostValues = 100'000'000;
constexpr std::size_t kMostNames = 12;

/// Where a message belongs: the column, its file.
std::string place_of(const std::filesystem::path& file, const std::string& path) {
  return file.string() + ", " + hdf5::quoted(path);
}

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* list) {
  auto& names = *static_cast<std::vector<std::string>*>(list);
  names.emplace_back(name);
  return names.size() < kMostNames ? 0 : 1;
}

std::string names_in(hid_t group) {
  std::vector<std::string> names;
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names);
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + hdf5::quoted(name);
  if (names.size() == kMostNames) text += ", ...";
  return text.empty() ? "nothing" : text;
}

/// A data set and the part of the path that lies inside it: the member of a compound type.
struct Found {
  Handle dataset;
  std::string member;
};

bool has_link(hid_t group, const std::string& name) {
  return H5Lexists(group, name.c_str(), H5P_DEFAULT) > 0 &&
         H5Oexists_by_name(group, name.c_str(), H5P_DEFAULT) > 0;
}

/// The end of a name before each separator, the longest first: names may contain dots.
std::vector<std::size_t> ends_of_name(const std::string& path) {
  std::vector<std::size_t> ends{path.size()};
  for (std::size_t i = path.size(); i-- > 1;)
    if (path[i] == '/' || path[i] == '.') ends.push_back(i);
  return ends;
}

/// Follows a path from a group on. Where it does not lead, `at` names the last group that exists
/// and `there` what it holds.
Found follow(hid_t group, const std::string& path, std::string& at, std::string& there) {
  there = names_in(group);
  for (const std::size_t end : ends_of_name(path)) {
    const std::string name = path.substr(0, end);
    if (name.empty() || name.find('/') != std::string::npos || !has_link(group, name)) continue;
    const std::string rest = end < path.size() ? path.substr(end + 1) : "";
    Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (!object) continue;
    const H5I_type_t type = H5Iget_type(object.get());
    if (type == H5I_DATASET) return {std::move(object), rest};
    if (type != H5I_GROUP) continue;
    at += "/" + name;
    return follow(object.get(), rest, at, there);
  }
  return {};
}

Found find(hid_t file, const std::string& base, const std::string& where) {
  std::string at, there;
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  const std::size_t first = std::min(base.find_first_not_of('/'), base.size());
  Found found = follow(root.get(), base.substr(first), at, there);
  if (found.dataset) return found;
  refuse(where, "there is no such data set",
         (at.empty() ? "the file" : hdf5::quoted(at)) + " holds " + there);
}

std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1)
    return "";
  if (H5Tis_variable_str(type.get()) > 0) {
    const Handle memory(H5Tcopy(type.get()), H5Tclose);
    char* text = nullptr;
    if (H5Aread(attribute.get(), memory.get(), &text) < 0 || text == nullptr) return "";
    std::string value(text);
    H5free_memory(text);
    return value;
  }
  std::string value(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), value.data()) < 0) return "";
  return value.substr(0, std::min(value.find('\0'), value.size()));
}

std::string unit_of(hid_t dataset) {
  for (const char* name : {"units", "unit", "Units", "Unit"})
    if (std::string unit = text_attribute(dataset, name); !unit.empty()) return unit;
  return "";
}

void check_numbers(hid_t type, const std::string& where) {
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_INTEGER || kind == H5T_FLOAT) return;
  if (kind == H5T_REFERENCE)
    refuse(where, "it holds references, as cells and arrays of structs of MATLAB do",
           "store each column as a plain array, or save with -v7");
  if (kind == H5T_STRING) refuse(where, "it holds texts", "name a data set of numbers");
  refuse(where, "it does not hold numbers", "name a data set of numbers");
}

/// A type in memory that takes one member alone, or all of a plain data set.
Handle memory_type(hid_t stored, const std::string& member, const std::string& where) {
  if (H5Tget_class(stored) != H5T_COMPOUND) {
    if (!member.empty())
      refuse(where, "the data set has no members", "leave " + hdf5::quoted(member) + " out");
    check_numbers(stored, where);
    return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
  }
  std::string names;
  for (int i = 0; i < H5Tget_nmembers(stored); ++i) {
    const std::unique_ptr<char, herr_t (*)(void*)> name(
        H5Tget_member_name(stored, static_cast<unsigned>(i)), H5free_memory);
    names += (names.empty() ? "" : ", ") + hdf5::quoted(name.get());
    if (member != name.get()) continue;
    const Handle type(H5Tget_member_type(stored, static_cast<unsigned>(i)), H5Tclose);
    check_numbers(type.get(), where);
    Handle memory(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    H5Tinsert(memory.get(), name.get(), 0, H5T_NATIVE_DOUBLE);
    return memory;
  }
  refuse(where, member.empty() ? "the data set is a table of members" : "it has no such member",
         "name one after a dot: " + names);
}

/// The extents that are not 1, in the order of the reader: MATLAB stores columns first.
struct Extents {
  std::vector<hsize_t> stored;
  bool transposed = false;
};

Extents extents_of(hid_t dataset, hid_t space, const std::string& where) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) refuse(where, "it is a single value", "name a data set with a value for each row");
  Extents extents;
  extents.stored.resize(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, extents.stored.data(), nullptr);
  extents.transposed = H5Aexists(dataset, "MATLAB_class") > 0;
  return extents;
}

/// The one extent of a row of numbers, whatever the number of extents that are 1.
bool is_line(const std::vector<hsize_t>& extents) {
  return std::count_if(extents.begin(), extents.end(), [](hsize_t n) { return n != 1; }) <= 1;
}

/// Selects what the path chooses, and says how many values that are.
hsize_t select(hid_t space, const Extents& extents, const MatrixPath& path,
               const std::string& where) {
  const std::vector<hsize_t>& n = extents.stored;
  if (!path.chosen()) {
    if (is_line(n)) return static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
    refuse(where, "it is a table, not a column",
           "choose a column: " + hdf5::quoted(path.base + "(:,1)"));
  }
  if (n.size() != 2)
    refuse(where, "it is no table of rows and columns", "name it without the parentheses");
  const bool column = path.column > 0;
  const std::size_t across = column != extents.transposed ? 1 : 0;
  const auto index = static_cast<hsize_t>(column ? path.column : path.row);
  if (index > n[across])
    refuse(where,
           "there is no " + std::string(column ? "column " : "row ") + std::to_string(index) +
               ", the table has " + std::to_string(n[across]),
           "count from 1");
  hsize_t start[2] = {0, 0}, count[2] = {n[0], n[1]};
  start[across] = index - 1;
  count[across] = 1;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
  return n[1 - across];
}

/// HDF5 reads zeros, with success, where nothing was written and where another file is missing.
void check_storage(hid_t dataset, const std::string& where) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  const bool outside = layout == H5D_VIRTUAL || H5Pget_external_count(creation.get()) > 0;
  if (outside) refuse(where, "its values lie in other files", "copy them into one file (h5repack)");
  H5D_space_status_t status = H5D_SPACE_STATUS_ALLOCATED;
  H5Dget_space_status(dataset, &status);
  if (status != H5D_SPACE_STATUS_ALLOCATED && layout != H5D_COMPACT)
    refuse(where, "some of its values were never written", "record or store it again");
}

std::vector<double> read_values(hid_t dataset, const MatrixPath& path, const std::string& member,
                                const std::string& where) {
  // MATLAB stores characters as whole numbers.
  if (text_attribute(dataset, "MATLAB_class") == "char")
    refuse(where, "it holds texts", "name a data set of numbers");
  const Handle stored(H5Dget_type(dataset), H5Tclose);
  const Handle memory = memory_type(stored.get(), member, where);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Extents extents = extents_of(dataset, space.get(), where);
  const hsize_t count = select(space.get(), extents, path, where);
  if (count == 0) refuse(where, "it is empty", "name a data set with a value for each row");
  if (count > kMostValues)
    refuse(where, "it has " + std::to_string(count) + " values, more than a record",
           "store the part that is needed");
  check_storage(dataset, where);
  std::vector<double> values(count);
  const Handle line(H5Screate_simple(1, &count, nullptr), H5Sclose);
  if (H5Dread(dataset, memory.get(), line.get(), space.get(), H5P_DEFAULT, values.data()) < 0)
    refuse(where, "it cannot be read (" + last_hdf5_message() + ")",
           "the file may be damaged or cut off: copy it again");
  return values;
}

}  // namespace

bool is_hdf5(const std::filesystem::path& file) {
  const Session session;
  return H5Fis_hdf5(file.c_str()) > 0;
}

ForeignColumn read_foreign_column(const std::filesystem::path& file, const std::string& path) {
  const Session session;
  const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!opened)
    refuse(file.string(), "the HDF5 file cannot be opened (" + last_hdf5_message() + ")",
           "it may be cut off, or still be written: copy it again");
  const std::string where = place_of(file, path);
  const MatrixPath parsed = matrix_path(path, where);
  const Found found = find(opened.get(), parsed.base, where);
  ForeignColumn column{read_values(found.dataset.get(), parsed, found.member, where),
                       unit_of(found.dataset.get())};
  check_finite(column.values, where);
  return column;
}

}  // namespace palpate::hdf5
