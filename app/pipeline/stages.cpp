// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "app/pipeline/device_profile.hpp"
#include "app/pipeline/fields.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/measured_stages.hpp"
#include "app/pipeline/mesh_surface.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/soften.hpp"
#include "fitting/response/accuracy.hpp"
#include "fitting/response/fit.hpp"
#include "fitting/response/fit_errors.hpp"
#include "fitting/response/relaxation_fraction.hpp"
#include "fitting/response/site_samples.hpp"
#include "format/body.hpp"
#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "format/library.hpp"
#include "format/number_text.hpp"
#include "format/passivity.hpp"
#include "format/position_text.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::app {
namespace {

Certified certified(const Certificate& certificate, const std::filesystem::path& file) {
  Certified event{guarantee_text(certificate),
                  certificate.friction,
                  certificate.stick,
                  certificate.slip,
                  certificate.min_lipschitz_bound,
                  certificate.lipschitz_bound,
                  certificate.limited_by,
                  {},
                  file};
  for (const DeviceCertificate& device : certificate.devices)
    event.devices.emplace_back(device.device, verdict(certificate, device));
  return event;
}

/// Why the artifact must be made; empty when it is up to date.
template <class Read>
std::string reason_to_make(const Workspace& space, Stage stage, const std::filesystem::path& path,
                           Read read) {
  if (!std::filesystem::exists(path)) return "missing";
  try {
    return stale_reason(space, stage, read(path).provenance);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Configuration) throw;
    return "the existing file cannot be used (" + error.problem() + ")";
  }
}

/// Runs the stage if its artifact is out of date.
template <class Read, class Run>
void refresh(const Workspace& space, Stage stage, const std::filesystem::path& path, Read read,
             Run run, const EventSink& emit) {
  const std::string reason = reason_to_make(space, stage, path, read);
  if (reason.empty()) return emit(StageUpToDate{stage_name(stage), path});
  emit(StageStarted{stage_name(stage), path, reason});
  run(space, emit);
}

/// The step of a new certificate replaces that of the old one.
void replace_certify_step(Library& library, ProvenanceStep step) {
  std::erase_if(library.provenance.steps,
                [](const ProvenanceStep& old) { return old.stage == stage_name(Stage::Certify); });
  library.provenance.steps.push_back(std::move(step));
}

/// The regions of a volume mesh are known only now.
void check_regions(const Workspace& space, const Body& body) {
  const auto& materials = space.c.materials;
  for (const std::string& region : body.region_names) {
    const bool is_described = std::any_of(materials.begin(), materials.end(),
                                          [&](const auto& m) { return m.region == region; });
    if (is_described) continue;
    refuse("case " + space.c.name,
           "region '" + region + "' of " + space.c.mesh.source().string() + " has no material",
           "add [[material]] with region = \"" + region +
               "\", or give it another region by "
               "[[mesh_region]]");
  }
}

/// A line of the mesher's log as an event.
void emit_log(const std::string& stage, std::string_view text, const EventSink& emit) {
  if (!text.starts_with(mesher::kWarningMark)) return emit(LogLine{stage, std::string(text)});
  text.remove_prefix(mesher::kWarningMark.size());
  emit(Warning{stage, std::string(text)});
}

/// What an import left out, as its step of the provenance states.
std::size_t refused_records(const Provenance& provenance) {
  std::size_t refused = 0;
  for (const ProvenanceStep& step : provenance.steps)
    for (const auto& [key, value] : step.facts)
      if (step.stage == "import" && key == "refused")
        std::from_chars(value.data(), value.data() + value.size(), refused);
  return refused;
}

}  // namespace

void refuse_body_of_another_case(const Workspace& space) {
  if (!std::filesystem::exists(space.body())) return;
  std::string other;
  try {
    other = case_name(read_body(space.body()).provenance);
  } catch (const std::exception&) {
    return;  // damaged, or of another version: to be replaced
  }
  if (other.empty() || other == space.c.name) return;
  refuse(space.out.string(),
         "holds the artifacts of case '" + other + "', not of '" + space.c.name + "'",
         "choose another folder with --out, or remove this one");
}

SiteCounts count_sites(const Curves& curves) {
  SiteCounts counts;
  for (const SiteCurves& site : curves.sites) {
    if (!fitting::usable(site, curves.depth)) ++counts.without_response;
    switch (site.status) {
      case SiteStatus::Complete:
        ++counts.complete;
        break;
      case SiteStatus::Partial:
        ++counts.partial;
        break;
      case SiteStatus::Failed:
        ++counts.failed;
        break;
    }
  }
  counts.refused = refused_records(curves.provenance);
  return counts;
}

void run_mesh(const Workspace& space, const EventSink& emit) {
  prepare_output(space.out);
  refuse_body_of_another_case(space);
  if (is_measured(space)) return run_measured_surface(space, emit);
  if (!space.c.derived.empty())
    emit(LogLine{"mesh", "lengths that the case leaves out: " + space.c.derived});
  mesher::Settings settings = mesh_settings(space);
  settings.log = [&](std::string_view text) { emit_log("mesh", text, emit); };
  Body body = mesh_surface(settings, space.out);
  check_regions(space, body);
  body.provenance = {};
  body.provenance.steps.push_back(make_stage_step(space, Stage::Mesh, {}));
  write_body(space.body(), body);
  const auto sites = std::count(body.response.is_site.begin(), body.response.is_site.end(), 1);
  emit(MeshFinished{body.nodes.size(), body.tetrahedra.size(), body.response.triangles.size(),
                    sites, space.body()});
}

namespace {

FitErrors errors_of(const std::vector<fitting::SiteFitError>& errors,
                    double fitting::SiteFitError::*which) {
  const fitting::FitErrorSummary summary = fitting::summary_of(errors, which);
  return {summary.median, summary.worst, summary.vertex};
}

/// Warns where responses visibly miss the curves that they were fitted to.
void warn_of_misfit(const char* kind, const Library& library,
                    const std::vector<fitting::SiteFitError>& errors,
                    double fitting::SiteFitError::*which, const EventSink& emit) {
  const FitErrors worst = errors_of(errors, which);
  if (!(worst.worst > fitting::kVisibleFitError)) return;
  const auto count = std::count_if(
      errors.begin(), errors.end(),
      [&](const fitting::SiteFitError& error) { return error.*which > fitting::kVisibleFitError; });
  const Vec3& at = library.positions[to_index(worst.vertex)];
  emit(Warning{
      "fit",
      fmt::format(
          "{} of {} {} responses miss their curves by more than {}, most of all that of site {} at "
          "{}, by {} of its largest force; give a smaller [fit] "
          "absolute_tolerance or more max_knots, and look at the curves of the site in the report",
          count, errors.size(), kind, percent_text(fitting::kVisibleFitError), worst.vertex,
          position_text(at), percent_text(worst.worst))});
}

/// Warns where one fraction for a node misses that tissue in layers relaxes otherwise when shallow.
void warn_of_shares(const Curves& curves, const Library& library, const EventSink& emit) {
  double largest = 0;
  std::int32_t vertex = -1;
  for (const SiteCurves& site : curves.sites) {
    if (library.responses[to_index(site.vertex)].status != ResponseStatus::Fitted) continue;
    const double error = fitting::largest_fraction_error(site, curves.relaxation);
    if (error > largest) vertex = site.vertex;
    largest = std::max(largest, error);
  }
  if (!(largest > fitting::kVisibleFitError)) return;
  emit(Warning{
      "fit",
      fmt::format("the fraction of the force that relaxes varies with depth, most at site {} at "
                  "{}: by {}, weighted by the stored energy; the library has that of the "
                  "deepest sample",
                  vertex, position_text(library.positions[to_index(vertex)]),
                  percent_text(largest))});
}

}  // namespace

void run_fit(const Workspace& space, const EventSink& emit) {
  const Body body = read_input(space.body(), "mesh", read_body);
  const Curves curves = read_input(space.curves(), "precompute", read_curves);
  prepare_output(space.out);
  Library library = fitting::fit(body, curves, fit_settings(space));
  append(library.provenance, curves.provenance, make_stage_step(space, Stage::Fit, {}));
  write_library(space.library(), library);
  fit_deformation(space, body, curves, library, emit);
  // The coupling of such sites follows from the shape of the tool, not from their curves.
  const auto single = std::count_if(
      curves.sites.begin(), curves.sites.end(),
      [](const SiteCurves& site) { return fitting::lateral_depths(site).size() == 1; });
  if (library.kind == ResponseKind::Coupled && single > 0)
    emit(LogLine{"fit",
                 fmt::format("{} one lateral depth: {} coupling grows with "
                             "the square root of depth",
                             count_text(static_cast<std::size_t>(single), "site has", "sites have"),
                             single == 1 ? "its" : "their")});
  if (space.c.fit.between_nodes)
    emit(LogLine{
        "fit", "responses are scaled for interpolation; their stated errors include the scaling"});
  const auto with_status = [&](ResponseStatus status) {
    return static_cast<std::size_t>(
        std::count_if(library.responses.begin(), library.responses.end(),
                      [=](const NodeResponse& r) { return r.status == status; }));
  };
  using fitting::SiteFitError;
  const std::vector<SiteFitError> errors = fitting::fit_errors(library, curves);
  warn_of_misfit("normal", library, errors, &SiteFitError::normal, emit);
  warn_of_misfit("lateral", library, errors, &SiteFitError::lateral, emit);
  if (library.relaxes()) warn_of_shares(curves, library, emit);
  emit(FitFinished{
      with_status(ResponseStatus::Fitted), with_status(ResponseStatus::Interpolated),
      with_status(ResponseStatus::Hole), errors_of(errors, &SiteFitError::normal),
      errors_of(errors, &SiteFitError::lateral), errors_of(errors, &SiteFitError::spread),
      space.library(), errors_of(errors, &SiteFitError::mesh),
      errors_of(errors, &SiteFitError::lateral_mesh), fitting::accuracy_text(library)});
}

void run_certify(const Workspace& space, const EventSink& emit) {
  Library library = read_input(space.library(), "fit", read_library);
  fitting::certify(library, certify_settings(space));
  replace_certify_step(library, make_stage_step(space, Stage::Certify, {}));
  write_library(space.library(), library);
  emit(certified(library.certificate, space.library()));
}

namespace {

StiffnessAtRate stiffness_at_rate(const Certificate& certificate,
                                  const fitting::DeviceProfile& device, double rate) {
  StiffnessAtRate event;
  event.device = device.name;
  event.rate = rate;
  event.library_bound = std::max(certificate.stick, certificate.slip);
  event.min_enforceable_bound = certificate.min_lipschitz_bound;
  event.triangles = certificate.triangles.size();
  event.worst_triangle = certificate.worst_triangle;
  const DeviceConstants constants = device.constants();
  event.unknown = unknown_constants(constants);
  const double bound = certifiable_stiffness(constants, rate, certificate.relaxation_rate);
  event.published_stiffness = 0.5 * device.damping * rate;
  event.certifiable_stiffness = bound;
  event.certifiable_by_friction = certifiable_stiffness_by_friction(constants);
  if (std::isnan(bound)) return event;
  event.triangles_over = static_cast<std::size_t>(
      std::count_if(certificate.triangles.begin(), certificate.triangles.end(),
                    [&](const auto& t) { return std::max(t.stick, t.slip) > bound; }));
  return event;
}

/// Largest Lipschitz bound for which both conditions hold, N/m; NaN: a constant is unknown.
double certifiable_by_both(const DeviceConstants& device, double rate, double relaxation_rate) {
  const double by_friction = certifiable_stiffness_by_friction(device);
  if (std::isnan(by_friction)) return kUnknown;
  return std::min(certifiable_stiffness(device, rate, relaxation_rate), by_friction);
}

void write_softened(const Workspace& space, const RateOptions& options, Library library,
                    const fitting::CertifySettings& settings, const EventSink& emit) {
  const double bound = settings.devices.size() == 1
                           ? certifiable_by_both(settings.devices[0].constants(), options.rate,
                                                 library.certificate.relaxation_rate)
                           : kUnknown;
  if (!(bound > 0)) {
    throw Error(ErrorKind::Configuration, "--soften",
                "needs exactly one device of which all constants are known and certify something",
                "name its profile with --device");
  }
  const fitting::Softening soft = fitting::soften(library, settings, bound);
  ProvenanceStep step = make_stage_step(space, Stage::Certify, {});
  step.facts.emplace_back("softened_for_hz", fmt::format("{}", options.rate));
  if (soft.curves > 0)
    step.facts.emplace_back("softened_max_slope", fmt::format("{}", soft.max_slope));
  step.facts.emplace_back("enforced_lipschitz_bound",
                          fmt::format("{}", library.certificate.lipschitz_bound));
  replace_certify_step(library, std::move(step));
  write_library(options.softened, library);
  emit(Softened{soft.curves, soft.max_slope, soft.median, soft.p95, soft.worst, options.softened});
  emit(certified(library.certificate, options.softened));
}

}  // namespace

void run_certify_at_rate(const Workspace& space, const RateOptions& options,
                         const EventSink& emit) {
  const Library library = read_input(space.library(), "fit", read_library);
  fitting::CertifySettings settings = certify_settings(space);
  if (!options.device.empty()) settings.devices = {read_device_profile(options.device)};
  if (settings.devices.empty()) {
    throw Error(ErrorKind::Configuration, "--rate",
                "the certifiable stiffness depends on the constants of a device, and there is none",
                "name its profile with --device, or in certify.devices of the case");
  }
  Library with_certificate = library;
  fitting::certify(with_certificate, settings);
  for (const fitting::DeviceProfile& device : settings.devices)
    emit(stiffness_at_rate(with_certificate.certificate, device, options.rate));
  if (!options.softened.empty()) write_softened(space, options, library, settings, emit);
}

SiteCounts run_build(const Workspace& space, Stage last, const EventSink& emit) {
  check_inputs(space, last);
  prepare_output(space.out);
  refresh(space, Stage::Mesh, space.body(), read_body, run_mesh, emit);
  if (last == Stage::Mesh) return {};
  refresh(space, Stage::Precompute, space.curves(), read_curves, run_precompute, emit);
  if (last >= Stage::Fit) refresh(space, Stage::Fit, space.library(), read_library, run_fit, emit);
  if (last >= Stage::Certify)
    refresh(space, Stage::Certify, space.library(), read_library, run_certify, emit);
  return count_sites(read_curves(space.curves()));
}

}  // namespace palpate::app
