// SPDX-License-Identifier: AGPL-3.0-or-later
// Data that all sites of a campaign share.
#pragma once

#include <memory>
#include <mutex>
#include <semaphore>
#include <string>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "fem/contact/contact.hpp"
#include "fem/factor/front_memory.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fem/factor/solve_pool.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/solve/unloaded_shape.hpp"

namespace palpate::fem {

struct CampaignCache;

/// The solver of the equilibria.
enum class Engine {
  Direct,       ///< Newton with a factorization of the whole body per iteration: the reference
  SharedFactor  ///< one factor for all sites and a window around the tool; Direct where that fails
};

/// What all sites share: the model, the factor of the rest stiffness, the settings. Read-only for
/// sites but for its locks.
struct CampaignContext {
  /// `cache`: shared with earlier campaigns on the body; may be null.
  CampaignContext(const Body& body, const CampaignSettings& settings, Engine engine,
                  CampaignCache* cache = nullptr);

  /// The point and direction of a response vertex; of a point of the settings, by its index, when
  /// there are any.
  PressPoint press_point(std::int32_t vertex) const;
  /// Position of a point of the given surface before the tool touches it.
  Eigen::Vector3d rest_position(const Vec3& point) const;
  /// Its position X in the model: without weight.
  Eigen::Vector3d reference_position(const Vec3& point) const;

  const Body& body;  ///< as given
  /// Where the given shape is the loaded one: the body without weight, which the model has.
  std::shared_ptr<const UnloadedBody> unloaded;
  std::vector<PressPoint> points;
  IndentationSettings indentation;
  RegionRelaxation relaxation;  ///< of the regions of the body; empty where it is elastic
  Engine engine;
  SolidModel model;
  std::vector<int> permutation;  ///< elimination order of the whole body
  Displacement rest;             ///< before the tool touches the body: displaced by its weight
  SolidModel::State at_rest;     ///< there
  double round_off;              ///< N, residual that is rounding of the equilibrium at rest
  ContactStiffness contact_stiffness;
  std::shared_ptr<const RestFactor> rest_factor;  ///< SharedFactor only
  mutable SharedFronts window_fronts;             ///< of the sites: few are computed at a time
  mutable std::mutex direct_solve;                ///< locked while a site factorizes the whole body
  /// Places for factors that sites have of their own, as many as memory has room for.
  mutable std::counting_semaphore<> own_factors{0};

 private:
  struct Preloaded;
  static Preloaded preloaded(const Body& body, const CampaignSettings& settings, Engine engine,
                             CampaignCache* cache);
  CampaignContext(const Body& body, const CampaignSettings& settings, Engine engine,
                  CampaignCache* cache, Preloaded&& start);
};

/// A place for a factor that a site has of its own. Waits until one is free, without keeping a
/// core.
class OwnFactorPlace {
 public:
  OwnFactorPlace(const CampaignContext& context, SolvePool::Member& member)
      : places_(context.own_factors) {
    if (!places_.try_acquire()) member.without_core([&] { places_.acquire(); });
  }
  ~OwnFactorPlace() { places_.release(); }
  OwnFactorPlace(const OwnFactorPlace&) = delete;
  OwnFactorPlace& operator=(const OwnFactorPlace&) = delete;

 private:
  std::counting_semaphore<>& places_;
};

/// Why elements cannot be refined under the tool: refined ones are quadratic. Empty where they can.
std::string obstacle_to_refinement(const CampaignSettings& settings);

/// From the largest Young's modulus at rest of the regions at the boundary: stiffer regions inside
/// must not stiffen the contact.
ContactStiffness contact_stiffness(const Body& body, const CampaignSettings& settings,
                                   const SolidModel& model);

}  // namespace palpate::fem
