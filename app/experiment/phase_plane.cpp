// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/phase_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "format/crash_safe_file.hpp"

namespace palpate::app {
namespace {

constexpr double kWidth = 420, kHeight = 340, kMargin = 50;  // of a panel, in units of the picture
constexpr double kLowX = -0.035, kHighX = 0.035;             // m
constexpr double kFastest = 1.2;                             // m/s
constexpr std::size_t kMostPoints = 20000;

double across(double position) {
  return kMargin + (kWidth - 2 * kMargin) * (position - kLowX) / (kHighX - kLowX);
}
double down(double velocity) {
  return kHeight / 2 - (kHeight / 2 - kMargin) * velocity / kFastest;
}

std::string line(double x1, double y1, double x2, double y2, std::string_view colour) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"/>)", x1,
                     y1, x2, y2, colour);
}

std::string label(double x, double y, const std::string& text) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", x, y, text);
}

std::string axes() {
  std::string svg = line(across(kLowX), down(0), across(kHighX), down(0), "#888");
  svg += line(across(0), down(-kFastest), across(0), down(kFastest), "#888");
  for (const double x : {-0.03, -0.02, -0.01, 0.01, 0.02, 0.03}) {
    svg += line(across(x), down(0), across(x), down(0) + 4, "#888");
    svg += label(across(x), down(0) + 16, fmt::format("{:g}", x));
  }
  for (const double v : {-1.0, -0.5, 0.5, 1.0}) {
    svg += line(across(0) - 4, down(v), across(0), down(v), "#888");
    svg += label(across(0) - 20, down(v) + 4, fmt::format("{:g}", v));
  }
  svg += label(kWidth / 2, kHeight - 12, "x (m)");
  return svg + label(across(0), down(kFastest) - 8, "v (m/s)");
}

/// Thinned evenly where there are more points than a picture can show.
std::string curve(const std::vector<PhasePoint>& path) {
  const std::size_t stride = std::max<std::size_t>(1, path.size() / kMostPoints);
  std::string points;
  for (std::size_t i = 0; i < path.size(); i += stride) {
    points += fmt::format("{:.1f},{:.1f} ", across(path[i].position), down(path[i].velocity));
  }
  return fmt::format(R"(<polyline points="{}" fill="none" stroke="#1f5fa8" stroke-width="0.4"/>)",
                     points);
}

}  // namespace

void write_phase_planes(const std::filesystem::path& file, const std::vector<PhasePlane>& planes) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n",
      kWidth * static_cast<double>(planes.size()), kHeight);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    svg += fmt::format("<g transform=\"translate({},0)\">\n", kWidth * static_cast<double>(i));
    svg += axes() + curve(planes[i].path) + label(kWidth / 2, 20, planes[i].title) + "\n</g>\n";
  }
  write_file_crash_safely(file, svg + "</svg>\n");
}

void write_phase_csv(const std::filesystem::path& file, const std::vector<PhasePoint>& path) {
  std::string text = "position_m,velocity_m_per_s\n";
  for (const PhasePoint& p : path) text += fmt::format("{:.9g},{:.9g}\n", p.position, p.velocity);
  write_file_crash_safely(file, text);
}

}  // namespace palpate::app
