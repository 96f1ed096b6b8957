// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/sidecar.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "app/case/describe/series.hpp"
#include "app/case/reader.hpp"
#include "app/measured/many_files.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr Range kFraction{.low = 0, .high = 1};
constexpr Range kCount{.low = 2, .high = 1000};

}  // namespace

template <class V>
void describe(V& v, MeasuredToolSection& s) {
  v.text(s.name, {"name", "by which records refer to it, where there are several tools"});
  v.text(s.shape, {"shape", "shape of the rigid tool"}, {"sphere", "plates"});
  if (!v.when("shape", s.shape, "sphere")) return;
  v.quantity(s.radius, Dimension::Length, {"radius", "radius of the tool", kRequired, kPositive});
  v.text(s.friction, {"friction", "of the press", kRequired}, {"frictionless", "no-slip"});
  v.text(s.reference, {"reference", "point of the tool that a robot logs"}, {"tip", "centre"});
}

template <class V>
void describe(V& v, MachineSection& s) {
  v.quantity(s.compliance, Dimension::Compliance,
             {"compliance", "of machine and load cell together", kOptional, kNotNegative});
  v.quantity(s.compliance_uncertainty, Dimension::Compliance,
             {"compliance_uncertainty", "standard", kOptional, kNotNegative});
  v.number(s.force_calibration,
           {"force_calibration", "relative standard uncertainty of the load cell", kOptional,
            kFraction});
  v.quantity(s.force_noise, Dimension::Force,
             {"force_noise", "standard deviation of a sample that is kept as recorded", kOptional,
              kNotNegative});
  describe_specimen(v, s.size);
}

template <class V>
void describe_batch_columns(V& v, ColumnsSection& s) {
  v.text(s.site, {"site", "name of the column with the number of the site, in a batch"});
  v.text(s.normal_x, {"normal_x", "name of the column, of the unit normal out of the body"});
  v.text(s.normal_y, {"normal_y", "name of the column"});
  v.text(s.normal_z, {"normal_z", "name of the column"});
  v.text(s.contact_x, {"contact_x", "name of the column, of the logged point at first contact"});
  v.text(s.contact_y, {"contact_y", "name of the column"});
  v.text(s.contact_z, {"contact_z", "name of the column"});
}

template <class V>
void describe(V& v, ColumnsSection& s) {
  v.text(s.time, {"time", "name of the column"});
  v.text(s.displacement, {"displacement", "name of the column"});
  v.text(s.force, {"force", "name of the column"});
  v.text(s.strain, {"strain", "name of the column, instead of the displacement"});
  v.text(s.stress, {"stress", "name of the column, instead of the force"});
  v.text(s.x, {"x", "name of the column"});
  v.text(s.y, {"y", "name of the column"});
  v.text(s.z, {"z", "name of the column"});
  v.text(s.fx, {"fx", "name of the column"});
  v.text(s.fy, {"fy", "name of the column"});
  v.text(s.fz, {"fz", "name of the column"});
  describe_batch_columns(v, s);
  v.text(s.time_unit, {"time_unit", "where the file gives none"});
  v.text(s.length_unit, {"length_unit", "where the file gives none"});
  v.text(s.force_unit, {"force_unit", "where the file gives none"});
  v.text(s.strain_unit, {"strain_unit", "where the file gives none"});
  v.text(s.stress_unit, {"stress_unit", "where the file gives none"});
  v.text(s.load, {"load", "of the records"}, {"compression", "tension"});
  v.text(s.displacement_sign,
         {"displacement_sign", "as recorded: it grows into the body; found: by the largest force"},
         {"found", "as recorded", "reversed"});
  v.text(s.force_sign,
         {"force_sign", "as recorded: positive in compression; found: of the largest force"},
         {"found", "as recorded", "reversed"});
}

template <class V>
void describe(V& v, DeclaredColumnSection& s) {
  v.text(s.name, {"name", "of the column", kRequired});
  v.text(s.unit, {"unit", "of its values"});
}

template <class V>
void describe(V& v, ContactSection& s) {
  v.text(s.method, {"method", "how the contact point is found"}, {"fit", "threshold", "given"});
  v.number(s.exponent, {"exponent",
                        "of the onset of force: 1.5 sphere, 1 flat punch, 2 cone",
                        kOptional,
                        {.low = 1, .high = 3}});
  v.quantity(s.threshold, Dimension::Force,
             {"threshold", "force taken for contact", kOptional, kPositive});
  v.quantity(s.position, Dimension::Length,
             {"position", "displacement of the record at the contact point that is given"});
  v.quantity(s.position_uncertainty, Dimension::Length,
             {"position_uncertainty", "standard, of the contact point that is given", kOptional,
              kNotNegative});
}

template <class V>
void describe(V& v, BaselineSection& s) {
  v.text(s.method, {"method", "from the samples out of contact, or zeroed by the machine"},
         {"fit", "zeroed"});
  v.quantity(s.uncertainty, Dimension::Force,
             {"uncertainty", "standard, of the zero of a zeroed force", kOptional, kNotNegative});
}

template <class V>
void describe(V& v, PathSection& s) {
  v.integer(s.samples, {"samples", "of the normal path", kOptional, kCount});
  v.flag(s.as_recorded,
         {"as_recorded", "the samples of a batch are those of the path, without averaging"});
  v.integer(s.lateral_samples, {"lateral_samples", "of a lateral path", kOptional, kCount});
  v.number(s.lateral_ratio,
           {"lateral_ratio",
            "lateral over normal stiffness where no drag was measured; 0 makes no lateral path",
            kOptional,
            {.low = 0, .high = 1}});
  describe_series(v, s.relaxation,
                  {"relaxation",
                   "Prony series of the force, of `palpate calibrate relaxation`: the curves are "
                   "then those of tissue that has had no time to relax"},
                  "part of the instantaneous force that relaxes; their sum is below 1");
}

template <class V>
void describe(V& v, PlacementSection& s) {
  v.quantity(
      s.tolerance, Dimension::Length,
      {"tolerance", "largest distance from a measured point to its site", kOptional, kPositive});
  v.text(s.frame, {"frame", "in which points are given: of the robot, or of the body"},
         {"fiducials", "body"});
  v.text(s.force_is, {"force_is", "which force a robot logs"}, {"on body", "on tool"});
}

template <class V>
void describe(V& v, FiducialSection& s) {
  v.point(s.robot, Dimension::Length, {"robot", "where the robot saw it", kRequired});
  v.point(s.body, Dimension::Length, {"body", "where it is on the body", kRequired});
}

template <class V>
void describe(V& v, PressFileSection& s) {
  v.text(s.file, {"file", "record, relative to the sidecar; with {names} of a list"});
  v.text(s.files, {"files", "many records, instead: \"run-{n}-*.csv\""});
  v.text(s.list, {"list", "table of what varies, with a row for each file"});
  v.text(s.vertex_from, {"vertex_from", "vertex of each file: \"{n}\""});
  v.texts(s.site_from, {"site_from", "point of each file: [\"{x} mm\", \"{y} mm\", \"20 mm\"]"});
  v.text(s.cycle_from, {"cycle_from", "cycle of each file: \"{cycle}\""});
  v.text(s.contact_from, {"contact_from", "contact of each file: \"{contact} mm\""});
  v.text(s.tool, {"tool", "name of the tool, where there are several"});
  v.text(s.tool_from, {"tool_from", "name of the tool of each file: \"{tool}\""});
  v.integer(s.vertex, {"vertex", "response vertex of the body", kOptional, kNotNegative});
  v.point(s.site, Dimension::Length, {"site", "point that was pressed, in the frame of the body"});
  describe_table_choice(v, s.choice);
  v.integer(s.cycle, {"cycle", "which press of the record; -1 is the last"});
  v.quantity(s.contact, Dimension::Length,
             {"contact", "displacement of this record at the contact point that is given"});
}

template <class V>
void describe(V& v, RobotFileSection& s) {
  v.text(s.file, {"file", "log, relative to the sidecar"});
  v.text(s.files, {"files", "many logs, instead: \"log-*.csv\""});
  v.text(s.tool, {"tool", "name of the tool, where there are several"});
  describe_table_choice(v, s.choice);
  v.integer(s.cycle, {"cycle", "which press of the log; -1 is the last"});
}

template <class V>
void describe(V& v, PhaseSection& s) {
  v.text(s.kind, {"kind", "what the machine does", kRequired},
         {"approach", "rest", "ramp", "hold", "release"});
  v.quantity(s.from, Dimension::Time, {"from", "time of the record", kRequired});
  v.quantity(s.to, Dimension::Time, {"to", "time of the record", kRequired});
}

template <class V>
void describe(V& v, HistoryFileSection& s) {
  v.text(s.file, {"file", "record over time, relative to the sidecar", kRequired});
  v.text(s.tool, {"tool", "name of the tool, where there are several"});
  v.integer(s.vertex, {"vertex", "response vertex of the body", kOptional, kNotNegative});
  v.point(s.site, Dimension::Length, {"site", "point that was pressed, in the frame of the body"});
  describe_table_choice(v, s.choice);
  v.quantity(s.contact, Dimension::Length,
             {"contact", "displacement of this record at the contact point that is given"});
  v.text(s.held, {"held", "what the machine holds: the travel (relaxation) or the force (creep)"},
         {"recognised", "travel", "force"});
  v.tables(s.phases, {"phases", "in order of time; recognised where they are not given"},
           [](auto& in, PhaseSection& phase) { describe(in, phase); });
}

template <class V>
void describe(V& v, BatchFileSection& s) {
  v.text(s.file, {"file", "log of many sites, relative to the sidecar", kRequired});
  v.text(s.tool, {"tool", "name of the tool, where there are several"});
  describe_table_choice(v, s.choice);
  v.texts(s.leave_out, {"leave_out", "numbers of sites that are not used"});
}

template <class V>
void describe(V& v, Sidecar& s) {
  v.text(s.name, {"name", "of the measurement", kRequired});
  v.text(s.specimen, {"specimen", "what was pressed", kRequired});
  v.text(s.source, {"source", "who measured it, or where it was published", kRequired});
  v.text(s.licence, {"licence", "of the data", kRequired});
  v.text(s.instrument, {"instrument", "machine and load cell"});
  v.text(s.date, {"date", "of the measurement"});
  v.text(s.description, {"description", "anything else"});
  if (s.lists_tools)
    v.sections("tool", s.tools, kRequired, "");
  else
    v.section("tool", s.tools.emplace_back(), kRequired, "[tool], shape and size of what pressed");
  v.section("machine", s.machine, kOptional, "");
  v.section("columns", s.columns, kRequired,
            "[columns], with the names of the columns of the records (docs/measured.md)");
  v.sections("column", s.declared, kOptional, "");
  v.section("contact", s.contact, kOptional, "");
  v.section("baseline", s.baseline, kOptional, "");
  v.section("path", s.path, kOptional, "");
  v.section("placement", s.placement, kOptional, "");
  v.sections("fiducial", s.fiducials, kOptional, "");
  v.sections("press", s.presses, kOptional, "");
  v.sections("robot", s.robot_logs, kOptional, "");
  v.sections("history", s.histories, kOptional, "");
  v.sections("batch", s.batches, kOptional, "");
}

namespace {

/// Strain and stress are those that the machine made of travel and force, by the sizes it was told.
void check_converted(const Sidecar& s, const SourceMap& sources) {
  const ColumnsSection& c = s.columns;
  const std::string where = sources.where("columns");
  if (!c.strain.empty() && !c.displacement.empty())
    refuse(where, "both strain and displacement are named", "name the one that was measured");
  if (!c.stress.empty() && !c.force.empty())
    refuse(where, "both stress and force are named", "name the one that was measured");
  if (c.strain.empty() == std::isfinite(s.machine.size.gauge_length))
    refuse(where,
           c.strain.empty() ? "a gauge length is given, and no column is a strain"
                            : "a strain needs the length by which the machine divided the travel",
           "give columns.strain together with machine.gauge_length");
  if (!c.stress.empty())
    section_area(s.machine.size, sources.where("machine"));
  else if (has_section_keys(s.machine.size))
    refuse(where, "the section of a specimen is given, and no column is a stress",
           "give columns.stress together with machine.area, or leave the section out");
}

void check_columns(const Sidecar& s, const SourceMap& sources) {
  const ColumnsSection& c = s.columns;
  const auto need = [&](const std::string& value, const char* key, const char* what) {
    if (!value.empty()) return;
    refuse(sources.where("columns"), fmt::format("key 'columns.{}' is missing", key),
           fmt::format("name the column of the {}", what));
  };
  if (c.load == "tension" && s.tool.shape != "plates")
    refuse(sources.where("columns.load"),
           "a pull is no press: a library holds the forces of a tool "
           "that touches the body from outside",
           "give specimens in tension to `palpate calibrate tests`, and their histories with "
           "tool.shape = \"plates\"");
  if (!s.robot_logs.empty() && (c.displacement_sign != "found" || c.force_sign != "found"))
    refuse(sources.where("columns"), "signs are stated, and a robot log has three components",
           "give placement.force_is for a robot log");
  check_converted(s, sources);
  if (!s.histories.empty()) need(c.time, "time", "time");
  if (!s.presses.empty() || !s.histories.empty()) {
    if (c.strain.empty()) need(c.displacement, "displacement", "displacement, or 'strain'");
    if (c.stress.empty()) need(c.force, "force", "force, or 'stress'");
  }
  if (s.robot_logs.empty() && s.batches.empty()) return;
  for (const auto& [value, key] : {std::pair{&c.x, "x"}, {&c.y, "y"}, {&c.z, "z"}}) {
    need(*value, key, "position");
  }
  for (const auto& [value, key] : {std::pair{&c.fx, "fx"}, {&c.fy, "fy"}, {&c.fz, "fz"}}) {
    need(*value, key, "force");
  }
  if (s.batches.empty()) return;
  need(c.site, "site", "number of the site");
  for (const auto& [value, key] :
       {std::pair{&c.normal_x, "normal_x"}, {&c.normal_y, "normal_y"}, {&c.normal_z, "normal_z"}}) {
    need(*value, key, "normal");
  }
  // All three, where the contact points are given, and none otherwise.
  const bool given = s.contact.method == "given";
  for (const auto& [value, key] : {std::pair{&c.contact_x, "contact_x"},
                                   {&c.contact_y, "contact_y"},
                                   {&c.contact_z, "contact_z"}}) {
    if (given) need(*value, key, "contact point");
    if (given || value->empty()) continue;
    refuse(sources.where(std::string("columns.") + key),
           "a contact point is given, and contact.method says otherwise",
           "say contact.method = \"given\"");
  }
}

void check_sites(const Sidecar& s, const SourceMap& sources) {
  for (std::size_t i = 0; i < s.histories.size(); ++i) {
    if (!std::isfinite(s.histories[i].site[0]) || s.histories[i].vertex < 0) continue;
    refuse(sources.where(fmt::format("history[{}].", i)), "both vertex and site are given",
           "say once where the tool was pressed");
  }
  for (std::size_t i = 0; i < s.presses.size(); ++i) {
    const PressFileSection& press = s.presses[i];
    const bool by_point = std::isfinite(press.site[0]);
    if (by_point != (press.vertex >= 0)) continue;
    refuse(press.where,
           by_point ? "both vertex and site are given" : "neither vertex nor site is given",
           "say once where the tool was pressed");
  }
}

/// The contact point of a record is given where the method says so, and nowhere else.
void check_given(bool given, double here, double everywhere, const std::string& where,
                 const SourceMap& sources) {
  if (given && !std::isfinite(here) && !std::isfinite(everywhere)) {
    refuse(sources.where("contact.method"), "key 'contact.position' is missing",
           "give the displacement at the contact point, for all records or as 'contact' of each");
  }
  if (!given && std::isfinite(here)) {
    refuse(where, "a contact point is given, and contact.method says otherwise",
           "say contact.method = \"given\"");
  }
}

void check_contact(const Sidecar& s, const SourceMap& sources) {
  const bool given = s.contact.method == "given";
  if (given && !s.robot_logs.empty()) {
    refuse(sources.where("contact.method"), "the contact point of a robot log is not given",
           "let it be found, or give presses along one axis as [[press]]");
  }
  for (const PressFileSection& press : s.presses)
    check_given(given, press.contact, s.contact.position, press.where, sources);
  for (std::size_t i = 0; i < s.histories.size(); ++i)
    check_given(given, s.histories[i].contact, s.contact.position,
                sources.where(fmt::format("history[{}].contact", i)), sources);
  if (!given && std::isfinite(s.contact.position)) {
    refuse(sources.where("contact.position"),
           "a contact point is given, and contact.method says otherwise",
           "say contact.method = \"given\"");
  }
}

void check_tool(const Sidecar& s, const SourceMap& sources) {
  const bool makes_curves = !s.presses.empty() || !s.robot_logs.empty() || !s.batches.empty();
  if (s.tool.shape == "sphere" || !makes_curves) return;
  refuse(sources.where("tool.shape"), "curves are those of a sphere, and the tool is plates",
         "give the records as [[history]]");
}

const MeasuredToolSection* tool_named(const Sidecar& s, const std::string& name) {
  for (const MeasuredToolSection& tool : s.tools)
    if (tool.name == name) return &tool;
  return nullptr;
}

std::string names_of_tools(const Sidecar& s) {
  std::string names;
  for (const MeasuredToolSection& tool : s.tools)
    names += (names.empty() ? "'" : ", '") + tool.name + "'";
  return names;
}

/// Names are those of folders.
void check_tool_names(const Sidecar& s, const SourceMap& sources) {
  if (s.tools.size() < 2) return;
  for (std::size_t i = 0; i < s.tools.size(); ++i) {
    const std::string where = sources.where(fmt::format("tool[{}].", i)), &name = s.tools[i].name;
    if (name.empty())
      refuse(where, "key 'tool.name' is missing",
             "name each of several tools, and the tool of each record: tool = \"NAME\"");
    const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '-' || c == '_';
    });
    if (!plain)
      refuse(where, "the tool has the name '" + name + "', and import makes a folder of it",
             "use letters, digits, '-' and '_'");
    if (tool_named(s, name) != &s.tools[i])
      refuse(where, "two tools have the name '" + name + "'", "give each a name of its own");
  }
}

/// Every record has a tool that the sidecar describes, and every tool has a record.
template <class Section>
void check_record_tools(const Sidecar& s, const std::vector<Section>& records,
                        const std::string& kind, const SourceMap& sources,
                        std::vector<std::string>& used) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Section& record = records[i];
    const std::string where = sources.where(kind) + " (" + record.file + ")";
    if (record.tool.empty() && s.tools.size() > 1)
      refuse(where, "it does not say which of several tools pressed",
             "add tool = \"NAME\", of " + names_of_tools(s));
    if (!record.tool.empty() && tool_named(s, record.tool) == nullptr)
      refuse(where, "no [[tool]] has the name '" + record.tool + "'",
             "the tools are " + names_of_tools(s));
    used.push_back(record.tool);
  }
}

void check_record_tools(const Sidecar& s, const SourceMap& sources) {
  std::vector<std::string> used;
  check_record_tools(s, s.presses, "press[0].", sources, used);
  check_record_tools(s, s.robot_logs, "robot[0].", sources, used);
  check_record_tools(s, s.histories, "history[0].", sources, used);
  check_record_tools(s, s.batches, "batch[0].", sources, used);
  for (std::size_t i = 0; i < s.tools.size() && s.tools.size() > 1; ++i)
    if (std::find(used.begin(), used.end(), s.tools[i].name) == used.end())
      refuse(sources.where(fmt::format("tool[{}].", i)),
             "no record is of the tool '" + s.tools[i].name + "'", "leave it out");
}

/// Leaves the records of one tool.
void choose_tool(Sidecar& s, const std::string& name, const std::string& where) {
  if (s.tools.size() > 1 && name.empty())
    refuse(where, "its records are of several tools: " + names_of_tools(s),
           "`palpate import` writes a folder for each: take the artifacts of one of them");
  const MeasuredToolSection* tool =
      s.tools.size() > 1 || !name.empty() ? tool_named(s, name) : &s.tools.front();
  if (tool == nullptr)
    refuse(where, "no [[tool]] has the name '" + name + "'", "the tools are " + names_of_tools(s));
  s.tool = *tool;
  if (s.tools.size() < 2) return;
  const auto is_of_another = [&](const auto& record) { return record.tool != name; };
  std::erase_if(s.presses, is_of_another);
  std::erase_if(s.robot_logs, is_of_another);
  std::erase_if(s.histories, is_of_another);
  std::erase_if(s.batches, is_of_another);
}

/// The first thing that newcomers give is the record itself.
void check_is_no_record(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 5> records{".csv", ".tsv", ".txt", ".dat", ".raw"};
  if (std::find(records.begin(), records.end(), path.extension().string()) == records.end()) return;
  refuse(path.string(), "this is a record, not its sidecar",
         "describe it in a TOML file beside it, as data/measured/pad/presses.toml does "
         "(docs/measured.md), and give that file");
}

/// All records of the file, with their tools.
Sidecar read_whole(const std::filesystem::path& path, SourceMap& sources) {
  check_is_no_record(path);
  const toml::table table = read_toml(path, "the sidecar");
  Sidecar sidecar;
  sidecar.lists_tools = table["tool"].is_array();
  TableReader reader(table, "the sidecar", "", sources);
  describe(reader, sidecar);
  reader.finish();
  if (sidecar.presses.empty() && sidecar.robot_logs.empty() && sidecar.histories.empty() &&
      sidecar.batches.empty()) {
    refuse(path.string(), "it names no record",
           "add [[press]], [[robot]], [[batch]] or [[history]] with a file");
  }
  expand_files(sidecar, path.parent_path(), sources);
  if (sidecar.contact.method == "threshold" && !std::isfinite(sidecar.contact.threshold)) {
    refuse(sources.where("contact.method"), "key 'contact.threshold' is missing",
           "give the force that is taken for contact");
  }
  check_tool_names(sidecar, sources);
  check_record_tools(sidecar, sources);
  return sidecar;
}

}  // namespace

Sidecar read_sidecar(const std::filesystem::path& path, const std::string& tool) {
  SourceMap sources(path.string());
  Sidecar sidecar = read_whole(path, sources);
  choose_tool(sidecar, tool, path.string());
  check_tool(sidecar, sources);
  check_contact(sidecar, sources);
  check_columns(sidecar, sources);
  check_sites(sidecar, sources);
  return sidecar;
}

std::vector<std::string> tools_of_sidecar(const std::filesystem::path& path) {
  SourceMap sources(path.string());
  std::vector<std::string> names;
  const Sidecar sidecar = read_whole(path, sources);
  for (const MeasuredToolSection& tool : sidecar.tools)
    names.push_back(sidecar.tools.size() > 1 ? tool.name : "");
  return names;
}

std::vector<std::filesystem::path> measured_files(const std::filesystem::path& sidecar_file,
                                                  const std::string& tool) {
  const Sidecar sidecar = read_sidecar(sidecar_file, tool);
  std::vector<std::filesystem::path> files{sidecar_file};
  const auto add = [&](const auto& sections) {
    for (const auto& section : sections) {
      const auto file = sidecar_file.parent_path() / section.file;
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    }
  };
  add(sidecar.presses);
  add(sidecar.robot_logs);
  add(sidecar.batches);
  add(sidecar.histories);
  return files;
}

}  // namespace palpate::app
