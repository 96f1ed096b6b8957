// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/watch/journal_tail.hpp"

#include <sys/stat.h>

#include <system_error>
#include <vector>

namespace palpate::app {
namespace {

/// The number of the file of this name; 0: there is none.
ino_t number_of(const std::filesystem::path& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? found.st_ino : 0;
}

}  // namespace

/// A file that is read keeps its number: that of another one differs.
bool JournalTail::is_gone() const {
  return number_of(path_) != file_;
}

bool JournalTail::open() {
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored) || !holds_session(path_)) return false;
  const ino_t before = number_of(path_);
  reader_.emplace(path_);
  file_ = number_of(path_);
  if (file_ != before) reader_.reset();  // replaced meanwhile: the next call finds the new one
  return reader_.has_value();
}

SessionNews JournalTail::poll() {
  SessionNews news;
  if (!reader_) {
    if (!open()) return news;
    news.begun = reader_->heading();
  }
  const bool gone = is_gone();  // before reading: what is read then is the whole session
  bool more = true;
  for (std::vector<RecordedStep> steps; news.steps.size() < kMostNews;) {
    more = reader_->follow(steps);
    if (!more) break;
    news.steps.insert(news.steps.end(), steps.begin(), steps.end());
  }
  news.ended = gone && !more;
  if (news.ended) reader_.reset();
  return news;
}

}  // namespace palpate::app
