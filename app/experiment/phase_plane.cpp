// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/phase_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/experiment/svg.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate::app {
namespace {

using svg::label, svg::line, svg::rectangle;

constexpr double kPanelWidth = 420, kPanelHeight = 340;  // of a panel, in units of the picture
constexpr double kLeft = 56, kRight = 10, kAbove = 34, kBelow = 46;  // beside its frame
constexpr double kLowX = -0.035, kHighX = 0.035;                     // m
constexpr double kFastest = 1.2;                                     // m/s
constexpr std::size_t kMostPoints = 20000;

double across(double position) {
  return kLeft + (kPanelWidth - kLeft - kRight) * (position - kLowX) / (kHighX - kLowX);
}
double down(double velocity) {
  return kAbove + (kPanelHeight - kAbove - kBelow) * (1 - velocity / kFastest) / 2;
}

/// The frame, numbers outside of it where no curve hides them, and where the body is.
std::string axes() {
  const double left = across(kLowX), right = across(kHighX);
  const double top = down(kFastest), bottom = down(-kFastest);
  std::string shapes = rectangle(across(0), top, right, bottom, R"(fill="#f3ead9")");
  shapes += label(across(kHighX) - 22, top + 16, "inside", R"( fill="#8a6d3b")");
  shapes +=
      line(left, down(0), right, down(0), "#ccc") + line(across(0), top, across(0), bottom, "#ccc");
  for (int mm = -30; mm <= 30; mm += 10) {
    shapes += line(across(1e-3 * mm), bottom, across(1e-3 * mm), bottom + 4, "#444");
    shapes += label(across(1e-3 * mm), bottom + 17, fmt::format("{}", mm));
  }
  for (const double v : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    shapes += line(left - 4, down(v), left, down(v), "#444");
    shapes += label(left - 18, down(v) + 4, fmt::format("{:.1f}", v));
  }
  shapes += label((left + right) / 2, bottom + 36, "position (mm)");
  const double middle = (top + bottom) / 2;
  return shapes + label(14, middle, "velocity (m/s)",
                        fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", middle));
}

std::string frame() {
  return rectangle(across(kLowX), down(kFastest), across(kHighX), down(-kFastest),
                   R"(fill="none" stroke="#444")");
}

/// Thinned evenly where there are more points than a picture can show.
std::string curve(const std::vector<PhasePoint>& path) {
  const std::size_t stride = std::max<std::size_t>(1, path.size() / kMostPoints);
  std::string points;
  for (std::size_t i = 0; i < path.size(); i += stride) {
    points += fmt::format("{:.2f},{:.2f} ", across(path[i].position), down(path[i].velocity));
  }
  return fmt::format(R"(<polyline points="{}" fill="none" stroke="#1f5fa8" stroke-width="0.3"/>)",
                     points);
}

}  // namespace

void write_phase_planes(const std::filesystem::path& file, const std::vector<PhasePlane>& planes) {
  std::string panels;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    panels +=
        fmt::format("<g transform=\"translate({},0)\">\n", kPanelWidth * static_cast<double>(i));
    panels += axes() + curve(planes[i].path) + frame() +
              label((across(kLowX) + across(kHighX)) / 2, 20, planes[i].title) + "\n</g>\n";
  }
  write_file_crash_safely(
      file, svg::picture(kPanelWidth * static_cast<double>(planes.size()), kPanelHeight, panels));
}

void write_phase_csv(const std::filesystem::path& file, const std::vector<PhasePoint>& path) {
  std::string text = "position_m,velocity_m_per_s\n";
  for (const PhasePoint& p : path) text += fmt::format("{:.9g},{:.9g}\n", p.position, p.velocity);
  write_file_crash_safely(file, text);
}

}  // namespace palpate::app
