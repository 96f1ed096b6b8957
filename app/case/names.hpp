// SPDX-License-Identifier: AGPL-3.0-or-later
// Names of the alternatives of a setting, as a case file writes them.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/laws/fibre_field.hpp"
#include "fem/laws/relaxation.hpp"
#include "fem/solid/dilatation.hpp"
#include "fem/solid/gravity.hpp"
#include "format/library.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

template <class T>
struct Named {
  T value;
  std::string_view name;
};
// clang 14 does not deduce the parameter of an aggregate by itself.
template <class T>
Named(T, std::string_view) -> Named<T>;

inline constexpr std::array kToolShapes{Named{fem::ToolShape::Sphere, "sphere"},
                                        Named{fem::ToolShape::Disc, "disc"},
                                        Named{fem::ToolShape::Cylinder, "cylinder"}};
inline constexpr std::array kToolFrictions{Named{fem::ToolFriction::Frictionless, "frictionless"},
                                           Named{fem::ToolFriction::NoSlip, "no-slip"}};
inline constexpr std::array kElements{Named{fem::Dilatation::Mean, "tet10-pressure"},
                                      Named{fem::Dilatation::Nodal, "tet10-nodal-pressure"},
                                      Named{fem::Dilatation::Pointwise, "tet10-displacement"},
                                      Named{fem::Dilatation::LinearNodal, "tet4"}};
inline constexpr std::array kModuli{Named{fem::Moduli::Instantaneous, "instantaneous"},
                                    Named{fem::Moduli::LongTerm, "long-term"}};
inline constexpr std::array kFibreFields{Named{fem::FibreField::Kind::Constant, "constant"},
                                         Named{fem::FibreField::Kind::Cylindrical, "cylindrical"},
                                         Named{fem::FibreField::Kind::Sampled, "file"},
                                         Named{fem::FibreField::Kind::Laplace, "laplace"}};
inline constexpr std::array kGivenShapes{Named{fem::GivenShape::Unloaded, "unloaded"},
                                         Named{fem::GivenShape::Loaded, "loaded"}};
inline constexpr std::array kResponseKinds{Named{ResponseKind::Decoupled, "decoupled"},
                                           Named{ResponseKind::Coupled, "coupled"}};

inline constexpr std::array kRepairModes{Named{mesher::RepairMode::Auto, "auto"},
                                         Named{mesher::RepairMode::None, "none"},
                                         Named{mesher::RepairMode::Wrap, "wrap"}};
inline constexpr std::array kMeshMethods{Named{mesher::MeshMethod::Auto, "auto"},
                                         Named{mesher::MeshMethod::Isotropic, "isotropic"},
                                         Named{mesher::MeshMethod::Delaunay, "delaunay"}};
inline constexpr std::array kPressDirections{Named{mesher::PressDirections::Normal, "normal"},
                                             Named{mesher::PressDirections::Sliding, "sliding"}};
inline constexpr std::array kParts{Named{false, "one"}, Named{true, "largest"}};

/// The name of a value; empty when the table does not list it.
template <class T, std::size_t N>
constexpr std::string_view name_in(const std::array<Named<T>, N>& table, const T& value) {
  for (const Named<T>& entry : table)
    if (entry.value == value) return entry.name;
  return {};
}

template <class T, std::size_t N>
std::vector<std::string_view> names_in(const std::array<Named<T>, N>& table) {
  std::vector<std::string_view> names;
  for (const Named<T>& entry : table) names.push_back(entry.name);
  return names;
}

}  // namespace palpate::app
