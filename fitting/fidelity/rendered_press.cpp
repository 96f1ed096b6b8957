// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/rendered_press.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "runtime/palpate.h"

namespace palpate::fidelity {
namespace {

constexpr double kApproach =
    1e-6;                        // m outside and inside of the surface, on either side of the touch
constexpr double kNear = 1e-5;   // m and rad, tolerance of the contact point and direction
constexpr double kExact = 1e-9;  // m, tolerance of a deflection
constexpr double kNoSlip = 1e9;  // friction coefficient without slip
constexpr double kInstant =
    1e-12;  // s: the direct presses are those of tissue that has had no time to relax

void check(int status, const std::string& where) {
  if (status == PALPATE_OK) return;
  throw Error(ErrorKind::Configuration, where, palpate_last_error(), palpate_status_text(status));
}

[[noreturn]] void disagree(const Vec3& contact, const std::string& problem) {
  char where[96];
  std::snprintf(where, sizeof where, "contact at (%.6g, %.6g, %.6g) m", contact[0], contact[1],
                contact[2]);
  throw Error(ErrorKind::Internal, where, problem, "report this as a bug, with the library");
}

struct DestroyState {
  void operator()(palpate_state* state) const { palpate_state_destroy(state); }
};

/// One tip of the runtime.
class Tip {
 public:
  explicit Tip(const palpate_library* library) {
    palpate_settings settings;
    palpate_settings_default(&settings);
    settings.friction = kNoSlip;
    palpate_state* state = nullptr;
    check(palpate_state_create(library, &settings, &state), "rendered press");
    state_.reset(state);
  }

  /// Force on the body.
  Vec3 move_to(const Vec3& x, double dt = kInstant) {
    const Vec3 still{};
    Vec3 on_tool{};
    palpate_step(state_.get(), x.data(), still.data(), dt, on_tool.data());
    return -1.0 * on_tool;
  }

  palpate_observation observe() const {
    palpate_observation seen{};
    seen.size = sizeof seen;
    check(palpate_observe(state_.get(), &seen), "rendered press");
    return seen;
  }

  const palpate_state* state() const { return state_.get(); }

 private:
  std::unique_ptr<palpate_state, DestroyState> state_;
};

Vec3 vector_of(const double v[3]) {
  return {v[0], v[1], v[2]};
}

}  // namespace

void RenderedBody::Unload::operator()(palpate_library* library) const {
  palpate_library_destroy(library);
}

RenderedBody::RenderedBody(const std::filesystem::path& file) {
  palpate_library* library = nullptr;
  check(palpate_library_load(file.c_str(), &library), file.string());
  library_.reset(library);
}

RenderedSkin::RenderedSkin(const RenderedBody& body, const std::filesystem::path& file) {
  palpate_deformation* deformation = nullptr;
  check(palpate_deformation_load(body.library_.get(), file.c_str(), &deformation), file.string());
  deformation_.reset(deformation);
  palpate_deformation_info info{};
  info.size = sizeof info;
  check(palpate_deformation_describe(deformation, &info), file.string());
  at_rest_.resize(static_cast<std::size_t>(info.vertices));
  check(palpate_deformation_vertices(deformation, at_rest_.front().data(), at_rest_.size()),
        file.string());
}

void RenderedSkin::Unload::operator()(palpate_deformation* deformation) const {
  palpate_deformation_destroy(deformation);
}

namespace {

/// Brings the tip into contact at the point.
palpate_observation touch_at(Tip& tip, const Vec3& contact, const Vec3& inward) {
  tip.move_to(contact - kApproach * inward);
  tip.move_to(contact + kApproach * inward);
  const palpate_observation touch = tip.observe();
  if ((touch.status & PALPATE_CONTACT) == 0) disagree(contact, "the runtime finds no contact");
  if (norm(vector_of(touch.contact_point) - contact) > kNear ||
      norm(vector_of(touch.normal) - inward) > kNear)
    disagree(contact, "the runtime uses another contact point or direction");
  return touch;
}

/// A press along the normal in small steps and a drag at its end, for each deflection on a body
/// that nobody has touched; `at(tip, force)` is called at the ends.
template <class At>
void follow_paths(const palpate_library* library, const Vec3& contact, const Vec3& inward,
                  const std::vector<RenderedBody::Deflection>& deflections, At at) {
  constexpr int kSteps = 200;  // of a press: a lateral response grows with the contact
  for (const RenderedBody::Deflection& d : deflections) {
    Tip tip(library);
    const palpate_observation touch = touch_at(tip, contact, inward);
    const Vec3 c = vector_of(touch.contact_point), n = vector_of(touch.normal);
    for (int k = 1; k <= kSteps; ++k) tip.move_to(c + (d.depth * k / kSteps + touch.offset) * n);
    const Vec3 force = tip.move_to(c + (d.depth + touch.offset) * n + d.lateral * d.tangent);
    const palpate_observation seen = tip.observe();
    if (std::abs(seen.depth - d.depth) > kExact || std::abs(seen.lateral - d.lateral) > kExact)
      disagree(contact, "the contact point moved");
    at(tip, force);
  }
}

}  // namespace

std::vector<Vec3> RenderedBody::press(const Vec3& contact, const Vec3& inward,
                                      const std::vector<Deflection>& deflections) const {
  std::vector<Vec3> forces;
  follow_paths(library_.get(), contact, inward, deflections,
               [&](const Tip&, const Vec3& force) { forces.push_back(force); });
  return forces;
}

std::vector<double> RenderedBody::follow(const Vec3& contact, const Vec3& inward,
                                         const std::vector<double>& time,
                                         const std::vector<double>& travel) const {
  constexpr double kStep = 1e-3;  // s
  std::vector<double> forces(time.size(), 0.0);
  std::size_t first = 0;
  while (first < time.size() && !(travel[first] > 0)) ++first;
  if (first == time.size()) return forces;
  Tip tip(library_.get());
  const palpate_observation touch = touch_at(tip, contact, inward);
  const Vec3 c = vector_of(touch.contact_point), n = vector_of(touch.normal);
  for (std::size_t i = first; i < time.size(); ++i) {
    const double from = i == first ? 0 : travel[i - 1];
    const double took = i == 0 ? kStep : time[i] - time[i - 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(took / kStep)));
    Vec3 force{};
    for (int k = 1; k <= steps; ++k) {
      const double x = from + (travel[i] - from) * k / steps;
      force = tip.move_to(c + (x + touch.offset) * n, took / steps);
    }
    forces[i] = dot(force, n);
  }
  return forces;
}

std::vector<std::vector<Vec3>> RenderedBody::displace(
    const RenderedSkin& skin, const Vec3& contact, const Vec3& inward,
    const std::vector<Deflection>& deflections) const {
  std::vector<std::vector<Vec3>> displacements;
  follow_paths(library_.get(), contact, inward, deflections, [&](const Tip& tip, const Vec3&) {
    std::vector<Vec3> u(skin.at_rest_.size());
    check(palpate_deform(tip.state(), skin.deformation_.get(), u.front().data(), u.size()),
          "rendered press");
    for (std::size_t w = 0; w < u.size(); ++w) u[w] = u[w] - skin.at_rest_[w];
    displacements.push_back(std::move(u));
  });
  return displacements;
}

}  // namespace palpate::fidelity
