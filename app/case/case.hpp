// SPDX-License-Identifier: AGPL-3.0-or-later
// The case file: the settings of every stage for one body. Reference: docs/cases.md.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fem/campaign/campaign.hpp"
#include "fem/laws/relaxation.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/response/fit_settings.hpp"
#include "mesher/settings.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::app {

/// A quantity that is derived from others: "auto" in a case file. A list is empty instead.
inline constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();

/// A [[material]] table: the law of a region as written, with instantaneous or long-term moduli,
/// and the file that its fibre directions come from.
struct MaterialSection : fem::RegionMaterial {
  fem::Moduli moduli = fem::Moduli::Instantaneous;  ///< of `law`, where the material relaxes
  std::filesystem::path fibre_file;  ///< of a sampled fibre field; as written in the case
  double fibre_unit = 1;             ///< m per unit of length of that file
};

enum class SamplingMethod {
  Vertices,  ///< every response vertex is a site
  Nodes,     ///< every surface node is one: the patch spacing is the element size
  Adaptive   ///< sites are added until the error at hold-out points is met
};

/// Which response vertices are sites. The settings of adaptive sampling
/// (app/pipeline/adaptive.hpp).
struct SamplingSection {
  SamplingMethod method = SamplingMethod::Vertices;
  double initial_spacing = kAuto;  ///< m, between the sites of the first round
  double tolerance = 0.05;         ///< of the 95th-percentile relative error at hold-out points
  int hold_out_points = 40;
  int max_sites = 100000;
};

/// The settings of the certificate, with its devices by the files of their profiles.
struct CertifySection {
  double friction = fitting::CertifySettings{}.friction;
  std::vector<std::string> devices;  ///< relative to the folder of the case file
};

/// Where the slide of a scripted session leads.
enum class SlidePath {
  Longest,  ///< from the middle of the part with responses, where a straight line is longest
  Between   ///< from one given point to another
};

/// The device of [Mahvash & Hayward 2005, section VI] and a hand.
inline constexpr runtime::SimulatedDeviceSettings kPublishedDevice{.mass = 0.0845,
                                                                   .damping = 0.081,
                                                                   .coulomb_friction = 0.01,
                                                                   .hand_stiffness = 300,
                                                                   .hand_damping = 8};

/// A scripted session: press, slide, release. The hand pulls the device along its path through a
/// spring and a damper. What is `auto` is derived from the library (app/simulate/script.hpp).
struct SimulateSection {
  double rate = 2000;  ///< Hz
  runtime::SimulatedDeviceSettings device{.mass = kAuto,
                                          .damping = kAuto,
                                          .coulomb_friction = kAuto,
                                          .hand_stiffness = kAuto,
                                          .hand_damping = kAuto};
  double press_depth = kAuto;  ///< m
  double press_speed = kAuto;  ///< m/s
  double hold = kAuto;         ///< s
  SlidePath path = SlidePath::Longest;
  double slide_length = kAuto;  ///< m, of the longest path
  Vec3 from{};                  ///< m, of a path between two points
  Vec3 to{};                    ///< m
  double slide_speed = kAuto;   ///< m/s
  double tank_cap = kAuto;      ///< J
};

/// What is kept of the displacement of the skin, for deformation.pdef.
struct DeformationSection {
  int depths = 0;  ///< 0: nothing
  int modes = 200;
};

struct OutputSection {
  std::string folder;  ///< relative to the current folder; empty means "out/<name>"
};

/// The mesher's and the campaign's settings with every length `auto` that a case may leave out.
mesher::Settings mesh_of_case();
fem::CampaignSettings campaign_of_case();
/// Coupled responses.
fitting::FitSettings fit_of_case();

/// The settings of every stage of the pipeline. Each key of a case file is bound to a field of the
/// settings that a stage takes (app/case/describe/case.hpp), whose default is the default of the
/// key, but for lengths, which are derived (app/case/lengths.hpp), `drag_across` and `responses`.
/// What a case leaves out of these settings is set by app/pipeline/settings.hpp: the resolved
/// paths, the list of supports without springs, the tool that the mesher checks for, the
/// instantaneous law of a region with its sampled fibres, threads and memory.
struct Case {
  std::string name;
  std::filesystem::path records;  ///< sidecar of a measured body; as written; empty: none
  /// [surface], [volume_mesh], [[inclusion]], [mesh], [[press]]; paths as written
  mesher::Settings mesh = mesh_of_case();
  std::vector<mesher::Springs> supports;  ///< fixed nodes where both stiffnesses are 0
  std::vector<MaterialSection> materials;
  fem::CampaignSettings campaign =
      campaign_of_case();  ///< [tool], [indentation], [solver], [gravity]
  SamplingSection sampling;
  fitting::FitSettings fit = fit_of_case();
  DeformationSection deformation;
  CertifySection certify;
  SimulateSection simulate;
  OutputSection output;
  /// What was chosen for lengths that are `auto`, for the log: "patch_spacing = 9 mm, ...". No key.
  std::string derived;
};

/// Whether every key has the same value: the resolved text is exact.
bool operator==(const Case& a, const Case& b);

/// Size of the box around a body, m.
struct BodySize {
  double diagonal = 0;
  double thickness = 0;  ///< smallest dimension
};
using SizeOfBody = std::function<BodySize(const Case&)>;

/// Reads a case file strictly. Lengths that are `auto` are derived; `size` is asked only where one
/// of them depends on the body, and without it they stay `auto`. @throws Error(Configuration) with
/// file and line for invalid TOML, an unknown key (the nearest known key is named), a missing key,
/// a dimensional value without a unit or with a wrong one, a value that is not finite or out of
/// range, a region without a material.
Case read_case(const std::filesystem::path& path, const SizeOfBody& size = {});
/// The same from memory.
Case parse_case(std::string_view toml, const std::string& file_name, const SizeOfBody& size = {});

/// The case with the value of every key, defaults included, as TOML: parse_case(resolved_toml(c))
/// == c.
std::string resolved_toml(const Case& c);

/// The part of resolved_toml that holds the named sections ("" = the keys before any section).
/// Two cases that agree on the sections of a stage give the same artifact.
std::string resolved_sections(const Case& c, const std::vector<std::string_view>& sections);

/// The reference tables of all keys, Markdown, generated from the description that the reader uses.
std::string case_reference();

}  // namespace palpate::app
