// SPDX-License-Identifier: Apache-2.0
#include "format/disk_error.hpp"

#include <fcntl.h>
#if !defined(_WIN32)
#include <unistd.h>
#endif

#include <cerrno>
#include <string>
#include <system_error>

#include "format/error.hpp"

namespace palpate {
namespace {

struct Refusal {
  ErrorKind kind;
  const char* remedy;
};

Refusal refusal_of(int error_number) {
  switch (error_number) {
    case ENOSPC:
#if defined(EDQUOT)  // Windows has no quotas of this kind
    case EDQUOT:
#endif
      return {ErrorKind::Internal, "free some space or name a folder on another disk"};
    case EFBIG:
      return {ErrorKind::Internal, "raise the file size limit (ulimit -f) or name another disk"};
    case EIO:
      return {ErrorKind::Internal, "check the disk, then run again"};
    case EACCES:
    case EPERM:
    case EROFS:
      return {ErrorKind::Configuration, "name a folder you may write to"};
    case ENOENT:
    case ENOTDIR:
      return {ErrorKind::Configuration, "correct the path, or create its folder"};
    case ENAMETOOLONG:
      return {ErrorKind::Configuration, "choose a shorter file name"};
    default:
      return {ErrorKind::Internal, "remove the cause, then run again"};
  }
}

}  // namespace

void throw_disk_error(const std::filesystem::path& file, const char* action, int error_number) {
  const Refusal refusal = refusal_of(error_number);
  throw Error(refusal.kind, file.string(),
              std::string(action) + " (" + std::generic_category().message(error_number) + ")",
              refusal.remedy);
}

#if defined(_WIN32)
int sync_folder_of(const std::filesystem::path&) {
  return 0;  // a folder is put on the disk with the rename
}
#else
int sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int result = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // Some file systems cannot sync a folder; the rename itself is still atomic there.
  return result == EINVAL ? 0 : result;
}
#endif

}  // namespace palpate
