// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include "format/hdf5_handle.hpp"
#include "format/regular_file.hpp"
#include "format/seal.hpp"

namespace palpate::hdf5 {
namespace {

namespace fs = std::filesystem;

// Deflate cannot do better than 1032 : 1; a dataset that claims more is a bomb or never written.
constexpr double kLargestCompression = 1032;

std::string shape_text(const std::vector<hsize_t>& extent) {
  std::string text = "(";
  for (const hsize_t size : extent) text += (text.size() > 1 ? ", " : "") + std::to_string(size);
  return text + ")";
}

/// Same class, size and sign; the order of the bytes may differ, HDF5 converts it.
bool same_number(hid_t stored, hid_t wanted) {
  if (H5Tget_class(stored) != H5Tget_class(wanted)) return false;
  if (H5Tget_size(stored) != H5Tget_size(wanted)) return false;
  if (H5Tget_precision(stored) != H5Tget_precision(wanted)) return false;
  return H5Tget_class(stored) != H5T_INTEGER || H5Tget_sign(stored) == H5Tget_sign(wanted);
}

/// "1, 3 and 4"
std::string listed(std::initializer_list<std::int64_t> values) {
  std::string text;
  for (const std::int64_t* value = values.begin(); value != values.end(); ++value) {
    if (value != values.begin()) text += value + 1 == values.end() ? " and " : ", ";
    text += std::to_string(*value);
  }
  return text;
}

void require_readable_file(const fs::path& path, const std::string& remedy) {
  const auto fail = [&](const std::string& problem, const std::string& advice) {
    throw Error(ErrorKind::Configuration, path.string(), problem, advice);
  };
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) fail("does not exist", "check the path, or " + remedy);
  require_regular_file(path, "check the path, or " + remedy);
  if (!std::ifstream(path, std::ios::binary)) {
    fail("cannot be read (" + std::generic_category().message(errno) + ")",
         "check its permissions");
  }
  if (fs::file_size(path, problem) == 0) fail("is empty (0 bytes)", remedy);
}

std::vector<hsize_t> extent_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

}  // namespace

struct Reader::State {
  Session session;
  fs::path path;
  std::string remedy;
  Handle file;
  unsigned long file_number = 0;

  [[noreturn]] void fail(const std::string& object, const std::string& problem) const {
    throw Error(ErrorKind::Configuration, path.string() + ":" + object, problem, remedy);
  }
  Handle open_dataset(const std::string& object) const;
  void require_plain_number(const std::string& object, hid_t dataset, Scalar scalar) const;
  void require_present(const std::string& object, hid_t dataset, double bytes) const;
  std::size_t require_shape(const std::string& object, hid_t dataset, std::size_t rows,
                            std::size_t columns) const;
  Handle open_attribute(const std::string& object, const std::string& name) const;
  std::vector<std::string> attribute_texts(const std::string& object,
                                           const std::string& name) const;
  template <class T>
  T attribute_number(const std::string& object, const std::string& name, hid_t native,
                     std::initializer_list<H5T_class_t> allowed) const;
  std::vector<std::string> take_texts(const std::string& object, std::vector<char*>& pointers,
                                      hid_t type, hid_t space) const;
};

Handle Reader::State::open_dataset(const std::string& object) const {
  if (H5Lexists(file.get(), object.c_str(), H5P_DEFAULT) <= 0) fail(object, "is missing");
  Handle dataset(H5Dopen2(file.get(), object.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) fail(object, "is not a readable dataset (" + last_hdf5_message() + ")");
  H5O_info_t info;
  if (H5Oget_info2(dataset.get(), &info, H5O_INFO_BASIC) < 0 || info.fileno != file_number) {
    fail(object, "is kept in another file by a link");
  }
  return dataset;
}

void Reader::State::require_plain_number(const std::string& object, hid_t dataset,
                                         Scalar scalar) const {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  if (!type || !same_number(type.get(), native_type(scalar))) {
    fail(object, std::string("has the wrong type, ") + name_of(scalar) + " expected");
  }
}

void Reader::State::require_present(const std::string& object, hid_t dataset, double bytes) const {
  if (bytes == 0) return;
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  if (layout == H5D_VIRTUAL || H5Pget_external_count(properties.get()) != 0) {
    fail(object, "is kept in another file (virtual or external storage)");
  }
  const bool filtered = H5Pget_nfilters(properties.get()) > 0;
  const double stored = static_cast<double>(H5Dget_storage_size(dataset));
  if (stored * (filtered ? kLargestCompression : 1.0) < bytes) {
    fail(object, "claims more data than the file holds");
  }
  if (layout != H5D_CHUNKED) return;
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const std::vector<hsize_t> extent = extent_of(space.get());
  std::vector<hsize_t> chunk(extent.size());
  H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
  hsize_t wanted = 1;
  for (std::size_t i = 0; i < extent.size(); ++i) wanted *= (extent[i] + chunk[i] - 1) / chunk[i];
  hsize_t present = 0;
  if (H5Dget_num_chunks(dataset, space.get(), &present) < 0 || present != wanted) {
    fail(object, "was never written completely");
  }
}

std::size_t Reader::State::require_shape(const std::string& object, hid_t dataset, std::size_t rows,
                                         std::size_t columns) const {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const std::vector<hsize_t> extent = extent_of(space.get());
  const bool rank_fits = H5Sget_simple_extent_type(space.get()) == H5S_SIMPLE &&
                         extent.size() == (columns > 0 ? 2U : 1U);
  const bool fits = rank_fits && (rows == kAnyRows || extent[0] == rows) &&
                    (columns == 0 || extent[1] == columns);
  if (!fits) {
    const std::string wanted_rows = rows == kAnyRows ? "any" : std::to_string(rows);
    fail(object, "has shape " + shape_text(extent) + ", (" + wanted_rows +
                     (columns > 0 ? ", " + std::to_string(columns) : "") + ") expected");
  }
  return static_cast<std::size_t>(extent[0]);
}

Handle Reader::State::open_attribute(const std::string& object, const std::string& name) const {
  if (object != "/" && H5Lexists(file.get(), object.c_str(), H5P_DEFAULT) <= 0) {
    fail(object, "is missing");
  }
  if (H5Aexists_by_name(file.get(), object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) {
    fail(object, "attribute " + quoted(name) + " is missing");
  }
  Handle attribute(
      H5Aopen_by_name(file.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (!attribute) {
    fail(object, "attribute " + quoted(name) + " is not readable (" + last_hdf5_message() + ")");
  }
  return attribute;
}

std::vector<std::string> Reader::State::take_texts(const std::string& object,
                                                   std::vector<char*>& pointers, hid_t type,
                                                   hid_t space) const {
  std::vector<std::string> texts;
  texts.reserve(pointers.size());
  for (const char* pointer : pointers) texts.emplace_back(pointer == nullptr ? "" : pointer);
  if (!pointers.empty() && H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data()) < 0) {
    fail(object, "its texts cannot be released (" + last_hdf5_message() + ")");
  }
  return texts;
}

std::vector<std::string> Reader::State::attribute_texts(const std::string& object,
                                                        const std::string& name) const {
  const Handle attribute = open_attribute(object, name);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (H5Tget_class(stored.get()) != H5T_STRING || H5Tis_variable_str(stored.get()) <= 0 ||
      count < 0) {
    fail(object, "attribute " + quoted(name) + " is not a text of variable length");
  }
  // HDF5 itself bounds the data of such an attribute to 64 KiB.
  std::vector<char*> pointers(static_cast<std::size_t>(count), nullptr);
  const Handle type(H5Tcopy(stored.get()), H5Tclose);
  if (count > 0 && H5Aread(attribute.get(), type.get(), pointers.data()) < 0) {
    fail(object, "attribute " + quoted(name) + " is not readable (" + last_hdf5_message() + ")");
  }
  return take_texts(object, pointers, type.get(), space.get());
}

template <class T>
T Reader::State::attribute_number(const std::string& object, const std::string& name, hid_t native,
                                  std::initializer_list<H5T_class_t> allowed) const {
  const Handle attribute = open_attribute(object, name);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const H5T_class_t found = H5Tget_class(stored.get());
  const bool is_number = std::find(allowed.begin(), allowed.end(), found) != allowed.end();
  T value{};
  if (!is_number || H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), native, &value) < 0) {
    fail(object, "attribute " + quoted(name) + " is not a single number");
  }
  return value;
}

Reader::Reader(fs::path file, std::string remedy) : state_(std::make_unique<State>()) {
  state_->path = std::move(file);
  state_->remedy = std::move(remedy);
  const fs::path& path = state_->path;
  require_readable_file(path, state_->remedy);
  require_unbroken_seal(path, state_->remedy);
  if (H5Fis_hdf5(path.c_str()) == 0) {
    if (path.extension() == ".toml") {
      throw Error(ErrorKind::Configuration, path.string(), "is a case, not an HDF5 file",
                  "give the file that 'palpate build " + path.string() + "' writes");
    }
    throw Error(ErrorKind::Configuration, path.string(), "is not an HDF5 file", state_->remedy);
  }
  state_->file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!state_->file) {
    const std::string message = last_hdf5_message();
    const bool locking = message.find("unable to lock file") != std::string::npos;
    throw Error(ErrorKind::Configuration, path.string(), "cannot be opened (" + message + ")",
                locking ? "wait for the program that writes it; if there is none, its disk has no "
                          "file locks: set HDF5_USE_FILE_LOCKING=FALSE"
                        : state_->remedy);
  }
  H5O_info_t info;
  if (H5Oget_info2(state_->file.get(), &info, H5O_INFO_BASIC) < 0) fail("/", "is not readable");
  state_->file_number = info.fileno;
}

Reader::~Reader() = default;

const fs::path& Reader::file() const noexcept {
  return state_->path;
}
const std::string& Reader::remedy() const noexcept {
  return state_->remedy;
}
void Reader::fail(const std::string& object, const std::string& problem) const {
  state_->fail(object, problem);
}

std::int64_t Reader::require_artifact(const std::string& artifact,
                                      std::initializer_list<std::int64_t> known) {
  if (H5Aexists(state_->file.get(), "artifact") <= 0) {
    fail("/", "is not a palpate artifact, " + artifact + " expected");
  }
  const std::string found = text("/", "artifact");
  if (found != artifact) fail("/", "holds " + quoted(found) + ", " + artifact + " expected");
  const std::int64_t schema = integer("/", "schema");
  if (std::find(known.begin(), known.end(), schema) != known.end()) return schema;
  const std::string problem =
      "has schema " + std::to_string(schema) + ", this palpate reads " + listed(known);
  const std::string update =
      schema > *(known.end() - 1) ? "update palpate to the version that wrote it, or " : "";
  throw Error(ErrorKind::Configuration, state_->path.string() + ":/", problem,
              update + state_->remedy);
}

bool Reader::has(const std::string& path) const {
  return H5Lexists(state_->file.get(), path.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Reader::children(const std::string& group) const {
  if (!has(group)) fail(group, "is missing");
  const Handle opened(H5Gopen2(state_->file.get(), group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!opened) fail(group, "is not a group");
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* sink) -> herr_t {
    static_cast<std::vector<std::string>*>(sink)->emplace_back(name);
    return 0;
  };
  if (H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names) < 0) {
    fail(group, "cannot be listed (" + last_hdf5_message() + ")");
  }
  return names;
}

std::size_t Reader::checked_rows(const std::string& path, Scalar scalar, std::size_t rows,
                                 std::size_t columns, std::size_t row_bytes) const {
  const Handle dataset = state_->open_dataset(path);
  const std::size_t found = state_->require_shape(path, dataset.get(), rows, columns);
  state_->require_plain_number(path, dataset.get(), scalar);
  state_->require_present(path, dataset.get(),
                          static_cast<double>(found) * static_cast<double>(row_bytes));
  return found;
}

void Reader::require_units(const std::string& path, const std::string& units) const {
  const std::string found = text(path, "units");
  if (found == units) return;
  fail(path + "@units", "is " + quoted(found) + ", " + quoted(units) + " expected");
}

void Reader::get(const std::string& path, Scalar scalar, void* data) const {
  const Handle dataset = state_->open_dataset(path);
  if (data == nullptr) return;
  if (H5Dread(dataset.get(), native_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    fail(path, "cannot be read (" + last_hdf5_message() + ")");
  }
}

void Reader::get_part(const std::string& path, Scalar scalar, std::size_t columns,
                      std::size_t first, std::size_t count, void* data) const {
  if (count == 0) return;
  const Handle dataset = state_->open_dataset(path);
  const Handle stored(H5Dget_space(dataset.get()), H5Sclose);
  const std::array<hsize_t, 2> from{first, 0}, extent{count, columns};
  const Handle here(H5Screate_simple(columns > 0 ? 2 : 1, extent.data(), nullptr), H5Sclose);
  if (H5Sselect_hyperslab(stored.get(), H5S_SELECT_SET, from.data(), nullptr, extent.data(),
                          nullptr) < 0 ||
      H5Dread(dataset.get(), native_type(scalar), here.get(), stored.get(), H5P_DEFAULT, data) <
          0) {
    fail(path, "cannot be read (" + last_hdf5_message() + ")");
  }
}

std::vector<std::string> Reader::texts(const std::string& path, std::size_t rows) const {
  const Handle dataset = state_->open_dataset(path);
  const std::size_t found = state_->require_shape(path, dataset.get(), rows, 0);
  const Handle stored(H5Dget_type(dataset.get()), H5Tclose);
  if (H5Tget_class(stored.get()) != H5T_STRING || H5Tis_variable_str(stored.get()) <= 0) {
    fail(path, "has the wrong type, text of variable length expected");
  }
  state_->require_present(
      path, dataset.get(),
      static_cast<double>(found) * static_cast<double>(H5Tget_size(stored.get())));
  std::vector<char*> pointers(found, nullptr);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle type(H5Tcopy(stored.get()), H5Tclose);
  if (found > 0 &&
      H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0) {
    fail(path, "cannot be read (" + last_hdf5_message() + ")");
  }
  return state_->take_texts(path, pointers, type.get(), space.get());
}

std::string Reader::text(const std::string& object, const std::string& name) const {
  const std::vector<std::string> values = state_->attribute_texts(object, name);
  if (values.size() != 1) fail(object, "attribute " + quoted(name) + " is not a single text");
  return values.front();
}

std::vector<std::string> Reader::text_list(const std::string& object,
                                           const std::string& name) const {
  return state_->attribute_texts(object, name);
}

std::int64_t Reader::integer(const std::string& object, const std::string& name) const {
  return state_->attribute_number<std::int64_t>(object, name, H5T_NATIVE_INT64, {H5T_INTEGER});
}

bool Reader::has_attribute(const std::string& object, const std::string& name) const {
  return has(object) &&
         H5Aexists_by_name(state_->file.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

double Reader::real(const std::string& object, const std::string& name) const {
  return state_->attribute_number<double>(object, name, H5T_NATIVE_DOUBLE,
                                          {H5T_INTEGER, H5T_FLOAT});
}

}  // namespace palpate::hdf5
