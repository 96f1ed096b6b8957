// SPDX-License-Identifier: AGPL-3.0-or-later
// What the stages of the pipeline report while they work. Sinks turn events into text or JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/remaining_time.hpp"
#include "fitting/fidelity/fidelity.hpp"
#include "format/curves.hpp"
#include "format/site_progress.hpp"

namespace palpate::app {

/// A stage of `palpate build` begins, because its artifact is missing or out of date.
struct StageStarted {
  std::string stage;
  std::filesystem::path file;
  std::string reason;
};

/// An artifact is up to date: its stage does not run.
struct StageUpToDate {
  std::string stage;
  std::filesystem::path file;
};

struct LogLine {
  std::string stage, text;
};

/// What a search that was asked for has shown, in words.
struct ChallengeVerdict {
  std::string stage, text;
};

struct Warning {
  std::string stage, text;
};

struct MeshFinished {
  std::size_t nodes = 0, tetrahedra = 0, response_triangles = 0;
  std::int64_t sites = 0;
  std::filesystem::path file;
};

struct CampaignStarted {
  std::string blas_kernel;
  std::size_t known_sites = 0;      ///< found in the journal of an interrupted run
  std::uint64_t dropped_bytes = 0;  ///< of a site that was being written when that run stopped
  bool moved_aside = false;         ///< the journal of another campaign
  std::filesystem::path journal;
  SiteSharing sharing = {};  ///< of its sites
};

/// A step towards the equilibrium under the weight, which stands before the sites.
struct PreloadStep {
  int steps = 0;       ///< of Newton's method, so far
  double carried = 0;  ///< part of the weight, 0 .. 1, of the last equilibrium
  int shapes = 0;      ///< that were tried as the shape without weight
};

struct SiteFinished {
  std::int32_t vertex = -1;
  SiteStatus status = SiteStatus::Complete;
  std::string reason;  ///< why it is not complete
  double cpu_seconds = 0;
};

struct Progress {
  std::int64_t done = 0;
  std::int64_t failed = 0;  ///< of `done`: failed or stopped early
  std::int64_t running = 0, total = 0;
  std::int64_t known = 0;           ///< of `done`: found in the journal
  std::vector<SiteProgress> sites;  ///< those that run
  bool between_sites = false;       ///< none has finished since the last one
};

/// Sites that are pressed again on a finer mesh, for the error of the mesh.
struct FinerMeshProgress : Progress {};

/// A round of adaptive sampling.
struct SamplingRound {
  int number = 0;
  std::size_t sites = 0, of_sites = 0;  ///< computed; response vertices that may be sites
  double leave_one_out = 0;  ///< 95th-percentile error of interpolation at the computed sites
  /// Relative error of the forces of normal presses at hold-out points: along the press, which is
  /// what responses carry, and as vectors.
  fidelity::ErrorRow along, whole;
  std::size_t points_failed = 0;  ///< hold-out points without a complete direct solution
};

struct SamplingFinished {
  bool tolerance_met = false;
  std::string reason;
};

/// Sites by status: they decide the exit code.
struct SiteCounts {
  std::size_t complete = 0, partial = 0, failed = 0;
  std::size_t without_response = 0;  ///< of partial and failed: their curves cannot be fitted
  std::size_t refused = 0;           ///< records, or sites of them, that are not in the curves
  bool all_complete() const { return partial == 0 && failed == 0 && refused == 0; }
  /// Whether a library of these sites is usable: at most a twentieth of them is without a response,
  /// and nothing that was measured is missing without the user's consent.
  bool usable() const {
    return refused == 0 && 20 * without_response <= complete + partial + failed;
  }
};

struct CampaignFinished {
  SiteCounts counts;
  double seconds = 0, cpu_seconds = 0;
  std::filesystem::path file;
  std::vector<SiteFinished> incomplete;
};

struct MergeFinished {
  std::size_t sites = 0, parts = 0;
  SiteCounts counts;
  std::filesystem::path file;
};

/// Median and largest relative error of the responses, and the site of the largest.
struct FitErrors {
  double median = 0, worst = 0;
  std::int32_t vertex = -1;
};

struct FitFinished {
  std::size_t fitted = 0, interpolated = 0, holes = 0;
  /// Errors relative to the largest force of the site: see fitting::SiteFitError.
  FitErrors normal, lateral, spread;
  std::filesystem::path file;
  FitErrors mesh{};          ///< of the mesh in the normal curves; vertex -1: unknown
  FitErrors lateral_mesh{};  ///< of the mesh in the lateral curves
  std::string accuracy{};    ///< both errors in one sentence
};

/// A library was certified. Infinite: no bound exists. NaN: unknown.
struct Certified {
  std::string guarantee;  ///< what is guaranteed of the force, and by what
  double friction = 0;
  double stick_bound = 0, slip_bound = 0;                ///< N/m
  double min_enforceable_bound = 0, enforced_bound = 0;  ///< N/m
  std::string limited_by;
  std::vector<std::pair<std::string, std::string>> devices;  ///< name, verdict
  std::filesystem::path file;
};

/// The stiffest response that is certified for a device at a sampling rate, and what the library
/// lacks for it.
struct StiffnessAtRate {
  std::string device;
  double rate = 0;                                                          ///< Hz
  double certifiable_stiffness = std::numeric_limits<double>::quiet_NaN();  ///< N/m, by damping
  double library_bound = 0;          ///< N/m, max(L_stick, L_slip)
  double min_enforceable_bound = 0;  ///< N/m
  std::size_t triangles_over = 0, triangles = 0;
  std::int32_t worst_triangle = -1;
  /// N/m, by dry friction at the resolution of the device.
  double certifiable_by_friction = std::numeric_limits<double>::quiet_NaN();
  /// N/m, sigma_0(B)/(2T) [Mahvash & Hayward 2005, eq. 5].
  double published_stiffness = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> unknown{};  ///< constants of the device that are not known
};

/// A library was changed until it is certified at a rate.
struct Softened {
  std::size_t curves = 0;  ///< with capped slopes
  double slope_cap = 0;    ///< N/m
  double median_loss = 0, p95_loss = 0,
         largest_loss = 0;  ///< fraction of the force at the last knot
  std::filesystem::path file;
};

/// The steepest force that a search found, beside the bound of the library.
struct SteepestForce {
  std::string contact;          ///< "sticking", "sliding"
  double slope = 0, bound = 0;  ///< N/m
  std::int32_t triangle = -1;   ///< -1: nothing was searched
  double largest_ratio = 0;     ///< of a slope to the bound of its own triangle
  std::int64_t tries = 0;
};

/// A mesh of a convergence study was solved.
struct ConvergenceLevel {
  double element_size = 0;  ///< m
  std::int64_t unknowns = 0;
  double cpu_seconds_per_site = 0;
};

/// The limit of one force of a convergence study.
struct ConvergenceOfForce {
  std::int32_t vertex = -1;
  std::string quantity;
  std::vector<double> forces;  ///< N, by level
  bool has_order = false;
  double order = 0, limit = 0;  ///< limit: N
  double error = 0;             ///< of the first level, relative
  double bound = 0;             ///< of |error|
};

/// What a campaign will take, from trial sites. Nothing was written.
struct Estimate {
  std::size_t sites = 0;
  bool adaptive = false;  ///< `sites` is the most that adaptive sampling may compute
  std::size_t nodes = 0;
  std::int64_t unknowns = 0;
  double seconds = 0, set_up_seconds = 0;  ///< of the campaign; of that, before its first site
  int threads = 1;
  double memory_bytes = 0;   ///< of the process
  double library_bytes = 0;  ///< of library.h5; 0: unknown
  std::size_t trial_sites = 0;
  double trial_seconds = 0;
};

struct FileWritten {
  std::string stage;
  std::filesystem::path file;
};

using Event =
    std::variant<StageStarted, StageUpToDate, LogLine, ChallengeVerdict, Warning, MeshFinished,
                 CampaignStarted, PreloadStep, SiteFinished, Progress, FinerMeshProgress,
                 SamplingRound, SamplingFinished, CampaignFinished, MergeFinished, FitFinished,
                 Certified, StiffnessAtRate, Softened, SteepestForce, ConvergenceLevel,
                 ConvergenceOfForce, Estimate, FileWritten>;

/// Receives the events of a stage, from one thread at a time.
using EventSink = std::function<void(const Event&)>;

}  // namespace palpate::app
