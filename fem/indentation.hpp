// SPDX-License-Identifier: AGPL-3.0-or-later
// One site: the tool is pressed along the inward direction, then, held at chosen depths, moved
// sideways with the contact stuck.
#pragma once

#include <memory>
#include <vector>

#include "fem/campaign.hpp"
#include "fem/newton.hpp"

namespace palpate::fem {

/// Which solver serves the Newton steps.
enum class Engine {
  Direct,   ///< a factorization per iteration: the reference
  TwoLevel  ///< shared rest factor and a window, direct as fall-back
};

/// What all sites share: the model, the rest factor (TwoLevel), the settings.
struct CampaignContext {
  CampaignContext(const Body& body, const CampaignSettings& settings, Engine engine);

  const Body& body;
  IndentationSettings indentation;
  Engine engine;
  SolidModel model;
  double contact_stiffness;  ///< eps, N/m^3
  std::unique_ptr<Cholesky> rest_factor;
};

/// Solves sites one after another on one thread.
class SiteSolver {
 public:
  explicit SiteSolver(const CampaignContext& context) : context_(context) {}

  /// All paths of a site. A failure is recorded in the result, never thrown.
  SiteCurves solve(std::int32_t vertex);

  /// The end of the normal path of the site last solved.
  const Displacement& pressed_state() const { return pressed_; }

 private:
  struct Site;  ///< geometry and solvers of one site

  void run_normal_path(Site& site, SiteCurves& curves);
  void run_lateral_path(Site& site, double held_depth, double azimuth, SiteCurves& curves);

  const CampaignContext& context_;
  Displacement pressed_;
};

/// Two unit vectors that complete `normal` to a right-handed orthonormal frame; azimuth 0 points
/// along the first. The frame is a function of the normal alone.
std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal);

/// Integral of y over x by parabolas through neighbouring samples, third-order accurate for uneven
/// steps; running value at each sample.
std::vector<double> running_integral(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace palpate::fem
