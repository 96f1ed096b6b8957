// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <pybind11/pybind11.h>

#include "format/vec3.hpp"
#include "python/objects.hpp"
#include "runtime/palpate.h"

namespace palpate::python {

/// palpate.Deformation. Its library lives at least as long.
struct DeformationObject {
  DeformationObject(std::shared_ptr<LibraryObject> of, palpate_deformation* made);

  std::shared_ptr<LibraryObject> library;
  std::unique_ptr<palpate_deformation, decltype(&palpate_deformation_destroy)> handle;
  palpate_deformation_info info{};
  std::vector<Vec3> positions;      ///< m, at rest
  std::vector<Triangle> triangles;  ///< rows of positions
};

/// Library.deformation.
std::shared_ptr<DeformationObject> load_deformation(const std::shared_ptr<LibraryObject>& library,
                                                    const std::filesystem::path& path);

/// palpate.Deformation, and State.deform.
void define_deformation(pybind11::module_& module, StateClass& state);

}  // namespace palpate::python
