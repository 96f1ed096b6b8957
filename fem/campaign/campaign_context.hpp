// SPDX-License-Identifier: AGPL-3.0-or-later
// What all sites of a campaign share.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "fem/campaign/campaign.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fem/solve/newton.hpp"

namespace palpate::fem {

/// Which solver finds the equilibria.
enum class Engine {
  Direct,       ///< Newton with a factorization of the whole body per iteration: the reference
  SharedFactor  ///< one factor for all sites and a window around the tool; Direct where that fails
};

/// What all sites share: the model, the factor of the rest stiffness, the settings.
struct CampaignContext {
  /// `kept`: shared with earlier campaigns on the body; may be null.
  CampaignContext(const Body& body, const CampaignSettings& settings, Engine engine,
                  FactorCache* kept = nullptr);

  /// Of a response vertex, or of a point of the settings by its index when there are any.
  PressPoint place(std::int32_t vertex) const;
  /// Where a point of the boundary is before it is touched.
  Eigen::Vector3d rest_position(const Vec3& X) const;

  const Body& body;
  std::vector<PressPoint> points;
  IndentationSettings indentation;
  Engine engine;
  SolidModel model;
  std::vector<int> permutation;  ///< elimination order of the whole body
  Displacement rest;          ///< where the body is before it is touched: sagged under its weight
  SolidModel::State at_rest;  ///< there
  ContactStiffness contact_stiffness;
  std::shared_ptr<const RestFactor> rest_factor;  ///< SharedFactor only
  mutable std::mutex direct_solve;                ///< held while a site factorizes the whole body
};

/// Of the part of the body around a site where the strains are large, m.
double window_radius(const CampaignContext& context);
/// That part.
SolidModel window_at(const CampaignContext& context, const Eigen::Vector3d& site);

/// Memory of a site under way, at most.
double bytes_of_site(const CampaignContext& context, std::int32_t vertex);

/// The largest Young's modulus at rest behind the boundary, and a multiple of it over the radius of
/// the tool. What lies deeper must not stiffen the contact.
ContactStiffness contact_stiffness(const Body& body, const CampaignSettings& settings,
                                   const SolidModel& model);

}  // namespace palpate::fem
