// SPDX-License-Identifier: Apache-2.0
// The checks every artifact passes twice: before it is written and after it is read.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "format/error.hpp"
#include "format/numbers.hpp"
#include "format/vec3.hpp"

namespace palpate {

/// Which numbers a value may take. NaN passes only where `unknown` is set.
struct Rule {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool unit = false;     ///< a direction of length 1
  bool unknown = false;  ///< NaN means "unknown"
  const char* text = "finite";
};
namespace rules {
inline constexpr double kLargest = std::numeric_limits<double>::max();
inline constexpr Rule kAnything{-kInfinity, kInfinity, false, true, "anything"};
inline constexpr Rule kFinite{};
inline constexpr Rule kKnownFinite{-kLargest, kLargest, false, true, "finite (NaN: unknown)"};
inline constexpr Rule kKnownNonNegative{0, kLargest, false, true,
                                        "finite and not negative (NaN: unknown)"};
inline constexpr Rule kNonNegative{0, kLargest, false, false, "finite and not negative"};
inline constexpr Rule kPositive{std::numeric_limits<double>::min(), kLargest, false, false,
                                "finite and above 0"};
inline constexpr Rule kBound{0, kInfinity, false, false, "not negative (infinite: no bound)"};
inline constexpr Rule kKnownBound{0, kInfinity, false, true, "not negative (NaN: unknown)"};
inline constexpr Rule kUnit{-2, 2, true, false, "a unit direction"};
inline constexpr Rule kFlag{0, 1, false, false, "0 or 1"};
inline constexpr Rule kCosine{-1, 1, false, false, "between -1 and 1"};
constexpr Rule up_to(double high, const char* text) {
  return {0, high, false, false, text};
}
}  // namespace rules

/// Directions must have unit length to this tolerance.
inline constexpr double kUnitTolerance = 1e-6;

/// Throws with file, dataset, row and remedy at the first value that breaks a rule.
class Checks {
 public:
  /// For data just read: the file is at fault. `Reader`: hdf5::Reader or FlatReader.
  template <class Reader>
  requires requires(const Reader& reader) { reader.remedy(); }
  explicit Checks(const Reader& reader)
      : file_(reader.file().string()), remedy_(reader.remedy()), kind_(ErrorKind::Configuration) {}
  /// For data about to be written: the caller is at fault.
  explicit Checks(const std::filesystem::path& target)
      : file_(target.string()),
        remedy_("nothing was written; report this as a defect of the stage that made it"),
        kind_(ErrorKind::Internal) {}

  [[noreturn]] void fail(const std::string& dataset, const std::string& problem) const {
    throw Error(kind_, file_ + ":" + dataset, problem, remedy_);
  }
  [[noreturn]] void fail_row(const std::string& dataset, std::size_t row,
                             const std::string& problem) const {
    fail(dataset + "[" + std::to_string(row) + "]", problem);
  }
  [[noreturn]] void fail_geometry(const std::string& dataset, std::size_t row,
                                  const std::string& problem) const {
    const ErrorKind kind = kind_ == ErrorKind::Internal ? kind_ : ErrorKind::Geometry;
    throw Error(kind, file_ + ":" + dataset + "[" + std::to_string(row) + "]", problem, remedy_);
  }
  void require(bool holds, const std::string& dataset, const std::string& problem) const {
    if (!holds) fail(dataset, problem);
  }
  void same_size(const std::string& dataset, std::size_t found, std::size_t wanted) const {
    if (found != wanted) {
      fail(dataset,
           "has " + std::to_string(found) + " rows, " + std::to_string(wanted) + " expected");
    }
  }

  void number(const std::string& dataset, std::size_t row, double value, const Rule& rule) const {
    const bool fits = std::isnan(value) ? rule.unknown : value >= rule.low && value <= rule.high;
    if (!fits) fail_row(dataset, row, std::to_string(value) + " is not " + rule.text);
  }
  void vector(const std::string& dataset, std::size_t row, const Vec3& value,
              const Rule& rule) const {
    for (const double component : value) number(dataset, row, component, rule);
    if (rule.unit && std::abs(norm(value) - 1) > kUnitTolerance) {
      fail_row(dataset, row, "has length " + std::to_string(norm(value)) + ", 1 expected");
    }
  }
  void vectors(const std::string& dataset, const std::vector<Vec3>& values,
               const Rule& rule) const {
    for (std::size_t row = 0; row < values.size(); ++row) vector(dataset, row, values[row], rule);
  }
  template <class T>
  void numbers(const std::string& dataset, const std::vector<T>& values, const Rule& rule) const {
    for (std::size_t row = 0; row < values.size(); ++row) {
      number(dataset, row, static_cast<double>(values[row]), rule);
    }
  }

  void index(const std::string& dataset, std::size_t row, std::int64_t value,
             std::size_t limit) const {
    if (value < 0 || static_cast<std::size_t>(value) >= limit) {
      fail_row(dataset, row,
               "index " + std::to_string(value) + " is not below " + std::to_string(limit));
    }
  }
  void indices(const std::string& dataset, const std::vector<std::int32_t>& values,
               std::size_t limit) const {
    for (std::size_t row = 0; row < values.size(); ++row) index(dataset, row, values[row], limit);
  }
  /// Corners of triangles or tetrahedra: in range and different from each other.
  template <std::size_t N>
  void corners(const std::string& dataset, const std::vector<std::array<std::int32_t, N>>& values,
               std::size_t limit) const {
    for (std::size_t row = 0; row < values.size(); ++row) {
      for (std::size_t i = 0; i < N; ++i) {
        index(dataset, row, values[row][i], limit);
        for (std::size_t j = 0; j < i; ++j) {
          if (values[row][i] == values[row][j]) fail_row(dataset, row, "names a corner twice");
        }
      }
    }
  }

  /// 64 hexadecimal digits, or nothing when `optional`.
  void digest(const std::string& dataset, const std::string& value, bool optional) const {
    if (optional && value.empty()) return;
    const bool fits =
        value.size() == 64 && value.find_first_not_of("0123456789abcdef") == std::string::npos;
    require(fits, dataset, "is not a SHA-256 of 64 lower-case hexadecimal digits");
  }

 private:
  std::string file_;
  std::string remedy_;
  ErrorKind kind_;
};

/// Offsets into flat data: `first` must be the running sum of `count`, and the sum the data's size.
inline void check_offsets(const Checks& checks, const std::string& first_name,
                          const std::string& count_name, const std::vector<std::int64_t>& first,
                          const std::vector<std::int64_t>& count, std::size_t total) {
  std::int64_t sum = 0;
  const auto limit = static_cast<std::int64_t>(total);
  for (std::size_t row = 0; row < first.size(); ++row) {
    if (first[row] != sum) {
      checks.fail_row(first_name, row,
                      std::to_string(first[row]) + " is not the sum of the counts before it, " +
                          std::to_string(sum));
    }
    if (count[row] < 0 || count[row] > limit - sum) {
      checks.fail_row(count_name, row,
                      std::to_string(count[row]) + " leads beyond the " + std::to_string(total) +
                          " rows there are");
    }
    sum += count[row];
  }
  checks.require(sum == limit, count_name,
                 "sums to " + std::to_string(sum) + ", " + std::to_string(total) + " rows found");
}

}  // namespace palpate
