// SPDX-License-Identifier: AGPL-3.0-or-later
// The sections that select nodes by shapes: supports and press zones.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "app/case/describe/key.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {

/// In the order of the alternatives of mesher::Support.
inline constexpr std::array<std::string_view, 5> kSupportShapes{"plane", "box", "sphere", "surface",
                                                                "label"};

template <class V>
void describe_support_shape(V& v, const std::string& shape, mesher::Support& where) {
  if (v.when("shape", shape, "plane")) {
    auto& plane = alternative<mesher::PlaneSupport>(where);
    v.point(plane.point, Dimension::Length, {"point", "a point of the plane", kRequired});
    v.direction(
        plane.normal,
        {"normal", "normal of the plane, towards the side that counts; of any length", kRequired});
  }
  if (v.when("shape", shape, "box")) {
    auto& box = alternative<mesher::BoxSupport>(where);
    v.point(box.low, Dimension::Length, {"low", "corner with the smallest coordinates", kRequired});
    v.point(box.high, Dimension::Length,
            {"high", "corner with the largest coordinates", kRequired});
  }
  if (v.when("shape", shape, "sphere")) {
    auto& sphere = alternative<mesher::SphereSupport>(where);
    v.point(sphere.centre, Dimension::Length, {"centre", "centre of the sphere", kRequired});
    v.quantity(sphere.radius, Dimension::Length,
               {"radius", "radius of the sphere", kRequired, kPositive});
  }
  if (v.when("shape", shape, "surface")) {
    auto& support = alternative<mesher::SurfaceSupport>(where);
    describe_path(v, support.surface.path,
                  {"file", "watertight surface, such as that of a bone", kRequired});
    describe_length_unit(v, support.surface.unit,
                         {"unit", "length unit of the coordinates in the file", kRequired});
    v.quantity(support.distance, Dimension::Length,
               {"distance", "what lies inside the surface or nearer to it than this counts",
                kRequired, kNotNegative});
  }
  if (v.when("shape", shape, "label")) {
    v.text(alternative<mesher::LabelSupport>(where).label,
           {"label",
            "name of faces in the file of the surface (OBJ: a group `g`, an object `o` or a "
            "material `usemtl`; STL: a solid; PLY: a colour, `#ff0000`; VTK: `array=value`), of a "
            "set of a volume mesh, "
            "or of a region of an image",
            kRequired});
  }
}

template <class V>
void describe_zone(V& v, mesher::Zone& s, std::string_view about, std::string& shape) {
  shape = kSupportShapes[s.shape.index()];
  v.text(shape, {"shape", about, kRequired}, {kSupportShapes.begin(), kSupportShapes.end()});
  v.flag(s.inverted, {"invert", "`true`: everything but what the shape contains"});
}

template <class V>
void describe_press(V& v, mesher::Zone& s) {
  std::string shape;
  describe_zone(v, s, "shape that contains sites", shape);
  describe_support_shape(v, shape, s.shape);
}

template <class V>
void describe_support(V& v, mesher::Springs& s) {
  std::string shape;
  describe_zone(v, s.where, "shape that contains the supported surface nodes", shape);
  v.quantity(s.normal_stiffness, Dimension::FoundationStiffness,
             {"normal_stiffness",
              "elastic foundation along the facet normals; fixed nodes when this and "
              "`tangential_stiffness` are 0",
              kOptional, kNotNegative});
  v.quantity(s.tangential_stiffness, Dimension::FoundationStiffness,
             {"tangential_stiffness", "stiffness of the elastic foundation across the normals",
              kOptional, kNotNegative});
  describe_support_shape(v, shape, s.where.shape);
}

}  // namespace palpate::app
