// SPDX-License-Identifier: Apache-2.0
// The deformed skin of the C interface.
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "format/deformation.hpp"
#include "format/regular_file.hpp"
#include "runtime/c_boundary.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "runtime/skin_deformation.hpp"

struct palpate_deformation {
  palpate_deformation(const palpate_library& of, palpate::Deformation&& data)
      : library(&of), skin(std::move(data), of.triangles) {}

  const palpate_library* library;
  palpate::runtime::SkinDeformation skin;
};

namespace {

using palpate::runtime::fail;
using palpate::runtime::give;
using palpate::runtime::give_array;
using palpate::runtime::guarded;

constexpr std::uint32_t kFirstInfo = sizeof(palpate_deformation_info);

int take(const palpate_library& library, palpate::Deformation&& data, const std::string& name,
         palpate_deformation** deformation) {
  if (data.surface != palpate::surface_digest(library.positions, library.triangles)) {
    return fail(PALPATE_ERROR_MISMATCH,
                (name + ": belongs to another library; load the one beside it").c_str());
  }
  *deformation = new palpate_deformation(library, std::move(data));
  return PALPATE_OK;
}

}  // namespace

extern "C" {

int palpate_deformation_load(const palpate_library* library, const char* path,
                             palpate_deformation** deformation) {
  if (deformation == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_deformation_load: deformation is null");
  *deformation = nullptr;
  if (library == nullptr || path == nullptr || *path == '\0') {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_deformation_load: library is null, or path is null or empty");
  }
  return guarded(PALPATE_ERROR_FORMAT, [&] {
    const std::string name = path;
    if (const std::string kind = palpate::other_kind_of_file(path); !kind.empty()) {
      return fail(PALPATE_ERROR_FILE,
                  (name + ": is not a regular file but " + kind + "; name a deformation").c_str());
    }
    if (!std::ifstream(path, std::ios::binary)) {
      return fail(
          PALPATE_ERROR_FILE,
          (name + ": cannot be opened; check path and permissions, or ask for it by depths in "
                  "[deformation] of the case")
              .c_str());
    }
    return take(*library, palpate::read_deformation(name), name, deformation);
  });
}

int palpate_deformation_load_memory(const palpate_library* library, const void* bytes, size_t size,
                                    palpate_deformation** deformation) {
  if (deformation == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_deformation_load_memory: deformation is null");
  *deformation = nullptr;
  if (library == nullptr || bytes == nullptr || size == 0) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_deformation_load_memory: library or bytes is null, or size is 0");
  }
  return guarded(PALPATE_ERROR_FORMAT, [&] {
    const std::string name = "deformation in memory";
    const std::string_view content(static_cast<const char*>(bytes), size);
    return take(*library, palpate::read_deformation(content, name), name, deformation);
  });
}

void palpate_deformation_destroy(palpate_deformation* deformation) {
  delete deformation;
}

int palpate_deformation_describe(const palpate_deformation* deformation,
                                 palpate_deformation_info* info) {
  if (deformation == nullptr || info == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_deformation_describe: null pointer");
  if (info->size < kFirstInfo)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_deformation_describe: set info->size to sizeof");
  const palpate::Deformation& data = deformation->skin.data();
  palpate_deformation_info all{};
  all.vertices = static_cast<std::int32_t>(data.positions.size());
  all.triangles = static_cast<std::int32_t>(data.triangles.size());
  all.sites = static_cast<std::int32_t>(data.sites.size());
  all.modes = static_cast<std::int32_t>(data.mode_count());
  all.depth = data.depths.back();
  all.reach = data.reach;
  give(all, info, info->size);
  return PALPATE_OK;
}

int palpate_deformation_vertices(const palpate_deformation* deformation, double* positions,
                                 size_t capacity) {
  return give_array("palpate_deformation_vertices",
                    deformation == nullptr ? nullptr : &deformation->skin.positions(), positions,
                    capacity);
}

int palpate_deformation_triangles(const palpate_deformation* deformation, int32_t* triangles,
                                  size_t capacity) {
  return give_array("palpate_deformation_triangles",
                    deformation == nullptr ? nullptr : &deformation->skin.triangles(), triangles,
                    capacity);
}

int palpate_deform(const palpate_state* state, const palpate_deformation* deformation,
                   double* positions, size_t capacity) {
  if (state == nullptr || deformation == nullptr || positions == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_deform: null pointer");
  if (capacity < deformation->skin.positions().size()) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_deform: capacity is less than palpate_deformation_describe says");
  }
  if (state->made_with != deformation->library) {
    return fail(PALPATE_ERROR_MISMATCH,
                "palpate_deform: state and deformation were made with different libraries");
  }
  deformation->skin.displace(state->touch(), positions);
  return PALPATE_OK;
}

}  // extern "C"
