// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/fibre_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr std::string_view kDirections = "x,y,z,fx,fy,fz", kPlanes = "x,y,z,fx,fy,fz,sx,sy,sz";

/// The line without blanks and comment.
std::string bare(std::string line) {
  line = line.substr(0, line.find('#'));
  std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
  return line;
}

class FibreFile {
 public:
  explicit FibreFile(const std::filesystem::path& path) : path_(path.string()), stream_(path) {
    if (!stream_) {
      throw Error(ErrorKind::Configuration, path_, "cannot read the fibre file",
                  "check its path and permissions");
    }
  }

  std::vector<fem::FibreSample> read(double unit) {
    const std::string title = next();
    if (title != kDirections && title != kPlanes) {
      fail(fmt::format("unknown columns '{}'", title),
           fmt::format("name them {} or {}", kDirections, kPlanes));
    }
    const std::size_t columns = title == kPlanes ? 9 : 6;
    std::vector<fem::FibreSample> samples;
    for (std::string line = next(); !line.empty(); line = next()) {
      const std::vector<double> v = numbers(line, columns);
      fem::FibreSample sample{{unit * v[0], unit * v[1], unit * v[2]}, {v[3], v[4], v[5]}, {}};
      if (columns == 9) sample.across = {v[6], v[7], v[8]};
      check(sample, columns == 9);
      samples.push_back(sample);
    }
    if (samples.empty()) fail("the file has no points", "give at least one");
    return samples;
  }

 private:
  /// The next line with content; empty at the end.
  std::string next() {
    for (std::string line; std::getline(stream_, line);) {
      ++line_;
      line = bare(line);
      if (!line.empty()) return line;
    }
    return {};
  }

  std::vector<double> numbers(const std::string& line, std::size_t columns) const {
    std::vector<double> values;
    const char* at = line.data();
    const char* const end = at + line.size();
    while (at < end) {
      double value = 0;
      const auto [rest, fault] = std::from_chars(at, end, value);
      if (fault != std::errc() || !std::isfinite(value) || (rest != end && *rest != ',')) {
        fail(fmt::format("value {} is not a finite number", values.size() + 1),
             "write numbers separated by commas");
      }
      values.push_back(value);
      at = rest == end ? end : rest + 1;
    }
    if (values.size() != columns) {
      fail(fmt::format("{} values for {} columns", values.size(), columns),
           "give a value for each column");
    }
    return values;
  }

  void check(const fem::FibreSample& sample, bool has_plane) const {
    const double mean = norm(sample.mean), across = norm(sample.across);
    if (!(mean > 0) ||
        (has_plane && !(norm(cross(sample.mean, sample.across)) > 1e-6 * mean * across))) {
      fail("the fibre direction is zero or parallel to the second direction of its plane",
           "give directions that span a plane");
    }
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::Configuration, fmt::format("{}:{}", path_, std::max(line_, 1)), problem,
                remedy);
  }

  std::string path_;
  std::ifstream stream_;
  int line_ = 0;
};

}  // namespace

std::vector<fem::FibreSample> read_fibre_file(const std::filesystem::path& path, double unit) {
  return FibreFile(path).read(unit);
}

}  // namespace palpate::app
