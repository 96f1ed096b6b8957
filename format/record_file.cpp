// SPDX-License-Identifier: Apache-2.0
#include "format/record_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "format/disk_error.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"

namespace palpate {

namespace fs = std::filesystem;

std::string record_of(std::string_view payload) {
  const auto length = static_cast<std::uint32_t>(payload.size());
  std::string record(sizeof length, '\0');
  std::memcpy(record.data(), &length, sizeof length);
  return record.append(payload).append(sha256(payload));
}

bool take_record(std::string_view& bytes, std::string_view& payload) {
  std::uint32_t length = 0;
  if (bytes.size() < sizeof length) return false;
  std::memcpy(&length, bytes.data(), sizeof length);
  const std::string_view rest = bytes.substr(sizeof length);
  if (rest.size() < length + kDigestDigits) return false;
  if (sha256(rest.substr(0, length)) != rest.substr(length, kDigestDigits)) return false;
  payload = rest.substr(0, length);
  bytes = rest.substr(length + kDigestDigits);
  return true;
}

RecordFile::RecordFile(const fs::path& path, const char* busy, const char* remedy) : path_(path) {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw_disk_error(path_, "cannot be opened", errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int problem = errno;
  ::close(std::exchange(descriptor_, -1));
  if (problem != EWOULDBLOCK) throw_disk_error(path_, "cannot be locked", problem);
  throw Error(ErrorKind::Configuration, path_.string(), busy, remedy);
}

RecordFile::~RecordFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

RecordFile::RecordFile(RecordFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      end_(other.end_) {}

RecordFile& RecordFile::operator=(RecordFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(end_, other.end_);
  return *this;
}

void RecordFile::cut(std::uint64_t end) {
  if (::ftruncate(descriptor_, static_cast<off_t>(end)) != 0)
    throw_disk_error(path_, "cannot be shortened", errno);
  end_ = end;
}

void RecordFile::refuse(const char* action) {
  const int problem = errno;
  // If even this fails, the next reader drops the broken record.
  [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(end_));
  throw_disk_error(path_, action, problem);
}

void RecordFile::write_behind_end(std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                                     static_cast<off_t>(end_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse("cannot be written");
    done += static_cast<std::size_t>(written);
  }
}

void RecordFile::append(std::string_view bytes) {
  write_behind_end(bytes);
  end_ += bytes.size();
}

void RecordFile::append_durably(std::string_view bytes) {
  write_behind_end(bytes);
  if (::fdatasync(descriptor_) != 0) refuse("cannot be put on the disk");
  end_ += bytes.size();
}

void RecordFile::synchronize() {
  if (::fdatasync(descriptor_) != 0) throw_disk_error(path_, "cannot be put on the disk", errno);
}

void RecordFile::remove() {
  if (::unlink(path_.c_str()) != 0) throw_disk_error(path_, "cannot be removed", errno);
}

void RecordFile::rename(const fs::path& to) {
  if (::rename(path_.c_str(), to.c_str()) != 0) throw_disk_error(path_, "cannot be renamed", errno);
  path_ = to;
}

}  // namespace palpate
