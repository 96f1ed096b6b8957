// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include "format/crash_safe_file.hpp"
#include "format/hdf5_handle.hpp"
#include "format/seal.hpp"
#include "format/sha256.hpp"

namespace palpate::hdf5 {
namespace {

constexpr std::size_t kMemoryStep = std::size_t{1} << 20;
constexpr unsigned kDeflateLevel = 4;
/// Bytes from which deflating pays: finding the chunks of a dataset takes some hundreds of bytes.
constexpr std::size_t kWorthDeflating = std::size_t{1} << 10;
/// Half the branches of the trees that find chunks and members of groups. The 32 and 16 of HDF5
/// would take 2 kB a dataset and half a kB a group, as nodes are written whole.
constexpr unsigned kChunkBranches = 4;
constexpr unsigned kMemberBranches = 2;
constexpr unsigned kMembersOfALeaf = 4;

enum class Storage { Contiguous, Deflated };

std::size_t size_of(Scalar scalar) {
  return H5Tget_size(stored_type(scalar));
}

}  // namespace

struct Writer::State {
  /// A dataset that is being written in parts.
  struct Filling {
    Handle dataset;
    hsize_t rows = 0, filled = 0;
  };

  Session session;
  std::filesystem::path target;
  std::optional<CrashSafeFile> disk;  ///< where there is none the file is built in memory
  Handle file;
  std::map<std::string, Filling> fillings;  ///< closed before the file

  [[noreturn]] void fail(const std::string& object) const {
    throw Error(ErrorKind::Internal, target.string() + ":" + object,
                "HDF5 cannot write it (" + last_hdf5_message() + ")",
                "report this as a defect of palpate");
  }
  Handle checked(hid_t id, Handle::Close close, const std::string& object) const {
    if (id < 0) fail(object);
    return {id, close};
  }
  void check(herr_t status, const std::string& object) const {
    if (status < 0) fail(object);
  }
  const char* c_text(const std::string& text, const std::string& object) const {
    if (text.find('\0') != std::string::npos) {
      throw Error(ErrorKind::Internal, target.string() + ":" + object,
                  "a text holds a zero byte and would be cut there",
                  "report this as a defect of palpate");
    }
    return text.c_str();
  }
  void attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                 hid_t memory_type, const void* data) const {
    const std::string where = object + "@" + name;
    const Handle attribute =
        checked(H5Acreate_by_name(file.get(), object.c_str(), name.c_str(), type, space,
                                  H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose, where);
    if (data != nullptr) check(H5Awrite(attribute.get(), memory_type, data), where);
  }
  Handle list_space(std::size_t count, const std::string& where) const {
    const hsize_t extent = count;
    return checked(H5Screate_simple(1, &extent, nullptr), H5Sclose, where);
  }
  Handle file_properties() const;
  Handle creation_properties(const std::string& path, Storage storage,
                             const std::vector<hsize_t>& extent) const;
  Handle make_dataset(const std::string& path, Scalar scalar, std::uint64_t rows,
                      std::size_t columns, Storage storage) const;
};

Handle Writer::State::creation_properties(const std::string& path, Storage storage,
                                          const std::vector<hsize_t>& extent) const {
  Handle properties = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
  check(H5Pset_obj_track_times(properties.get(), false), path);
  if (storage == Storage::Deflated && extent[0] > 0) {
    std::vector<hsize_t> chunk = extent;
    chunk[0] = std::min<hsize_t>(chunk[0], kChunkRows);
    check(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), path);
    check(H5Pset_shuffle(properties.get()), path);
    check(H5Pset_deflate(properties.get(), kDeflateLevel), path);
  }
  return properties;
}

Handle Writer::State::file_properties() const {
  Handle properties = checked(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "/");
  check(H5Pset_istore_k(properties.get(), kChunkBranches), "/");
  check(H5Pset_sym_k(properties.get(), kMemberBranches, kMembersOfALeaf), "/");
  return properties;
}

Writer::Writer(std::filesystem::path target) : state_(std::make_unique<State>()) {
  state_->target = std::move(target);
  const Handle properties = state_->file_properties();
  const Handle access = state_->checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "/");
  state_->check(H5Pset_fapl_core(access.get(), kMemoryStep, false), "/");
  state_->file = state_->checked(
      H5Fcreate(state_->target.filename().c_str(), H5F_ACC_TRUNC, properties.get(), access.get()),
      H5Fclose, "/");
}

Writer::Writer(std::filesystem::path target, OnDisk room) : state_(std::make_unique<State>()) {
  state_->target = std::move(target);
  state_->disk.emplace(state_->target);
  state_->disk->reserve(room.bytes);
  const Handle properties = state_->file_properties();
  state_->file = state_->checked(
      H5Fcreate(state_->disk->temporary().c_str(), H5F_ACC_TRUNC, properties.get(), H5P_DEFAULT),
      H5Fclose, "/");
  state_->disk->reserve(room.bytes);  // once more: HDF5 has emptied the file
}

Writer::~Writer() = default;

void Writer::group(const std::string& path, const std::string& description) {
  const Handle properties = state_->checked(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, path);
  state_->check(H5Pset_obj_track_times(properties.get(), false), path);
  state_->checked(
      H5Gcreate2(state_->file.get(), path.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
      H5Gclose, path);
  set_text(path, "description", description);
}

Handle Writer::State::make_dataset(const std::string& path, Scalar scalar, std::uint64_t rows,
                                   std::size_t columns, Storage storage) const {
  std::vector<hsize_t> extent{rows};
  if (columns > 0) extent.push_back(columns);
  const Handle space = checked(
      H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose, path);
  const Handle properties = creation_properties(path, storage, extent);
  return checked(H5Dcreate2(file.get(), path.c_str(), stored_type(scalar), space.get(), H5P_DEFAULT,
                            properties.get(), H5P_DEFAULT),
                 H5Dclose, path);
}

void Writer::put(const std::string& path, Scalar scalar, std::size_t rows, std::size_t columns,
                 const void* data, const About& about) {
  const std::size_t bytes = rows * std::max<std::size_t>(columns, 1) * size_of(scalar);
  const Storage storage = bytes < kWorthDeflating ? Storage::Contiguous : Storage::Deflated;
  const Handle dataset = state_->make_dataset(path, scalar, rows, columns, storage);
  if (rows > 0) {
    state_->check(H5Dwrite(dataset.get(), native_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data),
                  path);
  }
  set_about(path, about);
}

void Writer::begin(const std::string& path, Scalar scalar, std::uint64_t rows, std::size_t columns,
                   const About& about) {
  state_->fillings[path] = {state_->make_dataset(path, scalar, rows, columns, Storage::Deflated),
                            rows, 0};
  set_about(path, about);
}

void Writer::fill(const std::string& path, Scalar scalar, std::uint64_t rows, std::size_t columns,
                  const void* data) {
  State::Filling& filling = state_->fillings.at(path);
  const std::array<hsize_t, 2> start{filling.filled, 0};
  const std::array<hsize_t, 2> count{rows, std::max<hsize_t>(columns, 1)};
  const int rank = columns > 0 ? 2 : 1;
  const Handle rows_in_memory =
      state_->checked(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, path);
  const Handle space = state_->checked(H5Dget_space(filling.dataset.get()), H5Sclose, path);
  state_->check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                    count.data(), nullptr),
                path);
  state_->check(H5Dwrite(filling.dataset.get(), native_type(scalar), rows_in_memory.get(),
                         space.get(), H5P_DEFAULT, data),
                path);
  filling.filled += rows;
}

void Writer::texts(const std::string& path, const std::vector<std::string>& rows,
                   const std::string& description) {
  std::vector<const char*> pointers;
  pointers.reserve(rows.size());
  for (const std::string& row : rows) pointers.push_back(state_->c_text(row, path));
  const Handle space = state_->list_space(rows.size(), path);
  const Handle type = variable_text_type();
  const Handle properties =
      state_->creation_properties(path, Storage::Contiguous, {hsize_t{rows.size()}});
  const Handle dataset =
      state_->checked(H5Dcreate2(state_->file.get(), path.c_str(), type.get(), space.get(),
                                 H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                      H5Dclose, path);
  if (!rows.empty()) {
    state_->check(
        H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), path);
  }
  set_about(path, {"1", description});
}

void Writer::set_about(const std::string& path, const About& about) {
  set_text(path, "units", about.units);
  set_text(path, "description", about.description);
}

void Writer::set_text(const std::string& object, const std::string& name,
                      const std::string& value) {
  const Handle type = variable_text_type();
  const Handle space = state_->checked(H5Screate(H5S_SCALAR), H5Sclose, object);
  const char* pointer = state_->c_text(value, object + "@" + name);
  state_->attribute(object, name, type.get(), space.get(), type.get(), &pointer);
}

void Writer::set_texts(const std::string& object, const std::string& name,
                       const std::vector<std::string>& values) {
  const std::string where = object + "@" + name;
  std::vector<const char*> pointers;
  pointers.reserve(values.size());
  for (const std::string& value : values) pointers.push_back(state_->c_text(value, where));
  const Handle type = variable_text_type();
  const Handle space = state_->list_space(values.size(), object);
  state_->attribute(object, name, type.get(), space.get(), type.get(),
                    values.empty() ? nullptr : pointers.data());
}

void Writer::set_integer(const std::string& object, const std::string& name, std::int64_t value) {
  const Handle space = state_->checked(H5Screate(H5S_SCALAR), H5Sclose, object);
  state_->attribute(object, name, H5T_STD_I64LE, space.get(), H5T_NATIVE_INT64, &value);
}

void Writer::set_integers(const std::string& object, const std::string& name,
                          const std::vector<std::int64_t>& values) {
  const Handle space = state_->list_space(values.size(), object);
  state_->attribute(object, name, H5T_STD_I64LE, space.get(), H5T_NATIVE_INT64, values.data());
}

void Writer::set_real(const std::string& object, const std::string& name, double value) {
  const Handle space = state_->checked(H5Screate(H5S_SCALAR), H5Sclose, object);
  state_->attribute(object, name, H5T_IEEE_F64LE, space.get(), H5T_NATIVE_DOUBLE, &value);
}

void Writer::set_ascii(const std::string& object, const std::string& name,
                       const std::string& value) {
  const std::string where = object + "@" + name;
  const Handle type = state_->checked(H5Tcopy(H5T_C_S1), H5Tclose, where);
  state_->check(H5Tset_size(type.get(), std::max<std::size_t>(value.size(), 1)), where);
  state_->check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), where);
  const Handle space = state_->checked(H5Screate(H5S_SCALAR), H5Sclose, where);
  state_->attribute(object, name, type.get(), space.get(), type.get(), value.c_str());
}

void Writer::commit() {
  for (const auto& [path, filling] : state_->fillings)
    if (filling.filled != filling.rows) state_->fail(path);
  state_->fillings.clear();
  if (state_->disk) {
    commit_on_disk();
  } else {
    commit_from_memory();
  }
}

void Writer::commit_on_disk() {
  state_->check(H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL), "/");
  hsize_t size = 0;
  state_->check(H5Fget_filesize(state_->file.get(), &size), "/");
  state_->check(H5Fclose(state_->file.release()), "/");
  CrashSafeFile& disk = *state_->disk;
  disk.continue_at(size);
  disk.write(seal_of_digest(sha256_of_file(disk.temporary())));
  disk.commit();
}

void Writer::commit_from_memory() {
  state_->check(H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL), "/");
  const ssize_t size = H5Fget_file_image(state_->file.get(), nullptr, 0);
  if (size < 0) state_->fail("/");
  std::string image(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(state_->file.get(), image.data(), image.size()) != size) state_->fail("/");
  state_->file.reset();
  CrashSafeFile file(state_->target);
  file.write(image);
  file.write(seal_of(image));
  file.commit();
}

}  // namespace palpate::hdf5
