// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/timely_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "app/case/lengths.hpp"
#include "app/console.hpp"
#include "app/pipeline/trial_sites.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

constexpr int kMostChanges = 6;
/// Fraction of the wanted time after which the trial sites are given up, but not later than s.
constexpr double kPatience = 1.0 / 30, kMostPatience = 20;
/// Mean over median of the time of a site from which on thin parts are what takes the time.
constexpr double kUneven = 1.5;
constexpr double kShallower = 0.6;
/// Sites grow like the inverse square of the patch, and so does about the time of one.
constexpr double kTimeBySites = 2;
constexpr double kFewestAtOnce = 0.35, kMargin = 0.9;

/// Less refinement that takes more than this fraction of the time is taken back.
constexpr double kWorthwhile = 0.9;

double least_depth(const FirstSizes& sizes) {
  return kShallowestOverPatch * sizes.patch_spacing;
}

/// Sizes that become cheaper from trial to trial.
class Search {
 public:
  Search(const CaseOf& made, const FirstWishes& wishes)
      : made_(made),
        wishes_(wishes),
        wanted_(wishes.sites.value_or(FirstWishes::kUsualSites)),
        counted_(counted_case(made, wanted_)) {}

  const CountedCase& counted() const { return counted_; }

  void run() {
    for (int i = 0; counted_.body && wishes_.minutes > 0; ++i) {
      const double unevenness = try_campaign();
      const bool fits = *counted_.sizes.seconds <= 60 * wishes_.minutes;
      if (fits) return;
      refine_again_if_as_fast();
      if (i == kMostChanges) return;
      if (!save_time(unevenness)) return;
    }
  }

 private:
  /// @return mean over median of the time of a site
  double try_campaign() {
    Workspace space = made_.opened_with(counted_.sizes);
    space.threads = wishes_.threads;
    const double patience = std::min(kMostPatience, kPatience * 60 * wishes_.minutes);
    const Trial trial = press_trial_sites(space, *counted_.body, patience);
    counted_.sizes.seconds =
        campaign_seconds(space, trial, static_cast<std::size_t>(*counted_.sizes.sites));
    return trial.time.unevenness();
  }

  /// On small bodies elements of the case take no less time than those that the contact asks for.
  void refine_again_if_as_fast() {
    FirstSizes& sizes = counted_.sizes;
    if (sizes.refinement != Refinement::None || !may_refine_less_) return;
    may_refine_less_ = false;
    for (const auto& [refinement, seconds] : {once_, by_contact_}) {
      if (*sizes.seconds <= kWorthwhile * seconds) return;
      sizes.refinement = refinement;
      sizes.seconds = seconds;
    }
  }

  /// @return whether there was something to save
  bool save_time(double unevenness) {
    if (cheapest_saving(counted_.sizes, may_enlarge_, may_refine_less_) == Saving::LargerPatches) {
      if (enlarge_patches()) return true;
      may_enlarge_ = false;
    }
    FirstSizes& sizes = counted_.sizes;
    switch (cheapest_saving(sizes, false, may_refine_less_)) {
      case Saving::OneRefinement:
        by_contact_.second = *sizes.seconds;
        sizes.refinement = Refinement::Once;
        return true;
      case Saving::NoRefinement:
        once_.second = *sizes.seconds;
        sizes.refinement = Refinement::None;
        return true;
      case Saving::SmallerDepth:
        sizes.is_slow_where_thin = unevenness > kUneven;
        press_to(kShallower * sizes.depth);
        return true;
      default:
        return false;
    }
  }

  /// What was too thin for a deeper press has sites then, and those take the longest.
  void press_to(double depth) {
    FirstSizes& sizes = counted_.sizes;
    sizes.depth = two_digits(std::max(least_depth(sizes), depth));
    sizes.lateral_travel = two_digits(kTravelOverDepth * sizes.depth);
    sizes.is_shallow = true;
    count_sites(made_, counted_);
  }

  bool enlarge_patches() {
    const FirstSizes before = counted_.sizes;
    const double excess = *before.seconds / (60 * wishes_.minutes);
    const double fewer = std::max(kFewestAtOnce, kMargin * std::pow(excess, -1 / kTimeBySites));
    CountedCase larger = counted_case(
        made_, std::max(1, static_cast<int>(fewer * static_cast<double>(*before.sites))));
    if (!larger.body || *larger.sizes.sites >= *before.sites) return false;
    counted_ = std::move(larger);
    FirstSizes& sizes = counted_.sizes;
    sizes.sites_too_slow = before.sites_too_slow ? before.sites_too_slow : before.sites;
    return true;
  }

  const CaseOf& made_;
  const FirstWishes& wishes_;
  int wanted_;
  CountedCase counted_;
  bool may_enlarge_ = !wishes_.sites;  ///< the patches
  bool may_refine_less_ = true;
  /// With these the campaign took so long, s.
  std::pair<Refinement, double> by_contact_{Refinement::ByContact, 0}, once_{Refinement::Once, 0};
};

std::string remark_on_time(const FirstSizes& sizes, const FirstWishes& wishes) {
  std::string said =
      fmt::format("time: about {} on {}, from trial sites", duration_text(*sizes.seconds),
                  count_text(wishes.threads, "thread"));
  if (sizes.sites_too_slow)
    said += fmt::format("; {} would take longer than {:g} min",
                        count_text(*sizes.sites_too_slow, "site"), wishes.minutes);
  if (sizes.refinement == Refinement::Once)
    said +=
        "; elements are refined under the tool once, not as the contact asks for, which would take "
        "longer: the forces of shallow presses are less accurate";
  if (sizes.refinement == Refinement::None)
    said +=
        "; elements are not refined under the tool, which would take longer: the forces of "
        "shallow presses are less accurate";
  if (sizes.is_shallow)
    said += sizes.is_slow_where_thin
                ? "; pressed less deep, because deep presses of thin parts are slow"
                : "; pressed less deep, because deeper presses would still take longer";
  if (*sizes.seconds > 60 * wishes.minutes)
    said += fmt::format("; more than the {:g} min wanted: {}", wishes.minutes,
                        sizes.is_coarsest ? "larger patches would not show the shape"
                        : wishes.sites    ? "fewer --sites take less"
                                          : "larger patches or a smaller depth take less");
  return said;
}

}  // namespace

Saving cheapest_saving(const FirstSizes& sizes, bool may_enlarge, bool may_refine_less) {
  if (may_enlarge && !sizes.is_coarsest) return Saving::LargerPatches;
  if (may_refine_less && sizes.refinement == Refinement::ByContact) return Saving::OneRefinement;
  if (may_refine_less && sizes.refinement == Refinement::Once) return Saving::NoRefinement;
  const bool is_shallowest = sizes.depth <= least_depth(sizes) * (1 + 1e-6);
  return is_shallowest ? Saving::None : Saving::SmallerDepth;
}

FirstCase timely_case(const CaseOf& made, const FirstWishes& wishes) {
  Search search(made, wishes);
  search.run();
  const FirstSizes& sizes = search.counted().sizes;
  FirstCase first = made.with(sizes);
  if (!search.counted().body) {
    first.is_refused = true;
    first.remarks.push_back("`palpate mesh` refuses the body: " + search.counted().refusal);
    return first;
  }
  const bool was_left_open = !wishes.sites && sizes.sites_too_slow;
  first.remarks.push_back(
      remark_on_sites(sizes, was_left_open ? static_cast<int>(*sizes.sites)
                                           : wishes.sites.value_or(FirstWishes::kUsualSites)));
  if (sizes.seconds) first.remarks.push_back(remark_on_time(sizes, wishes));
  return first;
}

}  // namespace palpate::app
