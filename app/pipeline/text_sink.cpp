// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/text_sink.hpp"

#include <algorithm>
#include <cmath>

#include "format/guarantee.hpp"
#include "format/number_text.hpp"
#include "format/passivity.hpp"

namespace palpate::app {
namespace {

std::string bound_text(double value) {
  return std::isfinite(value) ? lipschitz_bound_text(value) : "no bound";
}

std::string_view words(SiteStatus status) {
  switch (status) {
    case SiteStatus::Complete:
      return "complete";
    case SiteStatus::Partial:
      return "stopped early";
    case SiteStatus::Failed:
      return "failed";
  }
  return "";
}

std::string stiffness_text(double value) {
  return number_text(value, 4) + " N/m";
}

}  // namespace

void TextSink::operator()(const Event& event) {
  std::visit([this](const auto& e) { print(e); }, event);
}

void TextSink::print(const StageStarted& e) {
  line("{}: creating {} ({})", e.stage, e.file.string(), e.reason);
}

void TextSink::print(const StageUpToDate& e) {
  line("{}: {} is up to date", e.stage, e.file.string());
}

void TextSink::print(const LogLine& e) {
  line("  {}", e.text);
}

void TextSink::print(const ChallengeVerdict& e) {
  result("  {}", e.text);
}

void TextSink::warning(std::string_view text) {
  progress_.interrupt();
  console_.err.line(warning_line(text, console_.err.colour));
}

void TextSink::print(const Warning& e) {
  warning(e.text);
}

void TextSink::print(const MeshFinished& e) {
  line("mesh: {} nodes, {} tetrahedra, {} response triangles, {} -> {}", e.nodes, e.tetrahedra,
       e.response_triangles, count_text(e.sites, "site"), e.file.string());
}

void TextSink::print(const CampaignStarted& e) {
  sharing_ = e.sharing;
  progress_ = ProgressDisplay("precompute", console_.out, sharing_);  // its clock starts now
  line("  BLAS kernel: {}", e.blas_kernel);
  if (e.moved_aside)
    line("  {} belongs to another campaign: moved to {}.old", e.journal.string(),
         e.journal.filename().string());
  if (e.known_sites > 0)
    line("  {} found in {} {} not computed again", count_text(e.known_sites, "finished site"),
         e.journal.string(), e.known_sites == 1 ? "is" : "are");
  if (e.dropped_bytes > 0)
    line(
        "  an incomplete record at the end of the journal ({} bytes) is dropped; its site is "
        "computed again",
        e.dropped_bytes);
}

void TextSink::print(const PreloadStep& e) {
  if (console_.verbosity != Verbosity::Quiet) progress_.show(e);
}

void TextSink::print(const SiteFinished& e) {
  if (console_.verbosity == Verbosity::Verbose)
    line("  site {}: {}, {:.1f} s CPU time{}", e.vertex, words(e.status), e.cpu_seconds,
         e.reason.empty() ? "" : ": " + e.reason);
}

void TextSink::print(const Progress& e) {
  if (console_.verbosity != Verbosity::Quiet) progress_.show(e);
}

void TextSink::print(const FinerMeshProgress& e) {
  if (e.done == 0 && !e.between_sites) {
    progress_.interrupt();
    progress_ = ProgressDisplay("precompute, finer mesh", console_.out, sharing_);
  }
  if (console_.verbosity != Verbosity::Quiet) progress_.show(e);
}

void TextSink::print(const SamplingRound& e) {
  line(
      "  round {}: {} of {} sites; 95th-percentile error at hold-out points: {:.1f} % along the "
      "press, {:.1f} % as vectors (median {:.1f} %)",
      e.number, e.sites, e.of_sites, 100 * e.along.p95, 100 * e.whole.p95, 100 * e.whole.median);
}

void TextSink::print(const SamplingFinished& e) {
  if (e.tolerance_met) return line("  {}", e.reason);
  warning(e.reason);
}

void TextSink::print(const CampaignFinished& e) {
  constexpr std::size_t kMostListed = 5;
  line("precompute: {} complete, {} stopped early, {} failed, {} ({} CPU time) -> {}",
       count_text(e.counts.complete, "site"), e.counts.partial, e.counts.failed,
       duration_text(e.seconds), duration_text(e.cpu_seconds), e.file.string());
  for (std::size_t i = 0; i < std::min(kMostListed, e.incomplete.size()); ++i) {
    const SiteFinished& site = e.incomplete[i];
    line("  site {} {}: {}", site.vertex, words(site.status), site.reason);
  }
  if (e.incomplete.size() > kMostListed)
    line("  and {} more: see `palpate inspect`", e.incomplete.size() - kMostListed);
}

void TextSink::print(const MergeFinished& e) {
  line("merge: {} of {}, {} complete, {} stopped early, {} failed -> {}",
       count_text(e.sites, "site"), count_text(e.parts, "part"), e.counts.complete,
       e.counts.partial, e.counts.failed, e.file.string());
}

void TextSink::print(const FitFinished& e) {
  const auto errors = [](const FitErrors& of) {
    return fmt::format("{} median, {} worst (site {})", percent_text(of.median),
                       percent_text(of.worst), of.vertex);
  };
  if (e.fitted > 0) {
    line("  error of the fit over the largest force of a site: normal {}", errors(e.normal));
    line("    lateral {}; to any single path {}", errors(e.lateral), errors(e.spread));
  }
  if (e.mesh.vertex >= 0)
    line("  error of the mesh in the normal force, at most {}", errors(e.mesh));
  if (e.lateral_mesh.vertex >= 0) line("    in the lateral force {}", errors(e.lateral_mesh));
  if (!e.accuracy.empty()) line("  accuracy: {}", e.accuracy);
  line("fit: {} fitted, {} interpolated, {} -> {}", count_text(e.fitted, "response"),
       e.interpolated, count_text(e.holes, "hole"), e.file.string());
}

void TextSink::print(const Certified& e) {
  line("certify: {}", e.guarantee);
  for (const auto& [device, verdict] : e.devices) line("  {}: {}", device, verdict);
  if (e.devices.empty())
    line("  no rate is guaranteed on any device: the case names no profile in [certify] devices");
  line("  L_stick: {} at a fixed contact point, L_slip: {} while sliding, at mu = {}",
       bound_text(e.stick_bound), bound_text(e.slip_bound), e.friction);
  line("  smallest enforceable bound L_min: {}; the runtime enforces {}",
       bound_text(e.min_enforceable_bound), bound_text(e.enforced_bound));
  line("  limited by: {}", e.limited_by);
  line("certify: {}", e.file.string());
}

void TextSink::print(const StiffnessAtRate& e) {
  if (!std::isnan(e.certifiable_stiffness))
    result("  {} at {} Hz: certifiable stiffness {} (Mahvash & Hayward 2005, eq. 5: {})", e.device,
           e.rate, stiffness_text(e.certifiable_stiffness), stiffness_text(e.published_stiffness));
  if (!e.unknown.empty())
    return result("  {}: no guarantee: its {} {} unknown", e.device, list_in_words(e.unknown),
                  e.unknown.size() == 1 ? "is" : "are");
  const double bound = std::min(e.certifiable_stiffness, e.certifiable_by_friction);
  if (bound < e.certifiable_stiffness)
    result("    its dry friction certifies {} at its resolution", stiffness_text(bound));
  if (e.library_bound <= bound)
    return result("    the library, {}, is certified; {:.2f} times its forces would be, too",
                  bound_text(e.library_bound), bound / e.library_bound);
  result("    the library needs {}: {} of {} triangles exceed it, most of all triangle {}",
         bound_text(e.library_bound), e.triangles_over, e.triangles, e.worst_triangle);
  if (e.min_enforceable_bound <= bound)
    return result(
        "    slides can be rate-limited to {}: certified with that bound or a larger one up to the "
        "certifiable stiffness, which --soften writes into a library and `palpate run` chooses by "
        "itself",
        bound_text(e.min_enforceable_bound));
  if (std::isinf(e.min_enforceable_bound)) return result("    and no bound can be enforced");
  result(
      "    with rate-limited slides it needs {}: {:.2f} times its forces would be certified; "
      "--soften "
      "caps only the stiff slopes",
      bound_text(e.min_enforceable_bound), bound / e.min_enforceable_bound);
}

void TextSink::print(const Softened& e) {
  if (e.curves == 0) return line("certify: no response had to be softened -> {}", e.file.string());
  line("certify: slopes capped at {}, {} changed -> {}", stiffness_text(e.slope_cap),
       count_text(e.curves, "curve"), e.file.string());
  line(
      "  force lost at full deflection: median {:.1f} %, 95th percentile {:.1f} %, largest {:.1f} "
      "%",
      100 * e.median_loss, 100 * e.p95_loss, 100 * e.largest_loss);
  line("  to compare with direct solutions: palpate compare --fem CASE --out DIR --library {}",
       e.file.string());
}

void TextSink::print(const SteepestForce& e) {
  if (e.triangle < 0) return result("  {}: nothing to search", e.contact);
  const std::string ratio = std::isfinite(e.bound)
                                ? fmt::format("{:.2f} of the bound", e.slope / e.bound)
                                : "there is no bound";
  result(
      "  {}: {} in triangle {}, {}; largest ratio to the bound of its own triangle {:.4f} ({} "
      "tries)",
      e.contact, stiffness_text(e.slope), e.triangle, ratio, e.largest_ratio, e.tries);
}

void TextSink::print(const ConvergenceLevel& e) {
  line("convergence: elements of {}, {} unknowns, {} CPU time a site", length_text(e.element_size),
       e.unknowns, duration_text(e.cpu_seconds_per_site));
}

void TextSink::print(const ConvergenceOfForce& e) {
  const bool tiny = std::abs(e.limit) < 1e-3;
  const double scale = tiny ? 1e6 : 1e3;
  const char* unit = tiny ? "uN" : "mN";
  std::string forces;
  for (const double f : e.forces) forces += " " + number_text(scale * f, 4);
  const std::string limit =
      e.has_order
          ? fmt::format("-> {} {}, order {:.2f}", number_text(scale * e.limit, 4), unit, e.order)
          : fmt::format("{} follow no power of the element size", unit);
  line("  site {}, {}:{} {}; error of the case's mesh {:+.1f} %, at most {:.1f} %", e.vertex,
       e.quantity, forces, limit, 100 * e.error, 100 * e.bound);
}

void TextSink::print(const Estimate& e) {
  result(
      "estimate: {}{} on {} nodes ({} unknowns) {} {} on {}, {} of it before the "
      "first site",
      e.adaptive ? "at most " : "", count_text(e.sites, "site"), e.nodes, e.unknowns,
      e.sites == 1 ? "takes" : "take", duration_text(e.seconds), count_text(e.threads, "thread"),
      duration_text(e.set_up_seconds));
  result(
      "  memory {:.2g} GB, library.h5 {}", 1e-9 * e.memory_bytes,
      e.library_bytes > 0 ? fmt::format("{:.2g} MB", 1e-6 * e.library_bytes) : "of unknown size");
  result("  from {} in {}; nothing was written", count_text(e.trial_sites, "trial site"),
         duration_text(e.trial_seconds));
}

void TextSink::print(const FileWritten& e) {
  line("{}: {}", e.stage, e.file.string());
}

}  // namespace palpate::app
