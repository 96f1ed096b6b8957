// SPDX-License-Identifier: AGPL-3.0-or-later
// The case file: everything the pipeline is told about one body. Reference: docs/cases.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::app {

struct SurfaceSection {
  std::string file;  ///< as written: relative to the folder of the case file
  std::string unit;  ///< symbol of the length unit of the file
  std::string region = "matrix";
  bool operator==(const SurfaceSection&) const = default;
};

struct InclusionSection {
  std::string file;
  std::string unit;
  std::string region;
  bool operator==(const InclusionSection&) const = default;
};

struct MeshSection {
  double patch_spacing = 0.010;  ///< m
  double element_size = 0.005;   ///< m
  double interior_growth = 1.5;
  double feature_angle = 0.7853981633974483;  ///< rad
  bool curved_facets = true;
  bool operator==(const MeshSection&) const = default;
};

/// Only the members that belong to `shape` are read and printed; the others stay zero.
struct SupportSection {
  std::string shape;       ///< "plane", "box", "sphere", "surface" or "label"
  Vec3 point{}, normal{};  ///< plane; m, unit vector
  Vec3 low{}, high{};      ///< box; m
  Vec3 centre{};           ///< sphere; m
  double radius = 0;       ///< sphere; m
  std::string file;        ///< surface: relative to the folder of the case file
  std::string unit;        ///< surface: symbol of the length unit of the file
  double distance = 0;     ///< surface; m
  std::string label;       ///< label: name of faces in the file of the surface
  /// N/m^3; where either is not 0 the region rests on springs instead of being held.
  double normal_stiffness = 0, tangential_stiffness = 0;
  bool operator==(const SupportSection&) const = default;
};

/// Only the members that belong to the law, and to its field of fibres, are read and printed.
struct MaterialSection {
  std::string region;
  std::string law = "neo-hookean";
  std::vector<std::pair<std::string, double>> constants;  ///< by name in the table of laws, SI
  std::string fibre_field = "constant";
  Vec3 fibre_direction{}, fibre_plane{};  ///< constant field; the plane also of the next two
  std::string fibre_file, fibre_unit;     ///< field from a file, relative to the case file
  Vec3 fibre_from_low{}, fibre_from_high{}, fibre_to_low{}, fibre_to_high{};  ///< laplace, m
  Vec3 fibre_axis{}, fibre_axis_point{};  ///< cylindrical field; point in m
  double fibre_angle = 0;                 ///< rad
  int fibre_families = 1;
  bool operator==(const MaterialSection&) const = default;

  /// Place of a constant; it is added where it is new.
  double& constant(std::string_view name);
};

/// Only the members that belong to `shape` are read and printed; the others stay zero.
struct ToolSection {
  std::string shape = "sphere";
  double radius = 0.005;   ///< m
  double edge_radius = 0;  ///< m, disc
  double length = 0;       ///< m, cylinder
  double azimuth = 0;      ///< rad, cylinder
  std::string friction = "frictionless";
  bool operator==(const ToolSection&) const = default;
};

struct IndentationSection {
  double depth = 0.006;  ///< m
  int increments = 12;
  double lateral_travel = 0.003;  ///< m
  int lateral_increments = 6;
  std::vector<double> lateral_depths{0.002, 0.004,
                                     0.006};  ///< m; not given: a third of depth, two, all
  std::vector<double> azimuths{0.0};          ///< rad
  double force_tolerance = 1e-4;
  bool operator==(const IndentationSection&) const = default;
};

/// Only the members that belong to `method` are read and printed; the others keep their defaults.
struct SamplingSection {
  std::string method = "spacing";
  double start_spacing = 0.030;  ///< m, adaptive
  double tolerance = 0.05;       ///< of the force, adaptive
  int hold_out = 40;             ///< points, adaptive
  int most_sites = 100000;       ///< adaptive
  bool operator==(const SamplingSection&) const = default;
};

struct FitSection {
  double relative_tolerance = 0.01;
  double absolute_tolerance = 0.005;  ///< N
  int max_knots = 12;
  bool fill_holes = false;
  bool between_nodes = false;
  std::string responses = "decoupled";
  bool operator==(const FitSection&) const = default;
};

struct CertifySection {
  double friction = 0.3;
  std::vector<std::string> devices;  ///< files, relative to the folder of the case file
  bool operator==(const CertifySection&) const = default;
};

/// A scripted session: press, slide, release, by a hand that pulls the device through a spring.
struct SimulateSection {
  double rate = 2000;              ///< Hz
  double mass = 0.0845;            ///< kg, of the device
  double damping = 0.081;          ///< N s/m, of the device
  double coulomb_friction = 0.01;  ///< N, of the device
  double hand_stiffness = 300;     ///< N/m
  double hand_damping = 8;         ///< N s/m
  double press_depth = 0.003;      ///< m
  double press_speed = 0.010;      ///< m/s
  double slide_length = 0.040;     ///< m
  double slide_speed = 0.030;      ///< m/s
  bool operator==(const SimulateSection&) const = default;
};

struct SolverSection {
  std::string element = "tet10-pressure";
  bool refine_under_tool = false;
  bool operator==(const SolverSection&) const = default;
};

/// The body sags under its weight before it is touched.
struct GravitySection {
  Vec3 acceleration{};    ///< m/s^2; zero: no gravity
  double density = 1000;  ///< kg/m^3
  bool operator==(const GravitySection&) const = default;
};

struct OutputSection {
  std::string folder;  ///< relative to the current folder; empty means "out/<name>"
  bool operator==(const OutputSection&) const = default;
};

struct Case {
  std::string name;
  SurfaceSection surface;
  std::vector<InclusionSection> inclusions;
  MeshSection mesh;
  std::vector<SupportSection> supports;
  std::vector<MaterialSection> materials;
  ToolSection tool;
  IndentationSection indentation;
  SamplingSection sampling;
  SolverSection solver;
  GravitySection gravity;
  FitSection fit;
  CertifySection certify;
  SimulateSection simulate;
  OutputSection output;
  bool operator==(const Case&) const = default;
};

/// Read a case file strictly. @throws Error(Configuration) with file and line for bad TOML, an
/// unknown key (the nearest known key is named), a missing key, a dimensional value without unit or
/// with a wrong one, a constant that is not finite or out of range, a region without a material.
Case read_case(const std::filesystem::path& path);
Case parse_case(std::string_view toml, const std::string& file_name);  ///< the same from memory

/// The case with every default filled in, as TOML: parse_case(resolved_toml(c)) == c.
std::string resolved_toml(const Case& c);

/// The part of resolved_toml that holds the named sections ("" = the keys before any section).
/// Two cases that agree on the sections of a stage give the same artifact.
std::string resolved_sections(const Case& c, const std::vector<std::string_view>& sections);

/// The reference table of all keys, Markdown, made from what the reader accepts.
std::string case_reference();

}  // namespace palpate::app
