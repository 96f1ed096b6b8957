// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/stages.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "app/console.hpp"
#include "app/pipeline/device_profile.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/soften.hpp"
#include "fitting/response/couple.hpp"
#include "fitting/response/fit.hpp"
#include "format/body.hpp"
#include "format/error.hpp"
#include "format/library.hpp"

namespace palpate::app {
namespace {

std::string bound_text(double value, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.1f} {}", value, unit) : "not certified: no bound";
}

void tell_certificate(const Certificate& certificate) {
  say("  L_stick: {}, L_slip: {} at mu = {}", bound_text(certificate.stick, "N/m"),
      bound_text(certificate.slip, "N/m"), certificate.friction);
  say("  L_min: {}; the runtime holds the force to {}",
      std::isfinite(certificate.min_lipschitz_bound)
          ? lipschitz_bound_text(certificate.min_lipschitz_bound)
          : "not certified: no bound",
      bound_text(certificate.lipschitz_bound, "N/m"));
  say("  limited by: {}", certificate.limited_by);
  for (const DeviceCertificate& device : certificate.devices) {
    say("  {}: {}", device.device, verdict(certificate, device));
  }
}

/// Why the artifact must be made (again); empty when it need not.
template <class Read>
std::string reason_to_make(const Workspace& space, Stage stage, const std::filesystem::path& path,
                           Read read) {
  if (!std::filesystem::exists(path)) return "it does not exist";
  try {
    return stale_reason(space, stage, read(path).provenance);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Configuration) throw;
    return "the present one cannot be used (" + error.problem() + ")";
  }
}

/// Run the stage if needed; true when it ran.
template <class Read, class Run>
bool refresh(const Workspace& space, Stage stage, const std::filesystem::path& path, Read read,
             Run run) {
  const std::string reason = reason_to_make(space, stage, path, read);
  if (reason.empty()) {
    say("{}: {} is up to date", stage_name(stage), path.string());
    return false;
  }
  say("{}: making {}, {}", stage_name(stage), path.string(), reason);
  run(space);
  return true;
}

}  // namespace

SiteCounts count_sites(const Curves& curves) {
  SiteCounts counts;
  for (const SiteCurves& site : curves.sites) {
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
  return counts;
}

void run_mesh(const Workspace& space) {
  prepare_output(space.out);
  mesher::Settings settings = mesh_settings(space);
  settings.log = [](std::string_view line) { say("  {}", line); };
  Body body = mesher::mesh(settings);
  body.provenance = {};
  body.provenance.steps.push_back(make_stage_step(space, Stage::Mesh, {}));
  write_body(space.body(), body);
  const auto sites = std::count(body.response.is_site.begin(), body.response.is_site.end(), 1);
  say("mesh: {} nodes, {} tetrahedra, {} response triangles, {} sites -> {}", body.nodes.size(),
      body.tetrahedra.size(), body.response.triangles.size(), sites, space.body().string());
}

namespace {

/// Where the depths of the lateral paths do not say how the response grows, the tool's shape does.
void tell_single_depths(const Curves& curves) {
  const auto single = std::count_if(
      curves.sites.begin(), curves.sites.end(),
      [](const SiteCurves& site) { return fitting::lateral_depths(site).size() == 1; });
  if (single > 0)
    say("fit: {} sites have lateral paths at one depth: coupled like the square root of depth",
        single);
}

}  // namespace

void run_fit(const Workspace& space) {
  const Body body = read_input(space.body(), "mesh", read_body);
  const Curves curves = read_input(space.curves(), "precompute", read_curves);
  prepare_output(space.out);
  Library library = fitting::fit(body, curves, fit_settings(space));
  append(library.provenance, curves.provenance, make_stage_step(space, Stage::Fit, {}));
  write_library(space.library(), library);
  if (library.kind == ResponseKind::Coupled) tell_single_depths(curves);
  if (space.c.fit.between_nodes)
    say("fit: scaled to be right in the mean between the nodes; at the nodes the stated errors "
        "count that");
  const auto with_status = [&](ResponseStatus status) {
    return std::count_if(library.responses.begin(), library.responses.end(),
                         [=](const NodeResponse& r) { return r.status == status; });
  };
  say("fit: {} responses fitted, {} interpolated, {} holes -> {}",
      with_status(ResponseStatus::Fitted), with_status(ResponseStatus::Interpolated),
      with_status(ResponseStatus::Hole), space.library().string());
}

void run_certify(const Workspace& space) {
  Library library = read_input(space.library(), "fit", read_library);
  const fitting::CertifySettings settings = certify_settings(space);
  fitting::certify(library, settings);
  // A new certificate replaces the old one, so does its step.
  std::erase_if(library.provenance.steps, [](const ProvenanceStep& step) {
    return step.stage == stage_name(Stage::Certify);
  });
  library.provenance.steps.push_back(make_stage_step(space, Stage::Certify, {}));
  write_library(space.library(), library);
  tell_certificate(library.certificate);
  say("certify: {}", space.library().string());
}

namespace {

void tell_keep(const Library& library, const fitting::DeviceProfile& device, double rate) {
  if (std::isnan(device.damping))
    return say("  {}: damping unknown: nothing is certified for this device", device.name);
  const Certificate& c = library.certificate;
  const double bound = fitting::certifiable_stiffness(device.damping, rate);
  const double steepest = std::max(c.stick, c.slip);
  const auto over = std::count_if(c.triangles.begin(), c.triangles.end(),
                                  [&](const auto& t) { return std::max(t.stick, t.slip) > bound; });
  say("  {} at {} Hz: certified up to {:.1f} N/m", device.name, rate, bound);
  if (steepest <= bound)
    return say("    the library, {:.1f} N/m, is certified with room for {:.2f} times its forces",
               steepest, bound / steepest);
  say("    slides of the library need {}: {} of {} triangles are over, the worst is triangle {}",
      bound_text(steepest, "N/m"), over, c.triangles.size(), c.worst_triangle);
  if (c.min_lipschitz_bound <= bound)
    return say(
        "    slides can be held back to {}: certified with a lipschitz_bound of {:.1f} N/m, "
        "which --soften writes as the limit of a library and `palpate run` takes by itself",
        lipschitz_bound_text(c.min_lipschitz_bound), std::floor(10 * bound) / 10);
  if (std::isinf(c.min_lipschitz_bound)) return say("    and cannot be held back to any limit");
  say("    held back they need {:.1f} N/m: {:.2f} times its forces would be certified; "
      "--soften caps the stiff slopes alone",
      c.min_lipschitz_bound, bound / c.min_lipschitz_bound);
}

void write_softened(const Workspace& space, const KeepOptions& options, Library library,
                    const fitting::CertifySettings& settings) {
  const bool one = settings.devices.size() == 1 && !std::isnan(settings.devices[0].damping);
  if (!one) {
    throw Error(ErrorKind::Configuration, "--soften", "it takes one device of known damping",
                "name its profile with --device");
  }
  const double bound = fitting::certifiable_stiffness(settings.devices[0].damping, options.rate);
  const fitting::Softening soft = fitting::soften(library, settings, bound);
  std::erase_if(library.provenance.steps, [](const ProvenanceStep& step) {
    return step.stage == stage_name(Stage::Certify);
  });
  ProvenanceStep step = make_stage_step(space, Stage::Certify, {});
  step.facts.emplace_back("softened_for_hz", fmt::format("{}", options.rate));
  if (soft.curves > 0)
    step.facts.emplace_back("softened_max_slope", fmt::format("{}", soft.max_slope));
  step.facts.emplace_back("enforced_lipschitz_bound",
                          fmt::format("{}", library.certificate.lipschitz_bound));
  library.provenance.steps.push_back(step);
  write_library(options.softened, library);
  if (soft.curves == 0) {
    say("certify: no response had to be softened -> {}", options.softened.string());
    tell_certificate(library.certificate);
    return;
  }
  say("certify: slopes limited to {:.1f} N/m, {} curves changed -> {}", soft.max_slope, soft.curves,
      options.softened.string());
  say("  force lost at full deflection: median {:.1f} %, 95 % of the curves {:.1f} %, worst {:.1f} "
      "%",
      100 * soft.median, 100 * soft.p95, 100 * soft.worst);
  say("  against direct solutions: palpate compare --fem CASE --out DIR --library {}",
      options.softened.string());
  tell_certificate(library.certificate);
}

}  // namespace

void run_keep(const Workspace& space, const KeepOptions& options) {
  const Library library = read_input(space.library(), "fit", read_library);
  fitting::CertifySettings settings = certify_settings(space);
  if (!options.device.empty()) settings.devices = {read_device_profile(options.device)};
  if (settings.devices.empty()) {
    throw Error(ErrorKind::Configuration, "--rate",
                "what may be kept depends on the damping of a device, and none is given",
                "name its profile with --device, or in certify.devices of the case");
  }
  Library certified = library;
  fitting::certify(certified, settings);
  say("certify: what may be kept at {} Hz, mu = {}", options.rate, settings.friction);
  for (const fitting::DeviceProfile& device : settings.devices)
    tell_keep(certified, device, options.rate);
  if (!options.softened.empty()) write_softened(space, options, library, settings);
}

SiteCounts run_build(const Workspace& space, Stage last) {
  prepare_output(space.out);
  refresh(space, Stage::Mesh, space.body(), read_body, run_mesh);
  if (last == Stage::Mesh) return {};
  refresh(space, Stage::Precompute, space.curves(), read_curves,
          [](const Workspace& w) { run_precompute(w); });
  if (last >= Stage::Fit) refresh(space, Stage::Fit, space.library(), read_library, run_fit);
  if (last >= Stage::Certify)
    refresh(space, Stage::Certify, space.library(), read_library, run_certify);
  return count_sites(read_curves(space.curves()));
}

}  // namespace palpate::app
