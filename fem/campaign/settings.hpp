// SPDX-License-Identifier: AGPL-3.0-or-later
// Settings of a campaign.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/solid/dilatation.hpp"
#include "fem/solid/gravity.hpp"
#include "fem/solve/preload_progress.hpp"
#include "format/curves.hpp"
#include "format/relaxation.hpp"
#include "format/site_fields.hpp"
#include "format/site_progress.hpp"
#include "format/vec3.hpp"

namespace palpate::fem {

struct RegionMaterial {
  std::string region;  ///< name of a region of the body
  LawConstants law;
  double density = 0;  ///< kg/m^3, at rest; 0: that of the gravity
  /// How the isochoric stress relaxes; the constants of `law` are then the instantaneous ones.
  RelaxationSeries relaxation = {};

  bool operator==(const RegionMaterial&) const = default;
};

struct IndentationSettings {
  ToolGeometry tool;
  ToolFriction friction = ToolFriction::Frictionless;  ///< of the normal path
  double tool_azimuth = 0;  ///< rad, of the axis of a cylinder, from the first tangent of the site
  double depth = 0.006;     ///< m, end of the normal path
  int increments = 6;       ///< of the normal path
  double lateral_travel = 0.003;  ///< m, end of each lateral path
  int lateral_increments = 3;
  std::vector<double> lateral_depths{
      0.002, 0.004, 0.006};           ///< m, where lateral paths start; each at most `depth`
  std::vector<double> azimuths{0.0};  ///< rad, from the first tangent direction of the site
  /// With a single azimuth a shorter path across it as well, at the middle lateral depth: the force
  /// along the press direction is then known for drags in any direction.
  bool drag_across = false;
  double force_tolerance = 1e-4;  ///< relative error of the tool force allowed to the solver
  /// How often the elements around the tool are divided into eight, for each site anew: for
  /// contacts smaller than a facet. Each further time within half the distance from the site.
  int refine_under_tool = 0;
  static constexpr int kMaxRefinements = 6;
  /// Instead of a number: as often as the contact asks for, see SiteRefinement.
  static constexpr int kByContact = -1;
  double size_over_contact = 1.75;  ///< of elements under the tool, over the contact radius
  /// All elements under the tool are divided once more than the settings above ask for, those that
  /// the contact divides as well, and those that it would divide: the error of the mesh shows.
  bool divide_once_more = false;

  bool refines() const { return refine_under_tool != 0 || divide_once_more; }
};

/// A point of the boundary where the tool is pressed, and the direction of its normal path.
struct PressPoint {
  Vec3 position{};  ///< m
  Vec3 inward{};    ///< unit, into the body
};

/// State of a campaign, reported after each finished site.
struct CampaignProgress {
  std::int64_t done = 0, failed = 0, total = 0;
  std::int64_t known = 0;           ///< of `done`: results of an earlier run
  std::int64_t running = 0;         ///< sites that have been started
  std::vector<SiteProgress> sites;  ///< those that run
};

struct CampaignSettings {
  std::vector<RegionMaterial> materials;  ///< one for each region of the body
  Dilatation dilatation = Dilatation::Mean;
  /// The weight is applied first; depths, work and energy are counted from that state.
  Gravity gravity{{}, 1000};
  IndentationSettings indentation;
  /// Number of sites that the caller of run_campaign presses on a finer mesh too, for the error of
  /// the mesh of all sites (press_on_finer_mesh); 0: the error stays unknown.
  int mesh_error_sites = 0;
  std::vector<std::int32_t> sites;  ///< response vertices; empty = every vertex with is_site
  /// Pressed instead of response vertices when not empty; the `vertex` of a result is then the
  /// index of its point. Such curves cannot be fitted.
  std::vector<PressPoint> points;
  int threads = 1;
  double memory = 0;  ///< bytes the process may use; 0: no bound. Limits the concurrent sites
  std::vector<SiteCurves> known;  ///< results of an earlier run of the campaign: not repeated
  /// Called for each site as it finishes, and then with the progress, which also stands before the
  /// first site; from one thread at a time.
  /// After an exception no further site starts; it is rethrown once the running sites are done.
  std::function<void(const SiteCurves&)> finished;
  /// The displacement of the skin (SkinMesh::node) of each site, just before `finished`; null: it
  /// is not kept.
  std::function<void(SiteFields)> fields;
  int field_depths = 0;  ///< number of depths that are kept, see fem::field_depths
  /// Keeps of the lateral paths also the states that this friction coefficient holds, and the press
  /// at their depths; none: the ends of the paths alone.
  std::optional<double> field_friction;
  std::function<void(const CampaignProgress&)> progress;
  /// Called in every step towards the equilibrium under the weight; may be null.
  std::function<void(const PreloadProgress&)> preloading;
  /// Called at the start and after every increment of every site, from one thread at a time; may be
  /// null.
  std::function<void(const CampaignProgress&)> advanced;
};

/// The tool as curves name it.
ToolDescription description_of(const IndentationSettings& settings);

/// @throws Error(Configuration) when a length is not positive and finite, a lateral depth exceeds
/// the depth, a count is below one, or a disc with a sharp edge is pressed without friction.
void check_indentation(const IndentationSettings& settings);

}  // namespace palpate::fem
