// SPDX-License-Identifier: AGPL-3.0-or-later
// The keys of every event. The JSON sink and the reference in docs/campaigns.md are visitors of
// this description.
#pragma once

#include <string_view>

#include "app/pipeline/events.hpp"
#include "format/passivity.hpp"
#include "format/status_name.hpp"

namespace palpate::app {

template <class V>
void describe(V& v, const StageStarted& e) {
  v.event("stage", "`build` runs a stage");
  v.field("stage", e.stage, "`mesh`, `precompute`, `fit` or `certify`");
  v.field("file", e.file.string(), "artifact of the stage");
  v.field("reason", e.reason, "why the artifact must be made");
}

template <class V>
void describe(V& v, const StageUpToDate& e) {
  v.event("up_to_date", "a stage has nothing to do");
  v.field("stage", e.stage, "the stage");
  v.field("file", e.file.string(), "its artifact");
}

template <class V>
void describe(V& v, const LogLine& e) {
  v.event("log", "a line of the log of a stage");
  v.field("stage", e.stage, "the stage");
  v.field("text", e.text, "the line");
}

template <class V>
void describe(V& v, const ChallengeVerdict& e) {
  v.event("verdict", "a result of `certify --challenge` in words");
  v.field("stage", e.stage, "the stage");
  v.field("text", e.text, "the result");
}

template <class V>
void describe(V& v, const Warning& e) {
  v.event("warning", "the result may not be what was intended");
  v.field("stage", e.stage, "the stage");
  v.field("text", e.text, "problem and remedy");
}

template <class V>
void describe(V& v, const MeshFinished& e) {
  v.event("mesh", "`body.h5` is written");
  v.field("nodes", e.nodes, "nodes of the mesh");
  v.field("tetrahedra", e.tetrahedra, "tetrahedra of the mesh");
  v.field("response_triangles", e.response_triangles, "triangles of the response surface");
  v.field("sites", e.sites, "response vertices that may be pressed");
  v.field("file", e.file.string(), "path of `body.h5`");
}

template <class V>
void describe(V& v, const CampaignStarted& e) {
  v.event("start", "a campaign begins or continues");
  v.field("blas_kernel", e.blas_kernel, "kernel of the BLAS, on which the bits depend");
  v.field("known_sites", e.known_sites, "sites found in the journal, which are not repeated");
  v.field("dropped_bytes", e.dropped_bytes,
          "length of an incomplete record at the end of the journal");
  v.field("moved_aside", e.moved_aside, "whether the journal of another campaign was moved aside");
}

template <class V>
void describe(V& v, const PreloadStep& e) {
  v.event("preload", "follows each step towards the equilibrium under the weight");
  v.field("steps", e.steps, "steps of Newton's method so far");
  v.field("carried", e.carried, "part of the weight, 0 .. 1, of the last equilibrium");
  v.field("shapes", e.shapes, "shapes without weight that were tried, with `shape = \"loaded\"`");
}

template <class V>
void describe(V& v, const SiteFinished& e) {
  v.event("site", "a site is finished");
  v.field("vertex", e.vertex, "response vertex");
  v.field("status", status_name(e.status), "`complete`, `partial` (stopped early) or `failed`");
  v.field("reason", e.reason, "why the site is not complete");
  v.field("cpu_seconds", e.cpu_seconds, "CPU time, s");
}

template <class V>
void describe(V& v, const Progress& e) {
  v.event("progress", "stands before the first `site` and follows each");
  v.field("done", e.done, "finished sites, with those of the journal");
  v.field("failed", e.failed, "how many of them failed or stopped early");
  v.field("running", e.running, "sites that run");
  v.field("total", e.total, "sites of the campaign or of the round");
}

template <class V>
void describe(V& v, const FinerMeshProgress& e) {
  v.event("finer_mesh",
          "sites are pressed again on a finer mesh, for the error of the mesh; stands before the "
          "first of them is finished and after each");
  v.field("done", e.done, "finished sites");
  v.field("total", e.total, "sites on the finer mesh");
}

template <class V>
void describe(V& v, const SamplingRound& e) {
  v.event("round", "a round of adaptive sampling is finished");
  v.field("round", e.number, "number of the round, from 1");
  v.field("sites", e.sites, "sites so far");
  v.field("of_sites", e.of_sites, "response vertices that may be sites");
  v.field("leave_one_out_error_p95", e.leave_one_out,
          "95th-percentile relative error of interpolation at the sites");
  v.field("hold_out_states", e.along.states, "states compared at hold-out points");
  v.field("hold_out_points_failed", e.points_failed, "hold-out points without a direct solution");
  v.field("error_along_press", e.along,
          "`median`, `p95` and `worst` relative error of the force along the press");
  v.field("error_of_vector", e.whole, "the same of the force vector");
}

template <class V>
void describe(V& v, const SamplingFinished& e) {
  v.event("sampling_end", "adaptive sampling is finished");
  v.field("tolerance_met", e.tolerance_met, "whether the error is within the tolerance");
  v.field("reason", e.reason, "why no sites are added");
}

template <class V>
void describe_counts(V& v, const SiteCounts& counts) {
  v.field("complete", counts.complete, "complete sites");
  v.field("partial", counts.partial, "sites that stopped early");
  v.field("failed", counts.failed, "failed sites");
}

template <class V>
void describe(V& v, const CampaignFinished& e) {
  v.event("end", "`curves.h5`, or the part of a shard, is written");
  describe_counts(v, e.counts);
  v.field("seconds", e.seconds, "elapsed time, s");
  v.field("cpu_seconds", e.cpu_seconds, "CPU time of the sites, s");
  v.field("file", e.file.string(), "path of the curves");
}

template <class V>
void describe(V& v, const MergeFinished& e) {
  v.event("merge", "parts are merged into `curves.h5`");
  v.field("sites", e.sites, "all sites");
  v.field("parts", e.parts, "merged parts");
  describe_counts(v, e.counts);
  v.field("file", e.file.string(), "path of `curves.h5`");
}

template <class V>
void describe(V& v, const FitFinished& e) {
  v.event("fit", "`library.h5` is written");
  v.field("fitted", e.fitted, "responses from the curves of their own vertex");
  v.field("interpolated", e.interpolated, "responses from the neighbours of their vertex");
  v.field("holes", e.holes, "vertices without a response");
  v.field("normal_error", e.normal,
          "`median` and `worst` error of the normal responses over the largest force of the site, "
          "and the `vertex` of the worst");
  v.field("lateral_error", e.lateral,
          "the same of the lateral responses, to the mean of the paths that they stand for");
  v.field("lateral_spread", e.spread, "the same, to any single path");
  v.field("mesh_error", e.mesh,
          "bound of the error of the mesh in the normal curves; `vertex` -1: unknown");
  v.field("lateral_mesh_error", e.lateral_mesh, "the same in the lateral curves");
  v.field("accuracy", e.accuracy, "both errors at the vertices, in one sentence");
  v.field("file", e.file.string(), "path of `library.h5`");
}

template <class V>
void describe(V& v, const Certified& e) {
  v.event("certificate", "a library is certified; a bound that does not exist is null");
  v.field("guarantee", e.guarantee, "what is guaranteed of the force, and by what");
  v.field("friction", e.friction, "friction coefficient mu");
  v.field("L_stick", e.stick_bound, "Lipschitz bound of the force with a fixed contact point, N/m");
  v.field("L_slip", e.slip_bound, "Lipschitz bound along a slide, N/m");
  v.field("L_min", e.min_enforceable_bound, "smallest bound that the runtime can enforce, N/m");
  v.field("enforced_bound", e.enforced_bound, "bound that the runtime enforces, N/m");
  v.field("limited_by", e.limited_by, "what sets the bound in the worst triangle");
  v.field("devices", e.devices, "verdict for each device, by name");
  v.field("file", e.file.string(), "path of the library");
}

template <class V>
void describe(V& v, const StiffnessAtRate& e) {
  v.event("stiffness_at_rate", "`certify --rate`, for one device");
  v.field("device", e.device, "name of the device");
  v.field("rate", e.rate, "sampling rate, Hz");
  v.field("certifiable_stiffness", e.certifiable_stiffness,
          "largest bound that damping certifies, N/m; null where damping or delay is unknown");
  v.field("certifiable_by_friction", e.certifiable_by_friction,
          "the same by dry friction at the resolution of the device; null: unknown or no limit");
  v.field("published_stiffness", e.published_stiffness,
          "sigma_0(B)/(2T) of Mahvash & Hayward 2005, eq. 5, N/m");
  v.field("unknown", list_in_words(e.unknown), "constants of the device that are not known");
  v.field("library_bound", e.library_bound, "larger of L_stick and L_slip of the library, N/m");
  v.field("L_min", e.min_enforceable_bound, "smallest bound that the runtime can enforce, N/m");
  v.field("triangles_over", e.triangles_over, "triangles whose bound exceeds it");
  v.field("triangles", e.triangles, "all triangles");
  v.field("worst_triangle", e.worst_triangle, "triangle with the largest bound");
}

template <class V>
void describe(V& v, const Softened& e) {
  v.event("softened", "`certify --soften`");
  v.field("curves", e.curves, "curves with capped slopes");
  v.field("slope_cap", e.slope_cap, "largest slope left, N/m");
  v.field("median_loss", e.median_loss, "median fraction of the force lost at the last knot");
  v.field("p95_loss", e.p95_loss, "95th percentile of that fraction");
  v.field("largest_loss", e.largest_loss, "largest such fraction");
  v.field("file", e.file.string(), "path of the new library");
}

template <class V>
void describe(V& v, const SteepestForce& e) {
  v.event("steepest_force", "`certify --challenge`, for one kind of contact");
  v.field("contact", e.contact, "`sticking` or `sliding`");
  v.field("slope", e.slope, "largest change of force per travel found, N/m");
  v.field("bound", e.bound, "bound of the library, N/m");
  v.field("triangle", e.triangle, "where; -1 when nothing was searched");
  v.field("largest_ratio", e.largest_ratio,
          "largest ratio of a slope to the bound of its triangle");
  v.field("tries", e.tries, "evaluated motions");
}

template <class V>
void describe(V& v, const ConvergenceLevel& e) {
  v.event("convergence_level", "`precompute --convergence` solved a mesh");
  v.field("element_size", e.element_size, "m");
  v.field("unknowns", e.unknowns, "degrees of freedom");
  v.field("cpu_seconds_per_site", e.cpu_seconds_per_site, "CPU time, s");
}

template <class V>
void describe(V& v, const ConvergenceOfForce& e) {
  v.event("convergence", "limit of one force over all meshes");
  v.field("vertex", e.vertex, "response vertex");
  v.field("quantity", e.quantity, "which force");
  v.field("forces", e.forces, "on each mesh, N");
  v.field("has_order", e.has_order, "whether the last three follow a power of the element size");
  v.field("order", e.order, "the power; null without one");
  v.field("limit", e.limit, "extrapolated force, N; without an order that of the last mesh");
  v.field("error", e.error, "relative error of the force on the first mesh");
  v.field("bound", e.bound, "bound of its magnitude");
}

template <class V>
void describe(V& v, const Estimate& e) {
  v.event("estimate", "`--estimate`: what a campaign will take, from trial sites");
  v.field("sites", e.sites, "sites to be computed");
  v.field("adaptive", e.adaptive, "whether adaptive sampling may need fewer");
  v.field("nodes", e.nodes, "nodes of the mesh");
  v.field("unknowns", e.unknowns, "degrees of freedom");
  v.field("seconds", e.seconds, "duration of the campaign, s");
  v.field("set_up_seconds", e.set_up_seconds, "of that, before the first site, s");
  v.field("threads", e.threads, "threads");
  v.field("memory_bytes", e.memory_bytes, "memory of the process");
  v.field("library_bytes", e.library_bytes, "size of `library.h5`; 0: unknown");
  v.field("trial_sites", e.trial_sites, "computed for the estimate");
  v.field("trial_seconds", e.trial_seconds, "duration of the estimate, s");
}

template <class V>
void describe(V& v, const FileWritten& e) {
  v.event("file", "another file is written");
  v.field("stage", e.stage, "the stage");
  v.field("file", e.file.string(), "its path");
}

/// Markdown table of all events and keys.
std::string event_reference();

}  // namespace palpate::app
