// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/touch_picture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/experiment/line_of_touch.hpp"
#include "app/experiment/svg.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate::app {
namespace {

using runtime::Element;

constexpr double kWidth = 560, kHeight = 330;  // of the picture, in its units
constexpr double kScale = 2200;                // units per metre
constexpr double kNewton = 0.03;               // m of arrow per newton
constexpr double kShaft = 0.045;               // m of the tool that is drawn

/// A parallel projection in which the axis of the cylinder (z) runs to the right.
class View {
 public:
  explicit View(const Vec3& middle) : middle_(middle) {
    toward_ = (1 / norm(toward_)) * toward_;
    right_ = Vec3{0, 0, 1} - toward_[2] * toward_;
    right_ = (1 / norm(right_)) * right_;
    up_ = cross(toward_, right_);
  }
  double across(const Vec3& x) const { return kWidth / 2 + kScale * dot(x - middle_, right_); }
  double down(const Vec3& x) const { return kHeight / 2 - kScale * dot(x - middle_, up_); }
  /// Cosine between the outward normal of an element and the direction toward the eye.
  double facing(const Element& e) const { return -dot(e.facet_normal, toward_); }

  std::string line(const Vec3& a, const Vec3& b, std::string_view colour,
                   std::string_view more = "") const {
    return svg::line(across(a), down(a), across(b), down(b), colour, more);
  }
  std::string dot_at(const Vec3& x, double radius, std::string_view colour) const {
    return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}"/>)", across(x), down(x),
                       radius, colour);
  }
  std::string name(const Vec3& x, double right, double below, const std::string& text) const {
    return svg::label(across(x) + right, down(x) + below, text);
  }

 private:
  Vec3 middle_;
  Vec3 toward_{0.55, 0.75, 0.3};  ///< the eye
  Vec3 right_{}, up_{};
};

std::string patch(const View& view, const runtime::Surface& surface, const Element& e,
                  bool active) {
  std::string corners;
  for (std::size_t l = 0; l < 3; ++l) {
    const Vec3& x = surface.vertex(e, l);
    corners += fmt::format("{:.1f},{:.1f} ", view.across(x), view.down(x));
  }
  const int light = 190 + static_cast<int>(55 * view.facing(e));
  const std::string fill =
      active ? "#f2b134" : fmt::format("rgb({},{},{})", light, light - 10, light - 30);
  return fmt::format(R"(<polygon points="{}" fill="{}" stroke="#a08c70" stroke-width="0.5"/>)",
                     corners, fill);
}

std::string patches(const View& view, const runtime::Surface& surface, std::int32_t active) {
  std::string shapes;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const Element& e = surface.element(m);
    if (view.facing(e) > 0) shapes += patch(view, surface, e, m == active) + "\n";
  }
  return shapes;
}

constexpr std::string_view kArrow = " stroke-width=\"2.5\" marker-end=\"url(#head)\"";

/// Tool, deflection and force over the patches: what is inside the body is drawn, too.
std::string touch(const View& view, const Vec3& tip, const runtime::ContactObservation& seen) {
  const Vec3 on_tool = -seen.force;
  const Vec3 arrow = tip + kNewton * on_tool;
  return view.line(tip, tip + Vec3{kShaft, 0, 0}, "#444", R"( stroke-width="5" opacity="0.45")") +
         view.line(seen.contact_point, tip, "#1f5fa8", R"( stroke-width="2")") +
         view.line(tip, arrow, "#b3261e", kArrow) +
         view.dot_at(seen.contact_point, 3.5, "#1f5fa8") + view.dot_at(tip, 5, "#222") +
         view.name(tip, -22, 4, "tip x") + view.name(seen.contact_point, 14, -8, "c") +
         view.name(arrow, -34, 0, fmt::format("{:.2f} N", norm(seen.force)));
}

constexpr std::string_view kArrowHead =
    R"(<defs><marker id="head" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="4")"
    R"( markerHeight="4" orient="auto"><path d="M0 0L8 4L0 8z" fill="#b3261e"/></marker></defs>)";

}  // namespace

void write_touch_picture(const std::filesystem::path& file, const SlingshotSetup& setup, double k,
                         double depth) {
  constexpr double kStep = 1e-6;  // m, between samples
  slingshot::LineOfTouch line(setup, k);
  for (double x = -kStep; x < depth; x += kStep) line.force(x);
  line.force(depth);
  const runtime::Surface& surface = line.body()->surface;
  const View view(0.5 * (surface.low() + surface.high()));
  const std::string title =
      fmt::format("{} patches, k = {:g} N/m, {:g} mm off the axis, mu = {:g}, {:g} mm deep",
                  surface.element_count(), k, 1e3 * setup.off_axis, setup.friction, 1e3 * depth);
  write_file_crash_safely(
      file, svg::picture(
                kWidth, kHeight,
                std::string(kArrowHead) + patches(view, surface, line.seen().point.element) +
                    touch(view, line.tip(depth), line.seen()) + svg::label(kWidth / 2, 20, title)));
}

}  // namespace palpate::app
