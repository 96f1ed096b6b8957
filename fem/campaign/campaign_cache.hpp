// SPDX-License-Identifier: AGPL-3.0-or-later
// What successive campaigns on one body need not compute again.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fem/solve/unloaded_shape.hpp"

namespace palpate::fem {

/// The state of a body before the tool touches it.
struct Preload {
  std::shared_ptr<const UnloadedBody> unloaded;  ///< where the given shape is the loaded one
  Displacement rest;                             ///< of the model that has the whole weight
};

/// Keeps the last state. Not thread-safe.
class PreloadCache {
 public:
  /// That of the same materials, elements and gravity; null where the last one was of others.
  const Preload* find(const CampaignSettings& settings) const;
  void keep(const CampaignSettings& settings, Preload preload);

 private:
  /// What the state depends on beside the body.
  struct Key {
    explicit Key(const CampaignSettings& settings);
    bool operator==(const Key&) const = default;

    std::vector<RegionMaterial> materials;
    Dilatation dilatation;
    Gravity gravity;
  };
  struct Entry {
    Key key;
    Preload preload;
  };
  std::optional<Entry> last_;
};

/// Not thread-safe.
struct CampaignCache {
  FactorCache factors;
  PreloadCache preloads;
};

}  // namespace palpate::fem
