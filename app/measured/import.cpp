// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include "app/json_number.hpp"
#include "app/measured/record_reader.hpp"
#include "fitting/measurement/records/placement.hpp"
#include "fitting/measurement/records/repeats.hpp"
#include "fitting/measurement/records/robot.hpp"
#include "fitting/measurement/records/table_file.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/numbers.hpp"
#include "format/sha256.hpp"
#include "format/to_index.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
namespace m = palpate::measured;
using Json = nlohmann::ordered_json;

constexpr Vec3 kDown{0, 0, -1};

/// Everything found at one site.
struct SiteRecords {
  std::vector<m::PressCurve> presses;
  std::vector<m::DragCurve> drags;
};

class Importer {
 public:
  Importer(const fs::path& sidecar_file, const fs::path& body_file)
      : sidecar_file_(sidecar_file), body_file_(body_file), s_(read_sidecar(sidecar_file)) {
    if (!body_file.empty()) body_ = read_body(body_file);
    if (body_ && !std::isfinite(s_.placement.tolerance))
      s_.placement.tolerance = tolerance_on(*body_);
    for (const auto& column : s_.declared) declared_.push_back({column.name, column.unit});
    doubt_tool();
    place_frame();
  }

  /// Leaves out what is not among these files, and refuses what the sidecar does not name.
  void restrict_to(const std::vector<fs::path>& records) {
    std::map<fs::path, bool> named;
    for (const fs::path& record : records) named[fs::weakly_canonical(record)] = false;
    const auto is_left_out = [&](const auto& section) {
      const auto found = named.find(fs::weakly_canonical(path_of(section.file)));
      if (found == named.end()) return true;
      found->second = true;
      return false;
    };
    std::erase_if(s_.presses, is_left_out);
    std::erase_if(s_.robot_logs, is_left_out);
    std::erase_if(s_.histories, is_left_out);
    for (const auto& [record, known] : named) {
      if (known) continue;
      put_off(record.string(), Error(ErrorKind::Configuration, record.string(),
                                     "the sidecar " + sidecar_file_.string() + " does not name it",
                                     "add it as `file`, or a pattern as `files` of a [[press]] or "
                                     "[[robot]], or as a [[history]]"));
    }
  }

  Import run() {
    for (const PressFileSection& press : s_.presses)
      attempt(press.file, [&] { read_press(press); });
    for (const RobotFileSection& robot : s_.robot_logs)
      attempt(robot.file, [&] { read_robot(robot); });
    for (const BatchFileSection& batch : s_.batches)
      attempt(batch.file, [&] { read_batch(batch); });
    Import result;
    result.histories = histories(true);
    result.curves = curves();
    if (result.curves.sites.empty() && first_refusal_) throw *first_refusal_;
    result.refused = static_cast<int>(refused_.size());
    account_["refused"] = refused_;
    account_["sites"] = sites_account(result.curves);
    if (const std::string text = conversion(); !text.empty()) account_["conversion"] = text;
    account_["records"] = records_;
    account_["warnings"] = warnings_;
    result.account = account_;
    return result;
  }

  /// @param placed  whether sites are looked up on the body.
  Histories histories(bool placed) {
    Histories histories;
    for (const HistoryFileSection& history : s_.histories)
      histories.records.push_back(read_history(history, placed));
    add_origin(histories);
    return histories;
  }

 private:
  void put_off(const std::string& what, const Error& error) {
    if (!first_refusal_) first_refusal_ = error;
    refused_.push_back({{"file", what}, {"reason", error.what()}});
  }

  /// A record that is wrong does not take the others with it.
  template <class Work>
  bool attempt(const std::string& what, Work work) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Configuration) throw;
      put_off(what, error);
      return false;
    }
  }

  fs::path path_of(const std::string& file) const { return sidecar_file_.parent_path() / file; }

  std::vector<double> column(const m::CsvTable& table, const std::string& name,
                             Dimension dimension) const {
    const ColumnsSection& c = s_.columns;
    const std::string& unit = dimension == Dimension::Time       ? c.time_unit
                              : dimension == Dimension::Length   ? c.length_unit
                              : dimension == Dimension::Ratio    ? c.strain_unit
                              : dimension == Dimension::Pressure ? c.stress_unit
                                                                 : c.force_unit;
    if (name.empty()) return {};
    return m::column_in_si(table, name, dimension, unit);
  }

  static std::vector<std::string> named(std::vector<std::string> names) {
    std::erase(names, "");
    return names;
  }
  std::vector<std::string> wanted_of_press() const {
    const ColumnsSection& c = s_.columns;
    return named({c.time, c.displacement, c.strain, c.force, c.stress});
  }
  std::vector<std::string> wanted_of_robot() const {
    const ColumnsSection& c = s_.columns;
    return named({c.time, c.x, c.y, c.z, c.fx, c.fy, c.fz});
  }

  m::PressSettings press_settings(int cycle) const {
    m::PressSettings settings;
    settings.compliance = s_.machine.compliance;
    settings.compliance_uncertainty = s_.machine.compliance_uncertainty;
    settings.cycle = cycle;
    settings.exponent = s_.contact.exponent;
    settings.method = s_.contact.method == "fit"         ? m::ContactMethod::Fit
                      : s_.contact.method == "threshold" ? m::ContactMethod::Threshold
                                                         : m::ContactMethod::Given;
    settings.threshold = s_.contact.threshold;
    settings.contact_uncertainty = s_.contact.position_uncertainty;
    settings.baseline =
        s_.baseline.method == "fit" ? m::BaselineMethod::Fit : m::BaselineMethod::Zeroed;
    settings.zero_uncertainty = s_.baseline.uncertainty;
    return settings;
  }

  void place_frame() {
    if (s_.robot_logs.empty() && s_.batches.empty()) return;
    if (!body_) {
      throw Error(ErrorKind::Configuration, sidecar_file_.string(),
                  "robot logs are placed on a body, and none is given",
                  "add --body body.h5 (made by `palpate mesh`)");
    }
    if (s_.placement.frame == "body") return;
    std::vector<m::Fiducial> fiducials;
    for (const FiducialSection& f : s_.fiducials) fiducials.push_back({f.robot, f.body});
    registration_ = m::register_fiducials(fiducials, sidecar_file_.string());
    account_["registration_rms_m"] = registration_.rms;
  }

  template <class Section>
  int vertex_of(const Section& press, double& distance) const {
    distance = 0;
    const std::string where = path_of(press.file).string();
    if (press.vertex < 0) {
      if (!body_) {
        throw Error(ErrorKind::Configuration, where, "a site given by its point needs a body",
                    "add --body body.h5 (made by `palpate mesh`), or give a vertex");
      }
      const m::NearestSite site =
          m::nearest_site(*body_, press.site, s_.placement.tolerance, where);
      distance = site.distance;
      return site.vertex;
    }
    if (!body_) return press.vertex;
    const auto vertex = static_cast<std::size_t>(press.vertex);
    if (vertex >= body_->response.node.size() || body_->response.is_site[vertex] == 0) {
      throw Error(ErrorKind::Configuration, where,
                  fmt::format("vertex {} is not a site of the body", press.vertex),
                  "choose a vertex outside the supports");
    }
    return press.vertex;
  }

  /// The travel, or the strain times the length by which the machine had divided it.
  std::vector<double> displacement_of(const m::CsvTable& table) const {
    if (s_.columns.strain.empty()) return column(table, s_.columns.displacement, Dimension::Length);
    return scaled(column(table, s_.columns.strain, Dimension::Ratio), s_.machine.size.gauge_length);
  }

  std::vector<double> force_of(const m::CsvTable& table) const {
    if (s_.columns.stress.empty()) return column(table, s_.columns.force, Dimension::Force);
    return scaled(column(table, s_.columns.stress, Dimension::Pressure),
                  section_area(s_.machine.size, sidecar_file_.string()));
  }

  static std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
  }

  /// Signs that are found in the record, or those that the sidecar states.
  m::Signs oriented(m::PressRecord& record) const {
    const std::string &of_displacement = s_.columns.displacement_sign,
                      &of_force = s_.columns.force_sign;
    m::PressRecord turned = record;
    m::Signs signs = m::orient(turned);
    if (of_displacement != "found") signs.displacement = of_displacement == "reversed" ? -1 : 1;
    if (of_force != "found") signs.force = of_force == "reversed" ? -1 : 1;
    record.displacement = scaled(std::move(record.displacement), signs.displacement);
    record.force = scaled(std::move(record.force), signs.force);
    return signs;
  }

  /// How the columns became displacement and force, where they are not those.
  std::string conversion() const {
    std::string text;
    if (!s_.columns.strain.empty())
      text = fmt::format("displacement = '{}' x {}", s_.columns.strain,
                         length_text(s_.machine.size.gauge_length));
    if (!s_.columns.stress.empty())
      text += fmt::format("{}force = '{}' x {}", text.empty() ? "" : ", ", s_.columns.stress,
                          area_text(section_area(s_.machine.size, sidecar_file_.string())));
    return text;
  }

  void read_press(const PressFileSection& press) {
    const fs::path file = path_of(press.file);
    const m::CsvTable table = m::read_table(file, press.choice, declared_, wanted_of_press());
    m::Signs signs;
    const m::PressRecord record = record_of(file, table, signs);
    double distance = 0;
    const int vertex = vertex_of(press, distance);
    m::PressSettings settings = press_settings(press.cycle);
    const double given = std::isfinite(press.contact) ? press.contact : s_.contact.position;
    settings.contact = signs.displacement * given;
    const m::PressCurve curve = m::analyse_press(record, settings);
    check_depth(file.string(), curve);
    warn_of_drift(press.file, curve);
    add_account(press.file, table, vertex, distance, curve);
    sites_[vertex].presses.push_back(curve);
    add_file(file);
  }

  /// The record with growing displacements and forces, and the signs that made it so.
  m::PressRecord record_of(const fs::path& file, const m::CsvTable& table, m::Signs& signs) const {
    m::PressRecord record{file.string(), column(table, s_.columns.time, Dimension::Time),
                          displacement_of(table), force_of(table)};
    signs = oriented(record);
    return record;
  }

  SiteHistory read_history(const HistoryFileSection& section, bool placed) {
    const fs::path file = path_of(section.file);
    const m::CsvTable table = m::read_table(file, section.choice, declared_, wanted_of_press());
    m::Signs signs;
    const m::PressRecord record = record_of(file, table, signs);
    SiteHistory site;
    double distance = 0;
    if (placed && (section.vertex >= 0 || std::isfinite(section.site[0])))
      site.vertex = vertex_of(section, distance);
    m::HistorySettings settings{press_settings(1), std::nullopt, {}};
    const double given = std::isfinite(section.contact) ? section.contact : s_.contact.position;
    settings.press.contact = signs.displacement * given;
    if (section.held == "travel") settings.control = m::Control::Travel;
    if (section.held == "force") settings.control = m::Control::Force;
    for (const PhaseSection& phase : section.phases)
      settings.declared.push_back({m::phase_of_name(phase.kind).value(), phase.from, phase.to});
    site.history = m::analyse_history(record, settings);
    site.history.name = section.file;
    add_file(file);
    return site;
  }

  void add_origin(Histories& histories) const {
    histories.name = s_.name;
    histories.specimen = s_.specimen;
    histories.source = s_.source;
    histories.licence = s_.licence;
    histories.tool = {s_.tool.shape, s_.tool.radius, s_.tool.friction};
    if (body_) histories.body_sha256 = sha256_of_file(body_file_);
  }

  void doubt_tool() {
    if (!body_ || s_.tool.radius <= extent_of(*body_)) return;
    warn(fmt::format("the radius of the tool, {}, is larger than the body, {}: check its unit",
                     length_text(s_.tool.radius), length_text(extent_of(*body_))));
  }

  /// A wrong unit shows in a tool that is deeper in the body than that is large, and a depth that
  /// is many times the tool where there is no body to compare with.
  void check_depth(const std::string& where, const m::PressCurve& curve) {
    const double depth = curve.loading.back().depth;
    if (body_ && depth > extent_of(*body_)) {
      throw Error(ErrorKind::Configuration, where,
                  fmt::format("the tool goes {} deep into a body of {}", length_text(depth),
                              length_text(extent_of(*body_))),
                  "check the unit of the displacement");
    }
    constexpr double kManyRadii = 10;
    if (depth > kManyRadii * s_.tool.radius) {
      warn(fmt::format("{}: the tool goes {} deep, its radius is {}: check the units", where,
                       length_text(depth), length_text(s_.tool.radius)));
    }
  }

  static const char* drift_word(m::DriftState state) {
    switch (state) {
      case m::DriftState::Unknown:
        return "unknown";
      case m::DriftState::Fitted:
        return "removed";
      case m::DriftState::Undetermined:
        return "not determined";
      case m::DriftState::Suspected:
        return "seen, not determined";
    }
    return "";
  }

  /// What the samples out of contact leave open about the force at the end of loading.
  void warn_of_drift(const std::string& where, const m::PressCurve& curve) {
    constexpr double kMatters = 0.05;  // of the force
    const m::DepthForce& end = curve.loading.back();
    if (curve.baseline.state == m::DriftState::Suspected) {
      const double at_end = curve.common.suspected_drift * (end.time - curve.common.suspected_from);
      warn(
          fmt::format("{}: out of contact the force drifts, by {} until the deepest point, if it "
                      "goes on; too few samples determine it: it is not removed, and counts as an "
                      "uncertainty. Record the release, or a wait before the press, and the time",
                      where, force_text(std::abs(at_end))));
    } else if (curve.baseline.possible_drift * end.time > kMatters * std::abs(end.force)) {
      warn(
          fmt::format("{}: the samples out of contact do not exclude a drift of {} until the "
                      "deepest point, {} of the force; none is removed, and the uncertainty has "
                      "none. Record the release, or a wait before the press",
                      where, force_text(curve.baseline.possible_drift * end.time),
                      percent_text(curve.baseline.possible_drift * end.time / end.force)));
    }
  }

  /// The mean edge of the response triangles or four radii of the tool, at most 5 mm: where no site
  /// of a fine surface is that near, the frame or a unit is wrong.
  double tolerance_on(const Body& body) const {
    constexpr double kMost = 5e-3, kRadii = 4;
    double sum = 0;
    const auto corner = [&](std::int32_t v) {
      return body.nodes[to_index(body.response.node[to_index(v)])];
    };
    for (const Triangle& t : body.response.triangles)
      for (std::size_t i = 0; i < 3; ++i) sum += norm(corner(t[i]) - corner(t[(i + 1) % 3]));
    const double edge = sum / (3 * static_cast<double>(body.response.triangles.size()));
    return std::min(kMost, std::max(edge, kRadii * s_.tool.radius));
  }

  static double extent_of(const Body& body) {
    Vec3 low = body.nodes.front(), high = low;
    for (const Vec3& x : body.nodes) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], x[i]);
        high[i] = std::max(high[i], x[i]);
      }
    }
    return norm(high - low);
  }

  void warn(const std::string& text) { warnings_.push_back(text); }

  /// What is known to within half of itself is hardly measured.
  void warn_of_doubt(const SiteCurves& site) {
    for (const CurvePath& path : site.paths) {
      const CurveSample& end = path.samples.back();
      if (!(end.force_uncertainty > 0.5 * std::abs(dot(end.force, path.direction)))) continue;
      warn(fmt::format("site {}: the force is uncertain by more than half of itself", site.vertex));
      return;
    }
  }

  /// A file of several tables is one input.
  void add_file(const fs::path& file) {
    if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
  }

  m::RobotLog robot_log(const fs::path& file, const m::CsvTable& table) const {
    const ColumnsSection& c = s_.columns;
    m::RobotLog log;
    log.name = file.string();
    log.time = column(table, c.time, Dimension::Time);
    const auto x = column(table, c.x, Dimension::Length);
    const auto y = column(table, c.y, Dimension::Length);
    const auto z = column(table, c.z, Dimension::Length);
    const auto fx = column(table, c.fx, Dimension::Force);
    const auto fy = column(table, c.fy, Dimension::Force);
    const auto fz = column(table, c.fz, Dimension::Force);
    const double sign = s_.placement.force_is == "on body" ? 1 : -1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      log.tip.push_back(registration_.motion({x[i], y[i], z[i]}));
      log.force.push_back(registration_.motion.rotate(sign * Vec3{fx[i], fy[i], fz[i]}));
    }
    return log;
  }

  void read_robot(const RobotFileSection& robot) {
    const fs::path file = path_of(robot.file);
    const m::CsvTable table = m::read_table(file, robot.choice, declared_, wanted_of_robot());
    m::RobotSettings settings;
    settings.press = press_settings(robot.cycle);
    settings.placement_tolerance = s_.placement.tolerance;
    settings.lateral_samples = s_.path.lateral_samples;
    settings.centre_to_tip = s_.tool.reference == "centre" ? s_.tool.radius : 0;
    const m::RobotCurves curves = m::analyse_robot_log(robot_log(file, table), *body_, settings);
    check_depth(file.string(), curves.press);
    warn_of_drift(robot.file, curves.press);
    add_account(robot.file, table, curves.site.vertex, curves.site.distance, curves.press);
    records_.back()["tilt_rad"] = curves.tilt;
    records_.back()["touch_m"] = curves.touch;
    if (curves.drag) {
      records_.back()["drag"] = {{"lateral_depth_m", curves.drag->lateral_depth},
                                 {"travel_m", curves.drag->travel.back()},
                                 {"slip_at_m", json_number(curves.drag->slip)}};
      sites_[curves.site.vertex].drags.push_back(*curves.drag);
    }
    sites_[curves.site.vertex].presses.push_back(curves.press);
    add_file(file);
  }

  void read_batch(const BatchFileSection& batch) {
    const RecordReader reader(sidecar_file_);
    const fs::path file = reader.path_of(batch.file);
    const m::CsvTable table = reader.table(batch);
    for (const m::BatchSite& site : reader.batch(batch, table)) {
      const std::string where = batch.file + ", " + site.name;
      const m::NearestSite near =
          m::nearest_site(*body_, site.contact, s_.placement.tolerance, where);
      check_depth(where, site.press);
      warn_of_drift(where, site.press);
      warn_of_lateral(where, site);
      add_account(batch.file, table, near.vertex, near.distance, site.press);
      Json& record = records_.back();
      record["site"] = site.name;
      record["touch_m"] = site.contact;
      record["outward"] = site.outward;
      record["lateral_fraction"] = site.lateral_fraction;
      record["sideways_m"] = site.sideways;
      sites_[near.vertex].presses.push_back(site.press);
    }
    add_file(file);
  }

  /// Only the part of the force along the press becomes a curve.
  void warn_of_lateral(const std::string& where, const m::BatchSite& site) {
    constexpr double kMuch = 0.25;
    if (site.lateral_fraction > kMuch) {
      warn(
          fmt::format("{}: {} of the normal force acts across the normal at the deepest point, "
                      "and is in no curve: check the normal",
                      where, percent_text(site.lateral_fraction)));
    }
    const double depth = site.press.loading.back().depth;
    if (site.sideways > kMuch * depth) {
      warn(fmt::format("{}: the tool moves {} across the normal, and {} along it", where,
                       length_text(site.sideways), length_text(depth)));
    }
  }

  void add_account(const std::string& file, const m::CsvTable& table, int vertex, double distance,
                   const m::PressCurve& curve) {
    const m::Baseline& b = curve.baseline;
    const double returned =
        curve.work_loading > 0 ? curve.work_returned / curve.work_loading : kUnknown;
    records_.push_back({{"file", file},
                        {"vertex", vertex},
                        {"distance_to_vertex_m", distance},
                        {"preamble", table.preamble},
                        {"cycles", curve.cycles},
                        {"cycle", curve.cycle},
                        {"contact_m", curve.contact.displacement},
                        {"contact_uncertainty_m", curve.contact.uncertainty},
                        {"force_offset_N", b.offset},
                        {"drift_N_per_s", b.drift},
                        {"drift_uncertainty_N_per_s", json_number(b.drift_uncertainty)},
                        {"drift", drift_word(b.state)},
                        {"drift_not_excluded_N_per_s", json_number(b.possible_drift)},
                        {"noise_N", b.noise},
                        {"noise_autocorrelation", b.autocorrelation},
                        {"rate_m_per_s", json_number(curve.rate)},
                        {"deepest_m", curve.loading.back().depth},
                        {"largest_force_N", curve.loading.back().force},
                        {"work_loading_J", curve.work_loading},
                        {"returned_fraction", json_number(returned)}});
  }

  Vec3 inward_of(int vertex) const {
    return body_ ? body_->response.inward[static_cast<std::size_t>(vertex)] : kDown;
  }

  static std::string where_of(int vertex) { return fmt::format("site at vertex {}", vertex); }

  /// The one press of a site, sample by sample.
  CurvePath recorded_press(int vertex, const SiteRecords& records) const {
    if (records.presses.size() > 1) {
      throw Error(ErrorKind::Configuration, where_of(vertex),
                  fmt::format("{} presses have it as their nearest site, and samples as recorded "
                              "are not averaged",
                              records.presses.size()),
                  "give path.samples instead of as_recorded");
    }
    const MachineSection& machine = s_.machine;
    return m::recorded_path(
        records.presses.front(), inward_of(vertex),
        {machine.force_noise, machine.force_calibration, machine.compliance_uncertainty},
        where_of(vertex));
  }

  /// The mean press of a site, and its drags or the lateral path that is made for want of them.
  SiteCurves curves_of(int vertex, const SiteRecords& records,
                       const m::RepeatSettings& settings) const {
    SiteCurves site;
    site.vertex = vertex;
    site.status = SiteStatus::Complete;
    site.paths.push_back(s_.path.as_recorded ? recorded_press(vertex, records)
                                             : m::mean_path(records.presses, inward_of(vertex),
                                                            settings, where_of(vertex)));
    if (records.drags.empty() && s_.path.lateral_ratio > 0)
      site.paths.push_back(m::lateral_from_normal(site.paths.front(), s_.path.lateral_ratio));
    for (CurvePath& path : m::lateral_paths(records.drags, inward_of(vertex),
                                            {s_.path.lateral_samples, s_.machine.force_calibration},
                                            fmt::format("drags of the site at vertex {}", vertex)))
      site.paths.push_back(std::move(path));
    return site;
  }

  Curves curves() {
    Curves curves;
    curves.tool = {s_.tool.shape, s_.tool.radius, s_.tool.friction};
    if (body_) curves.body_sha256 = sha256_of_file(body_file_);
    const m::RepeatSettings settings{s_.path.samples, s_.machine.force_calibration,
                                     s_.machine.compliance_uncertainty};
    for (const auto& entry : sites_) {
      SiteCurves site;
      const bool usable = attempt(fmt::format("site {}", entry.first),
                                  [&] { site = curves_of(entry.first, entry.second, settings); });
      if (!usable) continue;
      for (const CurvePath& path : site.paths) {
        double& reach = path.kind == PathKind::Normal ? curves.depth : curves.lateral_travel;
        reach = std::max(reach, path.samples.back().displacement);
      }
      warn_of_doubt(site);
      curves.sites.push_back(std::move(site));
    }
    curves.provenance = provenance();
    return curves;
  }

  Provenance provenance() const {
    Provenance provenance;
    if (body_) provenance = body_->provenance;
    std::ifstream stream(sidecar_file_, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    std::vector<fs::path> inputs{sidecar_file_};
    if (body_) inputs.push_back(body_file_);
    inputs.insert(inputs.end(), files_.begin(), files_.end());
    provenance.steps.push_back(make_provenance_step("import", text.str(), inputs,
                                                    {{"origin", "measured"},
                                                     {"measurement", s_.name},
                                                     {"specimen", s_.specimen},
                                                     {"source", s_.source},
                                                     {"licence", s_.licence},
                                                     {"instrument", s_.instrument},
                                                     {"date", s_.date},
                                                     {"records", std::to_string(records_.size())},
                                                     {"lateral", lateral_fact()}}));
    return provenance;
  }

  std::string lateral_fact() const {
    if (s_.path.lateral_ratio == 0) return "measured where a drag was recorded, else none";
    return fmt::format("measured where a drag was recorded, else {} of the normal stiffness",
                       s_.path.lateral_ratio);
  }

  static Json end_account(const CurvePath& path) {
    const CurveSample& end = path.samples.back();
    return {{"repeats", path.repeats},
            {"contact_uncertainty_m", json_number(path.contact_uncertainty)},
            {"force_N", dot(end.force, path.direction)},
            {"force_scatter_N", json_number(end.force_scatter)},
            {"force_uncertainty_N", json_number(end.force_uncertainty)}};
  }

  static Json sites_account(const Curves& curves) {
    Json sites = Json::array();
    for (const SiteCurves& site : curves.sites) {
      const CurvePath& normal = site.paths.front();
      Json account = {{"vertex", site.vertex}, {"depth_m", normal.samples.back().displacement}};
      account.update(end_account(normal));
      Json lateral = Json::array();
      for (std::size_t i = 1; i < site.paths.size(); ++i) {
        const CurvePath& path = site.paths[i];
        Json entry = {{"lateral_depth_m", path.lateral_depth},
                      {"travel_m", path.samples.back().displacement},
                      {"direction", path.direction}};
        entry.update(end_account(path));
        lateral.push_back(entry);
      }
      account["lateral_paths"] = lateral;
      sites.push_back(account);
    }
    return sites;
  }

  fs::path sidecar_file_, body_file_;
  Sidecar s_;
  std::optional<Body> body_;
  std::vector<m::DeclaredColumn> declared_;
  m::Registration registration_;
  std::map<int, SiteRecords> sites_;
  std::vector<fs::path> files_;
  Json account_ = Json::object(), records_ = Json::array(), warnings_ = Json::array();
  Json refused_ = Json::array();
  std::optional<Error> first_refusal_;
};

}  // namespace

Import import_measurement(const fs::path& sidecar_file, const fs::path& body_file,
                          const std::vector<fs::path>& records) {
  Importer importer(sidecar_file, body_file);
  if (!records.empty()) importer.restrict_to(records);
  return importer.run();
}

Histories import_histories(const fs::path& sidecar_file) {
  return Importer(sidecar_file, {}).histories(false);
}

}  // namespace palpate::app
