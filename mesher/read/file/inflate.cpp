// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/inflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/file.hpp"

namespace palpate::mesher {
namespace {

constexpr int kDetectHeader = 15 + 32;  // zlib: largest window, zlib and gzip headers

class Stream {
 public:
  Stream(std::string_view packed, const std::string& where) : where_(where) {
    if (packed.size() > std::numeric_limits<uInt>::max()) {
      refuse_geometry(where, "a compressed block of more than 4 GiB", "store it uncompressed");
    }
    // zlib does not write through next_in.
    state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    state_.avail_in = static_cast<uInt>(packed.size());
    if (inflateInit2(&state_, kDetectHeader) != Z_OK) fail();
  }
  ~Stream() { inflateEnd(&state_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Fills the buffer as far as the stream reaches. @return the bytes written
  std::size_t read(char* buffer, std::size_t size) {
    const auto wanted = static_cast<uInt>(std::min<std::size_t>(size, 1U << 30U));
    state_.next_out = reinterpret_cast<Bytef*>(buffer);
    state_.avail_out = wanted;
    const int result = inflate(&state_, Z_NO_FLUSH);
    ended_ = result == Z_STREAM_END;
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) fail();
    return wanted - state_.avail_out;
  }
  bool ended() const { return ended_; }
  /// Goes on with the next member of a gzip stream, if there is one.
  bool next_member() {
    if (state_.avail_in == 0) return false;
    ended_ = false;
    if (inflateReset(&state_) != Z_OK) fail();
    return true;
  }
  [[noreturn]] void fail() const {
    refuse_geometry(
        where_,
        text("the compressed data are damaged", state_.msg ? text(" (", state_.msg, ")") : ""),
        kDamagedFile);
  }

 private:
  z_stream state_{};
  const std::string& where_;
  bool ended_ = false;
};

}  // namespace

std::string inflate_exactly(std::string_view packed, std::size_t size, const std::string& where) {
  if (size > most_inflated(packed.size())) {
    refuse_geometry(where, text(packed.size(), " compressed bytes cannot hold ", size),
                    kDamagedFile);
  }
  Stream stream(packed, where);
  std::string bytes(size, '\0');
  for (std::size_t done = 0; done < size;) {
    const std::size_t more = stream.read(bytes.data() + done, size - done);
    done += more;
    const bool goes_on = stream.ended() ? stream.next_member() : more > 0;
    if (done < size && !goes_on) {
      refuse_geometry(where, text("the compressed data hold ", done, " of ", size, " bytes"),
                      kDamagedFile);
    }
  }
  return bytes;
}

}  // namespace palpate::mesher
