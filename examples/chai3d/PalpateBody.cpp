// SPDX-License-Identifier: Apache-2.0
#include "PalpateBody.h"

#include <effects/CGenericEffect.h>
#include <timers/CPrecisionClock.h>

#include <cstdint>
#include <stdexcept>

namespace {

void require(int result) {
  if (result < 0) throw std::runtime_error(palpate_last_error());
}

}  // namespace

/// The force of the body on the tool that touched it first, in its frame.
class PalpateBody::Touch : public chai3d::cGenericEffect {
 public:
  Touch(PalpateBody* body, palpate_state* state)
      : chai3d::cGenericEffect(body), body_(body), state_(state) {}

  void setTimeStep(double seconds) { timeStep_ = seconds; }

  bool computeForce(const chai3d::cVector3d& toolPos, const chai3d::cVector3d& toolVel,
                    const unsigned int& toolID, chai3d::cVector3d& reactionForce) override {
    reactionForce.zero();
    if (tool_ != kNone && tool_ != static_cast<std::int64_t>(toolID)) return false;
    tool_ = toolID;
    double force[3];
    const double at[3] = {toolPos.x(), toolPos.y(), toolPos.z()};
    const double velocity[3] = {toolVel.x(), toolVel.y(), toolVel.z()};
    const std::uint32_t status = palpate_step(state_, at, velocity, elapsed(), force);
    reactionForce.set(force[0], force[1], force[2]);
    const bool touched = (status & PALPATE_CONTACT) != 0;
    report(touched);
    return touched;
  }

 private:
  static constexpr std::int64_t kNone = -1;
  static constexpr double kFirst =
      1e-3;  // s, the time before the first step, which nobody measured

  double elapsed() {
    if (timeStep_ > 0) return timeStep_;
    const double now = clock_.getCPUTimeSeconds(), before = last_;
    last_ = now;
    return before > 0 && now > before ? now - before : kFirst;
  }

  /// What a tool tells its owner of the contact.
  void report(bool touched) const {
    palpate_observation seen{};
    seen.size = sizeof seen;
    palpate_observe(state_, &seen);
    body_->m_interactionInside = touched;
    if (!touched) return;
    const double *c = seen.contact_point, *n = seen.normal;
    body_->m_interactionPoint.set(c[0], c[1], c[2]);
    body_->m_interactionNormal.set(-n[0], -n[1], -n[2]);
  }

  PalpateBody* body_;
  palpate_state* state_;
  std::int64_t tool_ = kNone;
  double timeStep_ = 0, last_ = 0;
  chai3d::cPrecisionClock clock_;
};

PalpateBody::PalpateBody(const std::string& library, const std::string& skin) {
  try {
    require(palpate_library_load(library.c_str(), &library_));
    require(palpate_state_create(library_, nullptr, &state_));
    if (!skin.empty()) require(palpate_deformation_load(library_, skin.c_str(), &skin_));
    makeSkin();
  } catch (...) {
    palpate_deformation_destroy(skin_);
    palpate_state_destroy(state_);
    palpate_library_destroy(library_);
    throw;
  }
  touch_ = new Touch(this, state_);
  addEffect(touch_);
}

PalpateBody::~PalpateBody() {
  deleteAllEffects();
  palpate_deformation_destroy(skin_);
  palpate_state_destroy(state_);
  palpate_library_destroy(library_);
}

void PalpateBody::makeSkin() {
  palpate_library_info surface{};
  palpate_deformation_info fine{};
  surface.size = sizeof surface;
  fine.size = sizeof fine;
  require(palpate_library_describe(library_, &surface));
  if (skin_ != nullptr) require(palpate_deformation_describe(skin_, &fine));
  const auto vertices = static_cast<std::size_t>(skin_ ? fine.vertices : surface.vertices);
  const auto count = static_cast<std::size_t>(skin_ ? fine.triangles : surface.triangles);
  std::vector<std::int32_t> corners(3 * count);
  positions_.resize(3 * vertices);
  require(skin_ ? palpate_deformation_vertices(skin_, positions_.data(), vertices)
                : palpate_library_vertices(library_, positions_.data(), vertices));
  require(skin_ ? palpate_deformation_triangles(skin_, corners.data(), count)
                : palpate_library_triangles(library_, corners.data(), count));
  for (std::size_t i = 0; i < positions_.size(); i += 3)
    newVertex(positions_[i], positions_[i + 1], positions_[i + 2]);
  for (std::size_t i = 0; i < corners.size(); i += 3)
    newTriangle(static_cast<unsigned>(corners[i]), static_cast<unsigned>(corners[i + 1]),
                static_cast<unsigned>(corners[i + 2]));
  computeAllNormals();
}

void PalpateBody::setTimeStep(double seconds) {
  touch_->setTimeStep(seconds);
}

void PalpateBody::updateSkin() {
  if (skin_ == nullptr) return;
  require(palpate_deform(state_, skin_, positions_.data(), positions_.size() / 3));
  for (unsigned i = 0; i < getNumVertices(); ++i)
    m_vertices->setLocalPos(i, positions_[3 * i], positions_[3 * i + 1], positions_[3 * i + 2]);
  computeAllNormals();
  markForUpdate(false);
}

chai3d::cVector3d PalpateBody::middle() const {
  palpate_library_info box{};
  box.size = sizeof box;
  require(palpate_library_describe(library_, &box));
  return {(box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2,
          (box.low[2] + box.high[2]) / 2};
}

palpate_observation PalpateBody::observation() const {
  palpate_observation seen{};
  seen.size = sizeof seen;
  palpate_observe(state_, &seen);
  return seen;
}
