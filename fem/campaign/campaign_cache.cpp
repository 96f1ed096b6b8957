// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign_cache.hpp"

#include <utility>

namespace palpate::fem {

PreloadCache::Key::Key(const CampaignSettings& settings)
    : materials(settings.materials), dilatation(settings.dilatation), gravity(settings.gravity) {}

const Preload* PreloadCache::find(const CampaignSettings& settings) const {
  return last_ && last_->key == Key(settings) ? &last_->preload : nullptr;
}

void PreloadCache::keep(const CampaignSettings& settings, Preload preload) {
  last_ = Entry{Key(settings), std::move(preload)};
}

}  // namespace palpate::fem
