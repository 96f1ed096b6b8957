// SPDX-License-Identifier: Apache-2.0
#include "format/seal.hpp"

#include <fstream>

#include "format/error.hpp"
#include "format/sha256.hpp"

namespace palpate {
namespace {

constexpr std::string_view kMark = "\npalpate-sha256:";
constexpr std::size_t kDigits = 64;
constexpr std::size_t kSealBytes = kMark.size() + kDigits + 1;

/// The last bytes of a file, as many as a seal has; empty when the file is shorter.
std::string tail_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string tail(kSealBytes, '\0');
  file.seekg(-static_cast<std::streamoff>(kSealBytes), std::ios::end);
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return file ? tail : std::string();
}

}  // namespace

std::string seal_of(std::string_view content) {
  return seal_of_digest(sha256(content));
}

std::string seal_of_digest(std::string_view digest) {
  return std::string(kMark).append(digest).append("\n");
}

void require_unbroken_seal(const std::filesystem::path& file, const std::string& remedy) {
  const std::string tail = tail_of(file);
  if (!tail.starts_with(kMark) || !tail.ends_with('\n')) return;
  const std::string_view digits = std::string_view(tail).substr(kMark.size(), kDigits);
  if (sha256_of_file(file, std::filesystem::file_size(file) - kSealBytes) == digits) return;
  throw Error(ErrorKind::Configuration, file.string(),
              "is damaged: its content is not what was written (the SHA-256 at its end differs)",
              "copy it again from its source, or " + remedy);
}

}  // namespace palpate
