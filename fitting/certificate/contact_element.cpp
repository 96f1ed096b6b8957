// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/contact_element.hpp"

#include <algorithm>

namespace palpate::fitting {
namespace {

const NodeResponse& response(const Library& library, std::int32_t vertex) {
  return library.responses[static_cast<std::size_t>(vertex)];
}

CurveTriple curves_of(const Library& library, const Triangle& triangle, const TriangleFrame& frame,
                      ResponseCurve NodeResponse::*kind) {
  return {{runtime::CompiledCurve(response(library, triangle[0]).*kind),
           runtime::CompiledCurve(response(library, triangle[1]).*kind),
           runtime::CompiledCurve(response(library, triangle[2]).*kind)},
          frame.gradient};
}

CurveTriple couplings_of(const Library& library, const Triangle& triangle,
                         const TriangleFrame& frame) {
  const auto curve = [&](std::size_t l) {
    const CouplingCurve& coupling = response(library, triangle[l]).coupling;
    return runtime::CompiledCurve(coupling.curve, static_cast<double>(coupling.base));
  };
  return {{curve(0), curve(1), curve(2)}, frame.gradient};
}

}  // namespace

bool has_responses(const Library& library, const Triangle& triangle) {
  return std::none_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
    return response(library, v).status == ResponseStatus::Hole;
  });
}

ContactElement contact_element(const Library& library, std::size_t index, double depth,
                               double friction) {
  const Triangle& triangle = library.triangles[index];
  const TriangleFrame frame = triangle_frame(library, index);
  ContactElement element{frame, curves_of(library, triangle, frame, &NodeResponse::normal),
                         curves_of(library, triangle, frame, &NodeResponse::lateral), friction,
                         depth};
  if (library.kind == ResponseKind::Coupled)
    element.coupling = couplings_of(library, triangle, frame);
  element.relaxes = library.relaxes();
  return element;
}

std::vector<double> ContactElement::depth_cells(double deepest) const {
  std::vector<double> ends = normal.cells({0, deepest}, 1);
  if (!coupling) return ends;
  const std::vector<double> more = coupling->cells({0, deepest}, 1);
  ends.insert(ends.end(), more.begin(), more.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

}  // namespace palpate::fitting
