// SPDX-License-Identifier: AGPL-3.0-or-later
// The sidecar of a measurement: what the records of a laboratory do not say about themselves.
// Reference: docs/measured.md.
#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "app/measured/specimen_size.hpp"
#include "app/measured/table_keys.hpp"
#include "format/relaxation.hpp"
#include "format/vec3.hpp"

namespace palpate::app {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// An uncertainty as stated; none counts as zero, with a warning of RecordChecks.
inline double stated_or_zero(double uncertainty) {
  return std::isnan(uncertainty) ? 0 : uncertainty;
}

struct MeasuredToolSection {
  std::string name;               ///< by which records refer to it, where there are several
  std::string shape = "sphere";   ///< or "plates": histories of a specimen between plates
  double radius = 0;              ///< m
  std::string friction;           ///< "frictionless" or "no-slip"
  std::string reference = "tip";  ///< what a robot logs: "tip" or "centre"
};

struct MachineSection {
  double compliance = 0;              ///< m/N
  double compliance_uncertainty = 0;  ///< m/N
  double force_calibration = 0;       ///< relative
  double force_noise = kNotGiven;     ///< N, standard, of a sample that is kept as recorded
  SpecimenSize size;                  ///< by which it made strain and stress of travel and force
};

struct ColumnsSection {
  std::string time, displacement, force;  ///< names; time may be empty
  std::string strain, stress;             ///< instead of displacement and force
  std::string x, y, z, fx, fy, fz;        ///< of a robot log
  std::string site;                       ///< of a batch; then what is stated at each site
  std::string normal_x, normal_y, normal_z;
  std::string contact_x, contact_y, contact_z;  ///< the logged point at first contact
  std::string time_unit, length_unit, force_unit, strain_unit, stress_unit;
  std::string load = "compression";  ///< or "tension": histories of a specimen alone
  std::string displacement_sign = "found", force_sign = "found";
};

struct DeclaredColumnSection {
  std::string name, unit;
};

struct ContactSection {
  std::string method = "fit";
  double exponent = 1.5;
  double threshold = kNotGiven;             ///< N
  double position = kNotGiven;              ///< m, as the record counts it
  double position_uncertainty = kNotGiven;  ///< m, standard
};

struct BaselineSection {
  std::string method = "fit";      ///< "fit" or "zeroed"
  double uncertainty = kNotGiven;  ///< N, standard, of the zero
};

struct PathSection {
  int samples = 24;
  bool as_recorded = false;  ///< the samples of a batch are those of the path, `samples` is unused
  int lateral_samples = 12;
  double lateral_ratio = 0;     ///< of a lateral response made from the normal one; 0: none
  RelaxationSeries relaxation;  ///< of the force; empty: the curves are those of the recorded press
};

struct PlacementSection {
  double tolerance = kNotGiven;      ///< m; if not given by the size of body and tool
  std::string frame = "fiducials";   ///< "fiducials" or "body"
  std::string force_is = "on body";  ///< "on body" or "on tool"
};

struct FiducialSection {
  Vec3 robot{}, body{};  ///< m
};

/// A record, or many of them: read_sidecar makes a section of each file.
struct PressFileSection {
  std::string file;   ///< relative to the sidecar; of a list a text with placeholders
  std::string files;  ///< pattern, instead
  std::string list;   ///< table of what varies, with a row for each file
  /// Texts with placeholders, of the pattern or the list, instead of the values below.
  std::string vertex_from, cycle_from, contact_from;
  std::vector<std::string> site_from;
  std::string tool;       ///< name; empty where there is one tool
  std::string tool_from;  ///< text with placeholders, instead
  measured::TableChoice choice;
  int vertex = -1;
  Vec3 site{kNotGiven, kNotGiven, kNotGiven};  ///< m, in the frame of the body
  int cycle = 1;
  double contact = kNotGiven;  ///< m, as the record counts it
  std::string where;           ///< its place in the sidecar, for messages
};

struct RobotFileSection {
  std::string file;
  std::string tool;   ///< name; empty where there is one tool
  std::string files;  ///< pattern, instead
  measured::TableChoice choice;
  int cycle = 1;
};

struct PhaseSection {
  std::string kind;
  double from = 0, to = 0;  ///< s, as the record counts them
};

struct HistoryFileSection {
  std::string file;
  std::string tool;  ///< name; empty where there is one tool
  int vertex = -1;
  Vec3 site{kNotGiven, kNotGiven, kNotGiven};  ///< m, in the frame of the body
  measured::TableChoice choice;
  double contact = kNotGiven;        ///< m, as the record counts it
  std::string held = "recognised";   ///< "travel", "force" or "recognised"
  std::vector<PhaseSection> phases;  ///< empty: recognised
};

struct BatchFileSection {
  std::string file;
  std::string tool;  ///< name; empty where there is one tool
  measured::TableChoice choice;
  std::vector<std::string> leave_out;  ///< numbers of sites
};

struct Sidecar {
  std::string name, specimen, source, licence, instrument, date, description;
  bool lists_tools = false;                ///< as [[tool]], not as [tool]
  std::vector<MeasuredToolSection> tools;  ///< of the file
  MeasuredToolSection tool;                ///< of the records that are here
  MachineSection machine;
  ColumnsSection columns;
  std::vector<DeclaredColumnSection> declared;
  ContactSection contact;
  BaselineSection baseline;
  PathSection path;
  PlacementSection placement;
  std::vector<FiducialSection> fiducials;
  std::vector<PressFileSection> presses;
  std::vector<RobotFileSection> robot_logs;
  std::vector<HistoryFileSection> histories;
  std::vector<BatchFileSection> batches;
};

/// The sidecar with the records of one tool: curves of different tools are never mixed.
/// @param tool  its name; empty where there is one.
/// @throws Error(Configuration) with file and line, as read_case; for several tools without a name.
Sidecar read_sidecar(const std::filesystem::path& path, const std::string& tool = {});

/// The names of the tools of a sidecar, in its order; one empty name where there is one tool.
std::vector<std::string> tools_of_sidecar(const std::filesystem::path& path);

/// The sidecar and the records that it names, of one tool.
std::vector<std::filesystem::path> measured_files(const std::filesystem::path& sidecar_file,
                                                  const std::string& tool = {});

}  // namespace palpate::app
