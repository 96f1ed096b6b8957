// SPDX-License-Identifier: Apache-2.0
#include "format/session_journal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string_view>

#include "format/bytes.hpp"
#include "format/disk_error.hpp"
#include "format/error.hpp"
#include "format/regular_file.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "palpate.session 1\n";
constexpr const char* kJournalRemedy = "name the journal of a session of this version of palpate";
constexpr const char* kAsideRemedy = "move it away, or name another recording with --out";
constexpr std::size_t kStepBytes = 21 * sizeof(double);  // 14 columns
constexpr std::size_t kTextLength = sizeof(std::uint32_t);
constexpr std::size_t kLargestRecord = 1U << 30;             // bytes: a length beyond it is damage
constexpr std::size_t kFrame = kTextLength + kDigestDigits;  // bytes of a record besides its steps
constexpr std::size_t kWindow = 1U << 20;                    // bytes searched at a time

void put(ByteWriter& out, const SessionSettings& s) {
  for (const double value :
       {s.tank_cap, s.lipschitz_bound, s.search_rate, s.ramp, s.watchdog, s.max_force, s.max_speed})
    out.put(value);
  out.put(s.body_position);
  out.put(static_cast<std::uint8_t>(s.guarded ? 1 : 0));
}

SessionSettings settings_of(ByteReader& in) {
  SessionSettings s;
  for (double* value : {&s.tank_cap, &s.lipschitz_bound, &s.search_rate, &s.ramp, &s.watchdog,
                        &s.max_force, &s.max_speed})
    *value = in.get<double>();
  s.body_position = in.vector();
  s.guarded = in.get<std::uint8_t>() != 0;
  return s;
}

void put(ByteWriter& out, const ProvenanceStep& step) {
  for (const std::string* text :
       {&step.stage, &step.version, &step.git_revision, &step.utc, &step.resolved_case})
    out.put(*text);
  out.put(static_cast<std::uint32_t>(step.inputs.size()));
  for (const InputDigest& input : step.inputs) {
    out.put(input.name);
    out.put(input.sha256);
  }
  out.put(static_cast<std::uint32_t>(step.facts.size()));
  for (const auto& [name, value] : step.facts) {
    out.put(name);
    out.put(value);
  }
}

ProvenanceStep provenance_step_of(ByteReader& in) {
  ProvenanceStep step;
  for (std::string* text :
       {&step.stage, &step.version, &step.git_revision, &step.utc, &step.resolved_case})
    *text = in.text();
  step.inputs.resize(in.count(2 * kTextLength));
  for (InputDigest& input : step.inputs) {
    input.name = in.text();
    input.sha256 = in.text();
  }
  step.facts.resize(in.count(2 * kTextLength));
  for (auto& [name, value] : step.facts) {
    name = in.text();
    value = in.text();
  }
  return step;
}

std::string heading_bytes(const RecordingHeading& heading) {
  ByteWriter out;
  out.put(heading.device);
  out.put(heading.library_sha256);
  out.put(heading.rate);
  out.put(heading.friction);
  put(out, heading.settings);
  out.put(static_cast<std::uint32_t>(heading.provenance.steps.size()));
  for (const ProvenanceStep& step : heading.provenance.steps) put(out, step);
  return std::move(out.bytes);
}

RecordingHeading heading_of(ByteReader in) {
  RecordingHeading heading;
  heading.device = in.text();
  heading.library_sha256 = in.text();
  heading.rate = in.get<double>();
  heading.friction = in.get<double>();
  heading.settings = settings_of(in);
  heading.provenance.steps.resize(in.count(7 * kTextLength));
  for (ProvenanceStep& step : heading.provenance.steps) step = provenance_step_of(in);
  in.expect_end();
  return heading;
}

/// The columns of recording.h5 in their order.
void put(ByteWriter& out, const RecordedStep& s) {
  out.put(s.time_ns);
  out.put(s.position);
  out.put(s.velocity);
  out.put(s.force);
  out.put(s.contact_point);
  for (const double value : {s.depth, s.lateral, s.offset, s.energy, s.tank, s.absorbed})
    out.put(value);
  out.put(s.element);
  out.put(s.status);
  out.put(s.latency_ns);
}

RecordedStep step_of(ByteReader& in) {
  RecordedStep s;
  s.time_ns = in.get<std::int64_t>();
  s.position = in.vector();
  s.velocity = in.vector();
  s.force = in.vector();
  s.contact_point = in.vector();
  for (double* value : {&s.depth, &s.lateral, &s.offset, &s.energy, &s.tank, &s.absorbed})
    *value = in.get<double>();
  s.element = in.get<std::int32_t>();
  s.status = in.get<std::uint32_t>();
  s.latency_ns = in.get<std::int64_t>();
  return s;
}

/// The next whole record of a file of which `left` bytes are not read yet; false when there is
/// none.
bool read_record(std::ifstream& file, std::uint64_t left, std::string& record) {
  std::uint32_t length = 0;
  char raw[sizeof length];
  if (left < sizeof length || !file.read(raw, sizeof raw)) return false;
  std::memcpy(&length, raw, sizeof length);
  const std::size_t rest = std::size_t{length} + kDigestDigits;
  if (length > kLargestRecord || left - sizeof length < rest) return false;
  record.assign(raw, sizeof raw);
  record.resize(sizeof raw + rest);
  return static_cast<bool>(
      file.read(record.data() + sizeof raw, static_cast<std::streamsize>(rest)));
}

/// The payload of the next whole record; false when there is none.
bool next_payload(std::ifstream& file, std::uint64_t left, std::string& payload,
                  std::uint64_t& taken) {
  std::string record;
  if (!read_record(file, left, record)) return false;
  std::string_view rest = record;
  std::string_view inside;
  if (!take_record(rest, inside)) return false;
  taken = record.size();
  payload = std::string(inside);
  return true;
}

std::ifstream open(const fs::path& path) {
  require_regular_file(path, kJournalRemedy);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_disk_error(path, "cannot be read", errno);
  return file;
}

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Is there a whole record of steps at byte `at`? Its length and the digits of its digest are
/// looked at before anything is hashed.
bool is_record_of_steps(std::ifstream& file, std::uint64_t at, std::uint64_t size,
                        std::size_t length) {
  if (length == 0 || length % kStepBytes != 0 || length > kLargestRecord) return false;
  if (size - at < length + kFrame) return false;
  std::string digest(kDigestDigits, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(at + kTextLength + length));
  if (!file.read(digest.data(), kDigestDigits) || !is_hexadecimal(digest)) return false;
  file.seekg(static_cast<std::streamoff>(at));
  std::string payload;
  std::uint64_t taken = 0;
  return next_payload(file, size - at, payload, taken);
}

/// The first byte from `from` on at which a whole record of steps begins.
std::optional<std::uint64_t> find_record(std::ifstream& file, std::uint64_t from,
                                         std::uint64_t size) {
  std::string window;
  for (std::uint64_t start = from; start + kFrame < size; start += kWindow) {
    window.resize(std::min<std::uint64_t>(kWindow + kTextLength - 1, size - start));
    file.clear();
    file.seekg(static_cast<std::streamoff>(start));
    if (!file.read(window.data(), static_cast<std::streamsize>(window.size()))) return {};
    for (std::size_t i = 0; i + kTextLength <= window.size(); ++i) {
      std::uint32_t length = 0;
      std::memcpy(&length, window.data() + i, kTextLength);
      if (is_record_of_steps(file, start + i, size, length)) return start + i;
    }
  }
  return {};
}

/// Is this what a session leaves that ends while it writes: the front of a record of steps, or too
/// little for one step?
bool is_cut_short(std::ifstream& file, std::uint64_t at, std::uint64_t size) {
  if (size - at < kFrame + kStepBytes) return true;
  std::uint32_t length = 0;
  char raw[sizeof length];
  file.clear();
  file.seekg(static_cast<std::streamoff>(at));
  if (!file.read(raw, sizeof raw)) return false;
  std::memcpy(&length, raw, sizeof length);
  return length > 0 && length % kStepBytes == 0 && length <= kLargestRecord &&
         size - at < length + kFrame;
}

/// Steps of the whole records that took so many bytes, each at least one; none where the bytes are
/// not those of whole records. k records of n steps take 68 k + 168 n bytes, which tells k up to
/// a multiple of 42: the fewest records are taken.
std::optional<std::uint64_t> steps_in(std::uint64_t bytes) {
  for (std::uint64_t k = 1; k * (kFrame + kStepBytes) <= bytes; ++k)
    if (const std::uint64_t rest = bytes - k * kFrame; rest % kStepBytes == 0)
      return rest / kStepBytes;
  return {};
}

/// What a crash right after the beginning may leave: less than a heading, and no steps.
bool is_without_heading(const fs::path& path) {
  std::ifstream file = open(path);
  const std::uint64_t size = fs::file_size(path);
  std::string first(kFirstLine.size(), '\0');
  file.read(first.data(), static_cast<std::streamsize>(first.size()));
  first.resize(static_cast<std::size_t>(file.gcount()));
  if (!kFirstLine.starts_with(first)) return false;
  std::string payload;
  std::uint64_t taken = 0;
  if (!file) return true;
  return !next_payload(file, size - first.size(), payload, taken) &&
         !find_record(file, first.size(), size);
}

}  // namespace

bool is_session_journal(const fs::path& path) {
  std::ifstream file = open(path);
  std::string first(kFirstLine.size(), '\0');
  return file.read(first.data(), static_cast<std::streamsize>(first.size())) && first == kFirstLine;
}

bool holds_session(const fs::path& path) {
  return is_session_journal(path) && !is_without_heading(path);
}

SessionJournal::SessionJournal(const fs::path& path, const RecordingHeading& heading)
    : file_(path, "another palpate is at this session",
            "wait until it ends, or name another recording with --out") {
  if (!is_without_heading(path)) {
    if (!is_session_journal(path))
      refuse(path.string(), "is no journal of a session", kAsideRemedy);
    throw Error(ErrorKind::Configuration, path.string(), "holds another session",
                "make it a recording with `palpate recover " + path.string() + "`");
  }
  file_.cut(0);
  file_.append_durably(std::string(kFirstLine) + record_of(heading_bytes(heading)));
  if (const int problem = sync_folder_of(path); problem != 0)
    throw_disk_error(path, "is made, but its folder cannot be put on the disk", problem);
}

void SessionJournal::append(const std::vector<RecordedStep>& steps) {
  if (steps.empty()) return;
  ByteWriter out;
  out.bytes.reserve(kStepBytes * steps.size());
  for (const RecordedStep& step : steps) put(out, step);
  file_.append(record_of(out.bytes));
  steps_ += steps.size();
}

SessionJournalReader::SessionJournalReader(const fs::path& path)
    : where_(path.string()), file_(open(path)), size_(fs::file_size(path)) {
  std::string first(kFirstLine.size(), '\0');
  if (!file_.read(first.data(), static_cast<std::streamsize>(first.size())) || first != kFirstLine)
    refuse(where_, "is no journal of a session", kJournalRemedy);
  std::string payload;
  std::uint64_t taken = 0;
  if (!next_payload(file_, size_ - first.size(), payload, taken)) {
    if (!find_record(file_, first.size(), size_))
      refuse(where_, "is no journal of a session: it has no steps", kJournalRemedy);
    refuse(where_,
           "its heading is damaged, so the device and the settings of its steps are not known",
           kAsideRemedy);
  }
  heading_ = heading_of({payload, where_, "has a heading that is none", kJournalRemedy});
  good_ = first.size() + taken;
}

bool SessionJournalReader::next(std::vector<RecordedStep>& steps) {
  if (at_end_) return false;
  return take_next(steps) || (pass_damage() && take_next(steps));
}

bool SessionJournalReader::follow(std::vector<RecordedStep>& steps) {
  file_.clear();
  file_.seekg(0, std::ios::end);
  size_ = static_cast<std::uint64_t>(file_.tellg());
  file_.seekg(static_cast<std::streamoff>(good_));
  return take_next(steps);
}

bool SessionJournalReader::take_next(std::vector<RecordedStep>& steps) {
  std::string payload;
  std::uint64_t taken = 0;
  if (!next_payload(file_, size_ - good_, payload, taken)) return false;
  good_ += taken;
  steps.clear();
  ByteReader in(payload, where_, "holds a record that is no steps", kJournalRemedy);
  while (!in.at_end()) steps.push_back(step_of(in));
  close_gap(steps);
  return true;
}

/// To the next whole record, the bytes in between as a gap. @return false when there is none.
bool SessionJournalReader::pass_damage() {
  const auto found = good_ < size_ ? find_record(file_, good_ + 1, size_) : std::nullopt;
  at_end_ = !found;
  if (at_end_ && is_cut_short(file_, good_, size_)) {
    incomplete_ = size_ - good_;
    return false;
  }
  const std::uint64_t end = found.value_or(size_);
  gaps_.push_back({good_, end - good_, steps_in(end - good_), last_time_ns_, std::nullopt});
  good_ = end;
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(good_));
  return !at_end_;
}

/// The steps behind a gap tell when it ends.
void SessionJournalReader::close_gap(const std::vector<RecordedStep>& steps) {
  if (steps.empty()) return;
  last_time_ns_ = steps.back().time_ns;
  if (gaps_.empty() || gaps_.back().until_ns) return;
  gaps_.back().until_ns = steps.front().time_ns;
}

std::string gap_text(const JournalGap& gap) {
  const auto seconds = [](std::int64_t ns) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f s", 1e-9 * static_cast<double>(ns));
    return std::string(text);
  };
  std::string text = gap.steps ? std::to_string(*gap.steps)
                               : "up to " + std::to_string(gap.bytes / kStepBytes + 1);
  text +=
      " steps (" + std::to_string(gap.bytes) + " bytes at byte " + std::to_string(gap.offset) + ")";
  if (gap.since_ns) text += " after " + seconds(*gap.since_ns);
  if (gap.until_ns) text += " before " + seconds(*gap.until_ns);
  return text;
}

SessionSummary summarize_session(const fs::path& journal) {
  SessionJournalReader reader(journal);
  SessionSummary summary;
  summary.heading = reader.heading();
  for (std::vector<RecordedStep> steps; reader.next(steps);) {
    summary.steps += steps.size();
    if (!steps.empty()) summary.last_time_ns = steps.back().time_ns;
  }
  summary.incomplete_bytes = reader.incomplete_bytes();
  summary.gaps = reader.gaps();
  return summary;
}

std::uint64_t write_recording_of(const fs::path& journal, const fs::path& recording,
                                 const Provenance& provenance) {
  const SessionSummary summary = summarize_session(journal);
  RecordingHeading heading = summary.heading;
  heading.provenance = provenance;
  SessionJournalReader reader(journal);
  RecordingWriter writer(recording, heading, summary.steps);
  for (std::vector<RecordedStep> steps; reader.next(steps);) writer.append(steps);
  writer.commit();
  return summary.steps;
}

}  // namespace palpate
