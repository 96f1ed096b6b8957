// SPDX-License-Identifier: Apache-2.0
// Typed, checked access to HDF5 files. No HDF5 header is needed to use it.
//
// HDF5's own printing of errors is off while a Writer or Reader lives and restored afterwards; what
// it had to say becomes part of the Error. Objects of different threads take turns (one lock),
// since not every build of HDF5 is thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "format/error.hpp"

namespace palpate::hdf5 {

enum class Scalar { Float32, Float64, Int32, Int64, UInt8, UInt32 };

/// How one row of a dataset is stored: `columns` is 0 for a plain number (dataset of rank 1) and N
/// for std::array<T, N> (dataset of rank 2, N columns).
template <class T>
struct Row;
template <Scalar S, std::size_t N = 0>
struct RowOf {
  static constexpr Scalar scalar = S;
  static constexpr std::size_t columns = N;
};
template <>
struct Row<float> : RowOf<Scalar::Float32> {};
template <>
struct Row<double> : RowOf<Scalar::Float64> {};
template <>
struct Row<std::int32_t> : RowOf<Scalar::Int32> {};
template <>
struct Row<std::int64_t> : RowOf<Scalar::Int64> {};
template <>
struct Row<std::uint8_t> : RowOf<Scalar::UInt8> {};
template <>
struct Row<std::uint32_t> : RowOf<Scalar::UInt32> {};
template <class T, std::size_t N>
struct Row<std::array<T, N>> : RowOf<Row<T>::scalar, N> {};

/// The two attributes of every dataset.
struct About {
  std::string units;        ///< SI, "1" when dimensionless
  std::string description;  ///< one sentence
};

inline constexpr std::size_t kChunkRows = 4096;  ///< of long columns

/// Room that a file may need on the disk, taken before its first byte is written.
struct OnDisk {
  std::uint64_t bytes = 0;
};

/// Builds a file in memory and puts it on the disk in one crash-safe move, so that a full disk is
/// met by plain file calls and never by an HDF5 file that can no longer be closed. Needs memory for
/// twice the file; or, built OnDisk, next to none, in room that is taken beforehand. The bytes
/// depend on the content alone (no time stamps) and end with a seal (format/seal.hpp).
/// @throws Error(Internal) when HDF5 fails, else as CrashSafeFile.
class Writer {
 public:
  explicit Writer(std::filesystem::path target);
  Writer(std::filesystem::path target, OnDisk room);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void group(const std::string& path, const std::string& description);

  template <class T>
  void dataset(const std::string& path, const std::vector<T>& rows, const About& about) {
    put(path, Row<T>::scalar, rows.size(), Row<T>::columns, rows.data(), about);
  }
  void texts(const std::string& path, const std::vector<std::string>& rows,
             const std::string& description);

  /// A long dataset, to be filled from the front by append(): in chunks, shuffled and deflated.
  template <class T>
  void begin_dataset(const std::string& path, std::uint64_t rows, const About& about) {
    begin(path, Row<T>::scalar, rows, Row<T>::columns, about);
  }
  template <class T>
  void append(const std::string& path, const std::vector<T>& rows) {
    fill(path, Row<T>::scalar, rows.size(), Row<T>::columns, rows.data());
  }

  /// Attributes of the group or dataset `object`. Texts are UTF-8 of variable length.
  void set_text(const std::string& object, const std::string& name, const std::string& value);
  void set_texts(const std::string& object, const std::string& name,
                 const std::vector<std::string>& values);
  void set_integer(const std::string& object, const std::string& name, std::int64_t value);
  void set_integers(const std::string& object, const std::string& name,
                    const std::vector<std::int64_t>& values);
  void set_real(const std::string& object, const std::string& name, double value);
  /// ASCII of fixed length: some readers (VTK 9.1) take no other.
  void set_ascii(const std::string& object, const std::string& name, const std::string& value);

  /// Put the file on the disk under its final name. Nothing may be added afterwards.
  void commit();

 private:
  void put(const std::string& path, Scalar scalar, std::size_t rows, std::size_t columns,
           const void* data, const About& about);
  void begin(const std::string& path, Scalar scalar, std::uint64_t rows, std::size_t columns,
             const About& about);
  void fill(const std::string& path, Scalar scalar, std::uint64_t rows, std::size_t columns,
            const void* data);
  void commit_from_memory();
  void commit_on_disk();
  void set_about(const std::string& path, const About& about);

  struct State;
  std::unique_ptr<State> state_;
};

/// Accept whatever number of rows a dataset has.
inline constexpr std::size_t kAnyRows = static_cast<std::size_t>(-1);

/// Reads a file and believes nothing: the seal must be unbroken, a dataset must have exactly the
/// asked type, rank, shape and units, lie in this very file (no external or virtual storage) and be
/// wholly present: HDF5 itself reads a part that was never written as zeros, with success. Memory
/// is only allocated for data that the file contains. @throws Error(Configuration):
/// "<file>:<object>: <problem>; <remedy>".
class Reader {
 public:
  /// `remedy`: how the user gets a valid file, e.g. how to make it again.
  Reader(std::filesystem::path file, std::string remedy);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Call first: refuses a file of another kind, or of a schema that is not among `known`
  /// (ascending). @return the schema of the file.
  std::int64_t require_artifact(const std::string& artifact,
                                std::initializer_list<std::int64_t> known);

  bool has(const std::string& path) const;
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::vector<std::string> children(const std::string& group) const;  ///< ascending by name

  template <class T>
  std::vector<T> dataset(const std::string& path, const std::string& units,
                         std::size_t rows = kAnyRows) const {
    std::vector<T> values(checked_rows(path, Row<T>::scalar, rows, Row<T>::columns, sizeof(T)));
    require_units(path, units);
    get(path, Row<T>::scalar, values.data());
    return values;
  }
  /// Rows of a dataset that is read in parts: all that dataset() checks, but for the values.
  template <class T>
  std::size_t rows_of(const std::string& path, const std::string& units,
                      std::size_t rows = kAnyRows) const {
    const std::size_t found = checked_rows(path, Row<T>::scalar, rows, Row<T>::columns, sizeof(T));
    require_units(path, units);
    return found;
  }
  /// Some of the rows of a dataset, after rows_of().
  template <class T>
  std::vector<T> part(const std::string& path, std::size_t first, std::size_t count) const {
    std::vector<T> values(count);
    get_part(path, Row<T>::scalar, Row<T>::columns, first, count, values.data());
    return values;
  }
  std::vector<std::string> texts(const std::string& path, std::size_t rows = kAnyRows) const;

  std::string text(const std::string& object, const std::string& name) const;
  std::vector<std::string> text_list(const std::string& object, const std::string& name) const;
  std::int64_t integer(const std::string& object, const std::string& name) const;
  double real(const std::string& object, const std::string& name) const;

  const std::filesystem::path& file() const noexcept;
  const std::string& remedy() const noexcept;
  [[noreturn]] void fail(const std::string& object, const std::string& problem) const;

 private:
  std::size_t checked_rows(const std::string& path, Scalar scalar, std::size_t rows,
                           std::size_t columns, std::size_t row_bytes) const;
  void require_units(const std::string& path, const std::string& units) const;
  void get(const std::string& path, Scalar scalar, void* data) const;
  void get_part(const std::string& path, Scalar scalar, std::size_t columns, std::size_t first,
                std::size_t count, void* data) const;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::hdf5
