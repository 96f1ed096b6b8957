// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/profile.hpp"

#include <ctime>

namespace palpate::fem {

namespace {

thread_local PartTimer* innermost = nullptr;

std::int64_t thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

}  // namespace

const char* name_of(Part part) {
  switch (part) {
    case Part::SiteMesh:
      return "models and mesh of the site";
    case Part::SharedSolves:
      return "solves with the shared factor";
    case Part::BodyPasses:
      return "passes over the elements of the body";
    case Part::WindowPasses:
      return "passes over the elements of the window";
    case Part::WindowAnalysis:
      return "symbolic analysis of the window";
    case Part::WindowFactor:
      return "factor of the window";
    case Part::WindowSolves:
      return "solves with the factor of the window";
    case Part::Contact:
      return "contact";
    case Part::Vectors:
      return "vectors of the quasi-Newton method";
  }
  return "";
}

void PartTimer::start() {
  active_profile->count(part_);
  started_ = thread_nanoseconds();
  outer_ = innermost;
  if (outer_ != nullptr) active_profile->add(outer_->part_, started_ - outer_->started_);
  innermost = this;
}

void PartTimer::stop() {
  const std::int64_t now = thread_nanoseconds();
  active_profile->add(part_, now - started_);
  innermost = outer_;
  if (outer_ != nullptr) outer_->started_ = now;
}

}  // namespace palpate::fem
