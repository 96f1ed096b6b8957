// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "app/json_number.hpp"
#include "app/measured/import_account.hpp"
#include "app/measured/record_checks.hpp"
#include "app/measured/record_reader.hpp"
#include "app/measured/site_records.hpp"
#include "fitting/measurement/records/placement.hpp"
#include "fitting/measurement/records/robot.hpp"
#include "fitting/measurement/relaxation/before_relaxing.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "format/to_index.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
namespace m = palpate::measured;
using Json = nlohmann::ordered_json;

constexpr Vec3 kDown{0, 0, -1};

class Importer {
 public:
  Importer(const fs::path& sidecar_file, const fs::path& body_file, const std::string& tool)
      : sidecar_file_(sidecar_file),
        body_file_(body_file),
        reader_(sidecar_file, tool),
        s_(reader_.sidecar()),
        body_(body_file.empty() ? std::nullopt : std::optional(read_body(body_file))),
        checks_(s_, body_) {
    if (body_ && !std::isfinite(s_.placement.tolerance))
      s_.placement.tolerance = tolerance_on(*body_, s_.tool.radius);
    place_frame();
  }

  /// Leaves out what is not among these files, and refuses what the sidecar does not name.
  void restrict_to(const std::vector<fs::path>& records) {
    std::map<fs::path, bool> named;
    for (const fs::path& record : records) named[fs::weakly_canonical(record)] = false;
    const auto is_left_out = [&](const auto& section) {
      const auto found = named.find(fs::weakly_canonical(reader_.path_of(section.file)));
      if (found == named.end()) return true;
      found->second = true;
      return false;
    };
    std::erase_if(s_.presses, is_left_out);
    std::erase_if(s_.robot_logs, is_left_out);
    std::erase_if(s_.batches, is_left_out);
    std::erase_if(s_.histories, is_left_out);
    for (const auto& [record, known] : named) {
      if (known) continue;
      put_off(record.string(),
              Error(ErrorKind::Configuration, record.string(),
                    "the sidecar " + sidecar_file_.string() + " does not name it",
                    "add it as `file`, or a pattern as `files`, of a section of the "
                    "sidecar"));
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
    if (const std::string text = reader_.conversion(); !text.empty()) account_["conversion"] = text;
    account_["records"] = records_;
    account_["warnings"] = checks_.warnings();
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
  /// @param site  of a batch; empty: the whole record.
  void put_off(const std::string& what, const Error& error, const std::string& site = {}) {
    if (!first_refusal_) first_refusal_ = error;
    refused_.push_back({{"file", what}, {"reason", error.what()}});
    if (!site.empty()) refused_.back()["site"] = site;
  }

  /// A record that is wrong, or a site of a batch, does not take the others with it.
  template <class Work>
  bool attempt(const std::string& what, Work work, const std::string& site = {}) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Configuration) throw;
      put_off(what, error, site);
      return false;
    }
  }

  void place_frame() {
    if (s_.robot_logs.empty() && s_.batches.empty()) return;
    if (!body_) {
      throw Error(ErrorKind::Configuration, sidecar_file_.string(),
                  "robot logs are placed on a body, and none is given",
                  "add --body body.h5 (made by `palpate mesh`)");
    }
    if (s_.placement.frame == "body") return;
    account_["registration_rms_m"] = reader_.registration().rms;
  }

  template <class Section>
  PlacedAt place_of(const Section& press) const {
    const std::string where = reader_.path_of(press.file).string();
    if (press.vertex < 0) {
      if (!body_) {
        throw Error(ErrorKind::Configuration, where, "a site given by its point needs a body",
                    "add --body body.h5 (made by `palpate mesh`), or give a vertex");
      }
      const m::NearestSite site =
          m::nearest_site(*body_, press.site, s_.placement.tolerance, where);
      return {site.vertex, site.distance};
    }
    if (!body_) return {press.vertex, 0};
    const auto vertex = static_cast<std::size_t>(press.vertex);
    if (vertex >= body_->response.node.size() || body_->response.is_site[vertex] == 0) {
      throw Error(ErrorKind::Configuration, where,
                  fmt::format("vertex {} is not a site of the body", press.vertex),
                  "choose a vertex outside the supports");
    }
    return {press.vertex, 0};
  }

  /// The curve at its site, its account and its doubts.
  void take(const std::string& file, const std::string& where, const m::CsvTable& table,
            const PlacedAt& place, const m::PressCurve& curve) {
    checks_.check_depth(reader_.path_of(where).string(), curve);
    checks_.check_stiffness(where, curve);
    checks_.check_range(where, curve);
    checks_.check_drift(where, curve);
    const m::PressCurve press = reader_.before_relaxing(curve, where);
    std::vector<m::PressCurve>& presses = records_at(place.vertex).presses;
    check_new(presses, press, reader_.path_of(where).string());
    presses.push_back(press);
    records_.push_back(press_account(file, table, place, curve));
    add_file(reader_.path_of(file));
  }

  /// A copy would count as a repeat, and tell nothing of the scatter.
  static void check_new(const std::vector<m::PressCurve>& presses, const m::PressCurve& press,
                        const std::string& where) {
    const auto same = [](const m::DepthForce& a, const m::DepthForce& b) {
      return a.depth == b.depth && a.force == b.force;
    };
    for (const m::PressCurve& other : presses)
      if (std::equal(other.loading.begin(), other.loading.end(), press.loading.begin(),
                     press.loading.end(), same))
        throw Error(ErrorKind::Configuration, where,
                    "has the samples of another record at its site: it is a copy, not a repeat",
                    "name each record once");
  }

  SiteRecords& records_at(int vertex) {
    SiteRecords& records = sites_[vertex];
    records.vertex = vertex;
    records.inward = body_ ? body_->response.inward[to_index(vertex)] : kDown;
    return records;
  }

  void read_press(const PressFileSection& press) {
    const m::CsvTable table = reader_.table(press);
    const PlacedAt place = place_of(press);
    take(press.file, press.file, table, place, reader_.press(press, table));
  }

  SiteHistory read_history(const HistoryFileSection& section, bool placed) {
    SiteHistory site;
    site.history = reader_.history(section);
    checks_.check_range(section.file, site.history);
    if (placed && (section.vertex >= 0 || std::isfinite(section.site[0])))
      site.vertex = place_of(section).vertex;
    add_file(reader_.path_of(section.file));
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

  /// A file of several tables is one input.
  void add_file(const fs::path& file) {
    if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
  }

  void read_robot(const RobotFileSection& robot) {
    const m::CsvTable table = reader_.table(robot);
    m::RobotSettings settings;
    settings.press = reader_.press_settings(robot.cycle);
    settings.placement_tolerance = s_.placement.tolerance;
    settings.lateral_samples = s_.path.lateral_samples;
    settings.centre_to_tip = s_.tool.reference == "centre" ? s_.tool.radius : 0;
    const m::RobotCurves curves =
        m::analyse_robot_log(reader_.robot_log(robot, table), *body_, settings);
    take(robot.file, robot.file, table, {curves.site.vertex, curves.site.distance}, curves.press);
    Json& record = records_.back();
    record["tilt_rad"] = curves.tilt;
    record["touch_m"] = curves.touch;
    if (!curves.drag) return;
    record["drag"] = {{"lateral_depth_m", curves.drag->lateral_depth},
                      {"travel_m", curves.drag->travel.back()},
                      {"slip_at_m", json_number(curves.drag->slip)}};
    records_at(curves.site.vertex).drags.push_back(*curves.drag);
  }

  void read_batch(const BatchFileSection& batch) {
    const m::CsvTable table = reader_.table(batch);
    const m::Batch read = reader_.batch(batch, table);
    for (const m::RefusedSite& site : read.refused) put_off(batch.file, site.reason, site.name);
    for (const m::BatchSite& site : read.sites)
      attempt(
          batch.file, [&] { take_site(batch.file, table, site); }, site.name);
  }

  void take_site(const std::string& file, const m::CsvTable& table, const m::BatchSite& site) {
    const std::string where = file + ", " + site.name;
    const m::NearestSite near =
        m::nearest_site(*body_, site.contact, s_.placement.tolerance, where);
    take(file, where, table, {near.vertex, near.distance}, site.press);
    checks_.check_lateral(where, site);
    Json& record = records_.back();
    record["site"] = site.name;
    record["touch_m"] = site.contact;
    record["outward"] = site.outward;
    record["lateral_fraction"] = site.lateral_fraction;
    record["sideways_m"] = site.sideways;
  }

  Curves curves() {
    Curves curves;
    curves.tool = {s_.tool.shape, s_.tool.radius, s_.tool.friction};
    if (body_) curves.body_sha256 = sha256_of_file(body_file_);
    if (!s_.path.relaxation.empty())
      curves.relaxation = over_one_list({s_.path.relaxation}, sidecar_file_.string());
    for (const auto& entry : sites_) {
      SiteCurves site;
      const bool usable = attempt(fmt::format("site {}", entry.first),
                                  [&] { site = site_curves(entry.second, s_); });
      if (!usable) continue;
      if (!curves.relaxation.empty()) m::let_relax(site);
      for (const CurvePath& path : site.paths) {
        double& reach = path.kind == PathKind::Normal ? curves.depth : curves.lateral_travel;
        reach = std::max(reach, path.samples.back().displacement);
      }
      checks_.check_force(site);
      checks_.check_samples(site);
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
                                                     {"refused", std::to_string(refused_.size())},
                                                     {"lateral", lateral_fact()}}));
    return provenance;
  }

  std::string lateral_fact() const {
    if (s_.path.lateral_ratio == 0) return "measured where a drag was recorded, else none";
    return fmt::format("measured where a drag was recorded, else {} of the normal stiffness",
                       s_.path.lateral_ratio);
  }

  fs::path sidecar_file_, body_file_;
  RecordReader reader_;
  Sidecar s_;  ///< less what restrict_to leaves out
  std::optional<Body> body_;
  RecordChecks checks_;
  std::map<int, SiteRecords> sites_;
  std::vector<fs::path> files_;
  Json account_ = Json::object(), records_ = Json::array(), refused_ = Json::array();
  std::optional<Error> first_refusal_;
};

}  // namespace

Import import_measurement(const fs::path& sidecar_file, const fs::path& body_file,
                          const std::vector<fs::path>& records, const std::string& tool) {
  Importer importer(sidecar_file, body_file, tool);
  if (!records.empty()) importer.restrict_to(records);
  return importer.run();
}

Histories import_histories(const fs::path& sidecar_file) {
  return Importer(sidecar_file, {}, {}).histories(false);
}

}  // namespace palpate::app
