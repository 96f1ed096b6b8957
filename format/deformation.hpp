// SPDX-License-Identifier: Apache-2.0
// deformation.pdef: how the skin moves under the tool, beside a response library. Normative page:
// format/schema/deformation.md; equations: docs/theory-deformation.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "format/library.hpp"
#include "format/vec3.hpp"

namespace palpate {

/// Components of the local displacement around a contact, at a distance s from it, in the frame of
/// the contact: along n and radially for a press; radially, around and along n for a lateral
/// deflection, with the cosine, minus the sine and the cosine of the azimuth.
inline constexpr std::size_t kPressComponents = 2;
inline constexpr std::size_t kLateralComponents = 3;
inline constexpr std::size_t kTangents = 2;
/// Components of what differs between directions, for each tangent t of a site: along t, along n x
/// t and along n, as Fourier series of the azimuth from t: kHarmonics terms, and kNormalHarmonics.
inline constexpr std::size_t kHarmonics = 5;        ///< 1, cos phi, sin phi, cos 2 phi, sin 2 phi
inline constexpr std::size_t kNormalHarmonics = 3;  ///< 1, cos phi, sin phi
inline constexpr std::size_t kAnisotropicComponents = 2 * kHarmonics + kNormalHarmonics;

/// The frame of a site: n and two tangents.
struct SiteFrame {
  Vec3 position{};  ///< m
  Vec3 inward{};    ///< unit
  Vec3 tangent{};   ///< unit, normal to inward; the second is inward x tangent
};

/// The displacement of skin vertex w for a contact at site s at depth level k is
///   u = local_s,k(s) + sum over m of coefficient_s,k,m scale_m mode_m,w,
/// for a lateral deflection the same per metre of it. Between depths it is interpolated, between
/// sites blended, and the local part moves with the contact point.
struct Deformation {
  std::string surface;          ///< surface_digest of the library that it belongs to
  std::string tool_shape;       ///< "sphere", "disc" or "cylinder"
  double tool_radius = 0;       ///< m
  double tool_edge_radius = 0;  ///< m, of a disc
  double reach = 0;             ///< m, R_c: the local part ends at this distance
  double rms_left_out = 0;      ///< m, of the displacements that no mode has, root mean square

  std::vector<Vec3> positions;          ///< (W) m, the skin at rest
  std::vector<Triangle> triangles;      ///< rows of positions
  std::vector<std::int32_t> vertex_of;  ///< (V) skin vertex of each vertex of the library

  std::vector<double> depths;          ///< (K) m, ascending
  std::vector<double> lateral_depths;  ///< (L) m, ascending; may be empty
  std::vector<double> knots;           ///< (J) m, distances of the local part, from 0 to reach
  std::vector<SiteFrame> sites;        ///< (S)
  /// The sites whose displacements a vertex blends, and their weights, of sum 1: those of vertex v
  /// are rows donor_offset[v] to donor_offset[v + 1]. None where the vertex has no response.
  std::vector<std::int64_t> donor_offset;  ///< (V + 1)
  std::vector<std::int32_t> donor;         ///< row of sites
  std::vector<float> donor_weight;

  /// The presses are those of a tool without friction, under which the skin slides where the
  /// responses lean: a tool that sticks has sheared it as far as it would slide.
  bool press_slips = false;
  std::vector<float> press_local;    ///< (S, K, 2, J) m
  std::vector<float> lateral_local;  ///< (S, L, 3, J) 1
  /// What differs between directions, times anisotropic_scale. Empty where a file has none.
  std::vector<std::int16_t> anisotropic;  ///< (S, L, 2, 13, J)
  std::vector<float> anisotropic_scale;   ///< (S, L) 1

  std::vector<float> press_modes;    ///< (S, K, M) m
  std::vector<float> lateral_modes;  ///< (S, L, 2, M) 1, for each tangent
  std::vector<float> mode_scale;     ///< (M)
  std::vector<std::int16_t> modes;   ///< (M, 3 W)

  std::size_t mode_count() const { return mode_scale.size(); }
};

/// SHA-256 of the vertices and triangles of the response surface.
std::string surface_digest(const std::vector<Vec3>& positions,
                           const std::vector<Triangle>& triangles);

/// Unit normals of the vertices, into the body: means of those of their triangles, by area. Zero
/// where they cancel.
std::vector<Vec3> inward_normals(const std::vector<Vec3>& positions,
                                 const std::vector<Triangle>& triangles);

/// Never half written. @throws Error when the disk refuses.
void write_deformation(const std::filesystem::path& file, const Deformation& deformation);

/// Reads and checks: sizes, indices, finite numbers, ascending depths and knots, weights of sum 1.
/// `file` is the name in errors. @throws Error(Configuration).
Deformation read_deformation(std::string_view bytes, const std::filesystem::path& file);
Deformation read_deformation(const std::filesystem::path& file);

}  // namespace palpate
