// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <optional>

#include "app/case/names.hpp"
#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/export/csv.hpp"
#include "app/export/deck.hpp"
#include "app/export/mesh_file.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/settings.hpp"
#include "app/simulate/script.hpp"
#include "app/vtkhdf/grids.hpp"
#include "fem/campaign/bonded_patch.hpp"
#include "fem/relaxation/relaxing_press.hpp"
#include "fem/solid/pressure_smoothness.hpp"
#include "fitting/deformation/coarsen.hpp"
#include "format/body.hpp"
#include "format/crash_safe_file.hpp"
#include "format/deformation.hpp"
#include "format/error.hpp"
#include "format/flat_library.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

void write(const vtkhdf::Grid& grid, const std::filesystem::path& file) {
  vtkhdf::write_vtkhdf(file, grid);
  say("export: {} (open it in ParaView)", file.string());
}

int export_body(const Workspace& space) {
  const Body body = read_body(space.body());
  require_inside(body, "export body");
  write(vtkhdf::body_grid(body), space.out / "body.vtkhdf");
  return kExitDone;
}

/// The formats of `export mesh`: their name, their ending and their writer.
struct MeshFormat {
  const char* name;
  const char* ending;
  std::string (*write)(const Body&);
};
constexpr MeshFormat kMeshFormats[] = {{"gmsh", "msh", gmsh_mesh},
                                       {"vtu", "vtu", vtu_mesh},
                                       {"inp", "inp", abaqus_mesh},
                                       {"feb", "feb", febio_mesh}};

int export_mesh(const Workspace& space, const std::string& name) {
  const Body body = read_body(space.body());
  require_inside(body, "export mesh");
  for (const MeshFormat& format : kMeshFormats) {
    if (format.name != name) continue;
    const std::filesystem::path file = space.out / (std::string("body.") + format.ending);
    write_file_crash_safely(file, format.write(body));
    say("export: {}", file.string());
  }
  return kExitDone;
}

int export_surface(const Workspace& space) {
  const std::filesystem::path file = space.out / "surface.off";
  write_file_crash_safely(file, off_surface(read_body(space.body())));
  say("export: {}", file.string());
  return kExitDone;
}

int export_curves(const Workspace& space) {
  const std::filesystem::path file = space.out / "curves.csv";
  write_curves_csv(read_curves(space.curves()), file);
  say("export: {}", file.string());
  return kExitDone;
}

int export_library(const Workspace& space) {
  const Library library = read_library(space.library());
  // A measured case has no depth of its own.
  const double depth =
      is_measured(space) ? depth_of_responses(library) : space.c.campaign.indentation.depth;
  write(vtkhdf::library_grid(library, depth), space.out / "library.vtkhdf");
  return kExitDone;
}

int export_runtime(const Workspace& space) {
  const std::filesystem::path file = space.out / "library.plib";
  write_flat_library(file, read_library(space.library()));
  say("export: {}, {} kB", file.string(), (std::filesystem::file_size(file) + 999) / 1000);
  return kExitDone;
}

/// For pictures that draw the response surface, beside library.plib.
int export_skin(const Workspace& space, int modes) {
  if (!std::filesystem::exists(space.deformation()))
    refuse(space.deformation().string(), "does not exist",
           "set depths in [deformation] of the case and run `palpate build`");
  const Deformation fine = read_deformation(space.deformation());
  const Body body = read_body(space.body());
  if (fine.vertex_of.size() != body.response.node.size())
    refuse(space.deformation().string(), "is of another body than body.h5",
           "run `palpate build` again");
  const Deformation coarse =
      fitting::coarsened(fine, body.response.triangles, static_cast<std::size_t>(modes));
  const std::filesystem::path file = space.out / "skin.pdef";
  write_deformation(file, coarse);
  say("export: {}, {} vertices, {} modes that leave out {} (root mean square), {} kB",
      file.string(), coarse.positions.size(), coarse.mode_count(), length_text(coarse.rms_left_out),
      (std::filesystem::file_size(file) + 999) / 1000);
  return kExitDone;
}

struct SiteOptions {
  std::int32_t vertex = -1;
  bool calculix = false, febio = false;
  bool lateral = false;                 ///< moves the tool sideways after the press
  bool patch = false;                   ///< displaces a bonded patch instead of the tool
  double patch_radius = 0;              ///< mm; 0: that of the tool
  std::optional<double> press_seconds;  ///< into tissue that relaxes
  double hold_seconds = 0;
};

/// The solution of palpate for a deck.
struct OwnSolution {
  std::string csv, lateral_csv;
  std::string what;
  double depth = 0, force = 0;  ///< at the end
  std::string reason;           ///< why the curve ends early
};

OwnSolution press_patch(const Body& body, const fem::CampaignSettings& settings,
                        std::int32_t vertex, double radius, std::size_t nodes) {
  const fem::PatchCurve curve = fem::press_patch(body, settings, vertex, radius);
  OwnSolution own{"depth_m,force_x_N,force_y_N,force_z_N,strain_energy_J\n",
                  "",
                  fmt::format("bonded patch of {} nodes displaced", nodes),
                  0,
                  0,
                  curve.reason};
  for (const fem::PatchForce& s : curve.samples) {
    own.csv += fmt::format("{},{},{},{},{}\n", s.depth, s.force[0], s.force[1], s.force[2],
                           s.strain_energy);
    own.depth = s.depth;
    own.force = norm(s.force);
  }
  return own;
}

/// The samples of a path of the tool, `travel` being the name of their displacement.
std::string csv_of(const CurvePath& path, const char* travel) {
  std::string csv =
      fmt::format("{},force_x_N,force_y_N,force_z_N,strain_energy_J,penetration_m\n", travel);
  for (const CurveSample& s : path.samples) {
    csv += fmt::format("{},{},{},{},{},{}\n", s.displacement, s.force[0], s.force[1], s.force[2],
                       s.strain_energy, s.penetration);
  }
  return csv;
}

OwnSolution press_tool(const Body& body, fem::CampaignSettings settings, std::int32_t vertex,
                       bool lateral) {
  settings.sites = {vertex};
  settings.indentation.lateral_depths.clear();
  if (lateral) {
    settings.indentation.lateral_depths = {settings.indentation.depth};
    settings.indentation.azimuths.resize(1);
    settings.indentation.drag_across = false;
  }
  fem::CampaignReport report;
  const Curves curves = fem::run_campaign(body, settings, report);
  const SiteCurves& site = curves.sites.front();
  const CurvePath& press = site.paths.front();
  OwnSolution own{csv_of(press, "depth_m"),
                  "",
                  name_of(settings.indentation.tool.shape) + " pressed",
                  press.samples.back().displacement,
                  norm(press.samples.back().force),
                  site.reason};
  if (site.paths.size() > 1) own.lateral_csv = csv_of(site.paths.back(), "travel_m");
  return own;
}

/// The same press at its speed, and the hold.
OwnSolution press_and_hold(const Body& body, const fem::CampaignSettings& settings,
                           std::int32_t vertex, const PressAndHold& pace) {
  const double depth = settings.indentation.depth;
  std::vector<fem::ToolMotion> motion{{0, 0}, {pace.press, depth}};
  if (pace.hold > 0) motion.push_back({pace.press + pace.hold, depth});
  const fem::RelaxingPress press = fem::press_relaxing(body, settings, vertex, motion);
  OwnSolution own{"time_s,depth_m,force_x_N,force_y_N,force_z_N,penetration_m\n",
                  "",
                  fmt::format("{} pressed in {:.3g} s and held for {:.3g} s",
                              name_of(settings.indentation.tool.shape), pace.press, pace.hold),
                  press.samples.back().travel,
                  norm(press.samples.back().force),
                  press.reason};
  for (const fem::RelaxingSample& s : press.samples)
    own.csv += fmt::format("{},{},{},{},{},{}\n", s.time_s, s.travel, s.force[0], s.force[1],
                           s.force[2], s.penetration);
  return own;
}

/// The body of the case: a site solved on the mesh of another one has forces of neither.
Body body_of_case(const Workspace& space) {
  Body body = read_body(space.body());
  const std::string stale = stale_reason(space, Stage::Mesh, body.provenance);
  if (!stale.empty())
    throw Error(ErrorKind::Configuration, space.body().string(), "it is out of date: " + stale,
                "run `palpate mesh` with this case and folder, or export with the case that the "
                "body was meshed for");
  return body;
}

/// The ranges of CLI11 let "nan" through.
void require_time(const char* option, double seconds, double least) {
  constexpr double kMost = 1e6;
  if (!(seconds >= least && seconds <= kMost))
    refuse(option, fmt::format("{:g} is out of range", seconds),
           fmt::format("give {:g} to {:g} s", least, kMost));
}

/// Input files of the site for other programs, and the solution of palpate for comparison.
int export_decks(const Workspace& space, const SiteOptions& options) {
  if (options.press_seconds) require_time("--press-seconds", *options.press_seconds, 1e-6);
  require_time("--hold-seconds", options.hold_seconds, 0);
  const Body body = body_of_case(space);
  const fem::CampaignSettings settings = campaign_settings(space);
  const bool patch = options.patch || options.patch_radius > 0;
  const double radius =
      options.patch_radius > 0 ? 1e-3 * options.patch_radius : settings.indentation.tool.radius;
  Deck deck = patch ? make_patch_deck(body, settings, options.vertex, radius)
                    : make_tool_deck(body, settings, options.vertex, options.lateral);
  if (options.press_seconds) {
    if (!deck.relaxes())
      refuse("--press-seconds", "no tissue of the case relaxes: its forces do not depend on time",
             "leave it out");
    deck.pace = PressAndHold{*options.press_seconds, options.hold_seconds};
  }
  const std::string stem = fmt::format("site-{}", options.vertex);
  const auto save = [&](const std::string& text, const std::string& name) {
    write_file_crash_safely(space.out / name, text);
    say("export: {}", (space.out / name).string());
  };
  // Both decks are made before either is written, so that an unsupported law leaves no file.
  const std::string calculix = options.calculix ? calculix_deck(deck) : std::string();
  const std::string febio = options.febio ? febio_deck(deck) : std::string();
  const OwnSolution own =
      patch       ? press_patch(body, settings, options.vertex, radius, deck.patch.size())
      : deck.pace ? press_and_hold(body, settings, options.vertex, *deck.pace)
                  : press_tool(body, settings, options.vertex, options.lateral);
  if (!calculix.empty()) save(calculix, stem + ".inp");
  if (!febio.empty()) save(febio, stem + ".feb");
  save(own.csv, stem + (patch ? "-patch.csv" : "-tool.csv"));
  if (!own.lateral_csv.empty()) save(own.lateral_csv, stem + "-lateral.csv");
  say("site {}: {} by {}, force {} by {}", options.vertex, own.what, length_text(own.depth),
      force_text(own.force), name_in(kElements, settings.dilatation));
  if (!own.reason.empty()) say("the curve ends early: {}", own.reason);
  return kExitDone;
}

/// Solves the site again, because the campaign does not store the displacement field.
int export_site(const Workspace& space, std::int32_t vertex) {
  const Body body = body_of_case(space);
  const fem::DeformedState state = fem::deformed_state(body, campaign_settings(space), vertex);
  const vtkhdf::DeformedFields fields{state.displacement, state.strain_energy_density,
                                      state.pressure, state.smooth_pressure};
  vtkhdf::Grid grid = vtkhdf::deformed_grid(body, fields);
  grid.provenance.steps.push_back(make_provenance_step(
      "export", resolved_toml(space.c), {space.body()}, {{"vertex", std::to_string(vertex)}}));
  say("site {}: depth {}, force {}", vertex, length_text(state.sample.displacement),
      force_text(norm(state.sample.force)));
  say("pressures alternate between elements: {:.1f} (about 1.6 when they do not){}",
      state.pressure_alternation,
      state.pressure_alternation > fem::kAlternating
          ? "; read smooth_pressure, or set [solver] element = \"tet10-nodal-pressure\""
          : "");
  write(grid, space.out / fmt::format("site-{}.vtkhdf", vertex));
  return kExitDone;
}

int export_recording(const std::filesystem::path& recording) {
  const std::filesystem::path file = std::filesystem::path(recording).replace_extension(".csv");
  RecordingReader reader(recording);
  write_recording_csv(reader, file);
  say("export: {}", file.string());
  return kExitDone;
}

/// Sessions on a device have no case.
void add_recording_part(CLI::App& parent, Action& action) {
  CLI::App* part = parent.add_subcommand("recording", "recording.h5 -> recording.csv beside it");
  part->footer("Example: palpate export recording out/cylinder/recording.h5");
  const auto file = std::make_shared<std::string>();
  part->add_option("RECORDING", *file, "Recording of a session (recording.h5)")->required();
  part->callback([file, &action] { action = [file] { return export_recording(*file); }; });
}

template <class Run>
CLI::App* add_part(CLI::App& parent, Action& action, const char* name, const char* about, Run run) {
  CLI::App* part = parent.add_subcommand(name, about);
  part->footer(fmt::format("Example: palpate export {} data/cases/cylinder.toml", name));
  const auto options = add_case_options(*part);
  part->callback([options, run, &action] {
    action = [options, run] {
      const Workspace space = open_workspace(*options);
      prepare_output(space.out);
      return run(space);
    };
  });
  return part;
}

void add_site_part(CLI::App& parent, Action& action) {
  const auto options = std::make_shared<SiteOptions>();
  CLI::App* site =
      add_part(parent, action, "site",
               "Deformed body at one site -> site-N.vtkhdf, or an input file of another solver",
               [options](const Workspace& space) {
                 const bool decks = options->calculix || options->febio;
                 return decks ? export_decks(space, *options) : export_site(space, options->vertex);
               });
  site->footer("Example: palpate export site data/cases/cylinder.toml --vertex 160");
  site->add_option("--vertex", options->vertex, "Response vertex, as in curves.csv")->required();
  CLI::Option* calculix =
      site->add_flag("--calculix", options->calculix, "Write site-N.inp for CalculiX");
  CLI::Option* febio = site->add_flag("--febio", options->febio, "Write site-N.feb for FEBio 4");
  CLI::Option* patch = site->add_flag(
      "--patch", options->patch,
      "Displace a bonded patch of surface nodes instead of the tool, without contact");
  CLI::Option* radius = site->add_option("--patch-radius-mm", options->patch_radius,
                                         "Radius of the patch, mm (default: that of the tool)")
                            ->check(CLI::PositiveNumber);
  site->add_flag("--lateral", options->lateral,
                 "After the press move the tool along the first lateral path, without slip")
      ->needs(calculix)
      ->excludes(patch)
      ->excludes(radius);
  CLI::Option* press =
      site->add_option("--press-seconds", options->press_seconds,
                       "Time of the press, s, for tissue that relaxes: FEBio alone has it")
          ->needs(febio);
  site->add_option("--hold-seconds", options->hold_seconds, "Time of the hold after it, s")
      ->needs(press);
}

}  // namespace

void add_export_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand("export",
                                          "Exports artifacts to ParaView (VTKHDF), CSV, CalculiX "
                                          "and FEBio, and libraries for the runtime");
  command->footer("Example: palpate export site data/cases/cylinder.toml --vertex 160");
  command->require_subcommand(1);
  add_part(*command, action, "body", "body.h5 -> body.vtkhdf", export_body);
  const auto format = std::make_shared<std::string>("gmsh");
  add_part(*command, action, "mesh",
           "body.h5 -> body.msh, .vtu, .inp or .feb with its regions and supports as sets",
           [format](const Workspace& space) { return export_mesh(space, *format); })
      ->add_option("--format", *format, "gmsh, vtu, inp or feb")
      ->check(CLI::IsMember({"gmsh", "vtu", "inp", "feb"}))
      ->capture_default_str();
  add_part(*command, action, "surface",
           "body.h5 -> surface.off, the response surface with the vertices of the library",
           export_surface);
  add_part(*command, action, "curves", "curves.h5 -> curves.csv", export_curves);
  add_part(*command, action, "library",
           "library.h5 -> library.vtkhdf, with the forces at the depth of the case",
           export_library);
  add_part(*command, action, "runtime",
           "library.h5 -> library.plib, which the runtime loads without HDF5", export_runtime);
  const auto modes = std::make_shared<int>(24);
  add_part(*command, action, "skin",
           "deformation.pdef -> skin.pdef, the same on the vertices of the response surface alone",
           [modes](const Workspace& space) { return export_skin(space, *modes); })
      ->footer("Example: palpate export skin data/cases/liver.toml")
      ->add_option("--modes", *modes, "Largest number of shapes that the skin is blended from")
      ->check(CLI::Range(1, 512))
      ->capture_default_str();
  add_recording_part(*command, action);
  add_site_part(*command, action);
}

}  // namespace palpate::app
