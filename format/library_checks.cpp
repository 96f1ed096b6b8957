// SPDX-License-Identifier: Apache-2.0
#include "format/library_checks.hpp"

#include <algorithm>
#include <cmath>

#include "format/library_columns.hpp"
#include "format/number_text.hpp"

namespace palpate {
namespace {

const ResponseCurve& get(const NodeResponse& node, CurveMember which) {
  return which(const_cast<NodeResponse&>(node));
}

/// Checks of the offsets come first: the other loops rely on them.
void check_offset(const Checks& checks, const std::string& name,
                  const std::vector<std::int64_t>& offset, std::size_t total) {
  if (offset.front() != 0) checks.fail_row(name, 0, "is not 0");
  for (std::size_t row = 1; row < offset.size(); ++row) {
    if (offset[row] < offset[row - 1]) checks.fail_row(name, row, "is below the row before it");
  }
  checks.require(
      offset.back() == static_cast<std::int64_t>(total), name,
      "ends at " + std::to_string(offset.back()) + ", " + std::to_string(total) + " knots found");
}

void check_surface(const Checks& checks, const Library& library) {
  const std::size_t vertices = library.positions.size();
  checks.require(vertices > 0, "/surface/position", "is empty");
  checks.vectors("/surface/position", library.positions, rules::kFinite);
  checks.same_size("/surface/inward", library.inward.size(), vertices);
  checks.vectors("/surface/inward", library.inward, rules::kUnit);
  checks.corners("/surface/triangles", library.triangles, vertices);
  checks.same_size("/response/status", library.responses.size(), vertices);
  checks.require(std::isfinite(library.tool_radius) && library.tool_radius >= 0, "/@tool_radius",
                 "is not finite and not negative");
}

/// A bound below L_min that slides can exceed would be promised and not kept.
void check_enforceable(const Checks& checks, const Certificate& c) {
  const double smallest = std::min(c.min_lipschitz_bound, std::max(c.stick, c.slip));
  if (c.triangles.empty() || std::isinf(c.min_lipschitz_bound) || !(c.lipschitz_bound < smallest))
    return;
  checks.fail("/certificate@lipschitz_bound",
              "is " + number_text(c.lipschitz_bound) +
                  " N/m, below the smallest bound that the runtime can enforce "
                  "(min_lipschitz_bound), " +
                  number_text(c.min_lipschitz_bound) + " N/m: the certificate is false");
}

/// A length that is NaN fits no limit.
void check_leans(const Checks& checks, const Library& library) {
  std::size_t row = 0;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const double length = norm(vec3_of(node.lean));
    const bool grows = library.kind == ResponseKind::Coupled && length > 0;
    const double longest = grows ? node.coupling.largest() * length : length;
    if (!(longest <= kMostLean))
      checks.fail_row(kLeans.name, row,
                      (grows ? "is, times the largest w, longer than " : "is longer than ") +
                          number_text(kMostLean));
    ++row;
  }
}

/// A length that is NaN fits no limit.
void check_soft_axes(const Checks& checks, const Library& library) {
  std::size_t row = 0;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const double length = norm(vec3_of(node.soft_axis));
    if (!(length <= kMostSoftAxis))
      checks.fail_row(kSoftAxes.name, row, "is longer than " + number_text(kMostSoftAxis));
    if (length > 0 && library.kind == ResponseKind::Decoupled)
      checks.fail(kSoftAxes.name, kSoftAndDecoupled);
    ++row;
  }
}

void check_certificate(const Checks& checks, const Library& library) {
  const Certificate& certificate = library.certificate;
  const auto check = [&](const char* name, double value, const Rule& rule) {
    const bool fits = value >= rule.low && value <= rule.high;
    if (!fits) checks.fail(std::string("/certificate@") + name, std::string("is not ") + rule.text);
  };
  const auto check_if_known = [&](const char* name, double value) {
    if (!std::isnan(value)) check(name, value, rules::kBound);
  };
  const auto triangles = static_cast<double>(library.triangles.size());
  const auto vertices = static_cast<double>(library.positions.size());
  check("friction", certificate.friction, rules::kNonNegative);
  check("depth", certificate.depth, rules::kNonNegative);
  check("stick", certificate.stick, rules::kBound);
  check("slip", certificate.slip, rules::kBound);
  check_if_known("min_lipschitz_bound", certificate.min_lipschitz_bound);
  check_if_known("lipschitz_bound", certificate.lipschitz_bound);
  check("relaxation_rate", certificate.relaxation_rate, rules::kNonNegative);
  check_enforceable(checks, certificate);
  check("worst_triangle", certificate.worst_triangle,
        Rule{-1, triangles - 1, false, false, "-1 or a triangle"});
  check("holes", certificate.holes, rules::up_to(vertices, "a number of vertices"));
  check("interpolated", certificate.interpolated, rules::up_to(vertices, "a number of vertices"));
  if (!certificate.triangles.empty()) {
    checks.same_size("/certificate/triangle/stick", certificate.triangles.size(),
                     library.triangles.size());
  }
  check_columns(checks, "/certificate/triangle", certificate.triangles, kTriangleColumns);
  check_columns(checks, "/certificate/device", certificate.devices, kDeviceColumns);
}

}  // namespace

FlatCurves flatten(const std::vector<NodeResponse>& responses, CurveMember which) {
  FlatCurves flat;
  flat.offset.push_back(0);
  for (const NodeResponse& response : responses) {
    const ResponseCurve& curve = get(response, which);
    flat.knot.insert(flat.knot.end(), curve.knot.begin(), curve.knot.end());
    flat.slope.insert(flat.slope.end(), curve.slope.begin(), curve.slope.end());
    flat.offset.push_back(static_cast<std::int64_t>(flat.knot.size()));
  }
  return flat;
}

void unflatten(const FlatCurves& flat, CurveMember which, std::vector<NodeResponse>& responses) {
  for (std::size_t vertex = 0; vertex < responses.size(); ++vertex) {
    const auto first = flat.offset[vertex];
    const auto last = flat.offset[vertex + 1];
    ResponseCurve& curve = which(responses[vertex]);
    curve.knot.assign(flat.knot.begin() + first, flat.knot.begin() + last);
    curve.slope.assign(flat.slope.begin() + first, flat.slope.begin() + last);
  }
}

std::vector<float> coupling_bases(const std::vector<NodeResponse>& responses) {
  std::vector<float> bases;
  bases.reserve(responses.size());
  for (const NodeResponse& response : responses) bases.push_back(response.coupling.base);
  return bases;
}

std::vector<std::array<float, 3>> rows_of(const std::vector<NodeResponse>& responses,
                                          const NodeVector& vector) {
  std::vector<std::array<float, 3>> rows;
  rows.reserve(responses.size());
  for (const NodeResponse& response : responses)
    if (response.status != ResponseStatus::Hole) rows.push_back(response.*vector.member);
  return rows;
}

void set_rows(const Checks& checks, const std::vector<std::array<float, 3>>& rows,
              const NodeVector& vector, Library& library) {
  std::vector<NodeResponse>& responses = library.responses;
  const auto not_a_hole = [](const NodeResponse& r) { return r.status != ResponseStatus::Hole; };
  checks.same_size(
      vector.name, rows.size(),
      static_cast<std::size_t>(std::count_if(responses.begin(), responses.end(), not_a_hole)));
  auto row = rows.begin();
  for (NodeResponse& response : responses)
    if (not_a_hole(response)) response.*vector.member = *row++;
  check_leans(checks, library);
  check_soft_axes(checks, library);
}

std::vector<float> relaxation_fractions(const Library& library) {
  std::vector<float> fractions;
  fractions.reserve(library.responses.size() * library.relaxation_times.size());
  for (const NodeResponse& response : library.responses) {
    std::vector<float> row = response.relaxation;
    if (response.status == ResponseStatus::Hole) row.resize(library.relaxation_times.size());
    fractions.insert(fractions.end(), row.begin(), row.end());
  }
  return fractions;
}

void set_relaxation_fractions(const std::vector<float>& fractions, Library& library) {
  const auto times = static_cast<std::ptrdiff_t>(library.relaxation_times.size());
  auto row = fractions.begin();
  for (NodeResponse& response : library.responses) {
    if (response.status != ResponseStatus::Hole) response.relaxation.assign(row, row + times);
    row += times;
  }
}

void check_relaxation(const Checks& checks, const Library& library,
                      const std::vector<float>& fractions) {
  const std::string times_name = "/relaxation/time", name = "/response/relaxation_fraction";
  const std::vector<double>& times = library.relaxation_times;
  checks.require(!times.empty() && times.size() <= kMaxRelaxationTimes, times_name,
                 "has not 1 to " + std::to_string(kMaxRelaxationTimes) + " times");
  checks.numbers(times_name, times, rules::kPositive);
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      checks.fail_row(times_name, i, "is not above the time before it");
  checks.require(library.tool_radius > 0, "/@tool_radius",
                 "is not above 0, which responses that relax need");
  checks.same_size(name, fractions.size(), times.size() * library.responses.size());
  checks.numbers(name, fractions, rules::kNonNegative);
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    double sum = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
      sum += static_cast<double>(fractions[v * times.size() + i]);
    if (!(sum < 1)) checks.fail_row(name, v, "has a sum of 1 or more: nothing is left in the end");
  }
}

void check_curves(const Checks& checks, const std::string& stem, const FlatCurves& flat,
                  const std::vector<NodeResponse>& responses) {
  checks.same_size(stem + "slope", flat.slope.size(), flat.knot.size());
  check_offset(checks, stem + "offset", flat.offset, flat.knot.size());
  checks.numbers(stem + "knot", flat.knot, rules::kNonNegative);
  checks.numbers(stem + "slope", flat.slope, rules::kNonNegative);
  for (std::size_t vertex = 0; vertex < responses.size(); ++vertex) {
    const auto first = static_cast<std::size_t>(flat.offset[vertex]);
    const auto last = static_cast<std::size_t>(flat.offset[vertex + 1]);
    const bool may_be_empty = responses[vertex].status == ResponseStatus::Hole;
    if (last - first < 2 && !(may_be_empty && last == first)) {
      checks.fail_row(stem + "offset", vertex, "leaves the curve of this vertex under 2 knots");
    }
    for (std::size_t k = first; k < last; ++k) {
      if (k == first && flat.knot[k] != 0) checks.fail_row(stem + "knot", k, "begins not at 0");
      if (k > first && !(flat.knot[k] > flat.knot[k - 1])) {
        checks.fail_row(stem + "knot", k, "is not above the knot before it");
      }
    }
  }
}

void check_library(const Checks& checks, const Library& library) {
  check_surface(checks, library);
  check_certificate(checks, library);
}

void check_for_writing(const Checks& checks, const Library& library) {
  check_surface(checks, library);
  check_columns(checks, "/response", library.responses, kResponseColumns);
  for (std::size_t vertex = 0; vertex < library.responses.size(); ++vertex) {
    for (const CurveMember which : {normal_of, lateral_of, coupling_of}) {
      const ResponseCurve& curve = get(library.responses[vertex], which);
      if (curve.knot.size() != curve.slope.size()) {
        checks.fail_row("/response/status", vertex, "knots and slopes differ in number");
      }
    }
  }
  check_curves(checks, "/response/normal_", flatten(library.responses, normal_of),
               library.responses);
  check_curves(checks, "/response/lateral_", flatten(library.responses, lateral_of),
               library.responses);
  if (library.kind == ResponseKind::Coupled) {
    check_curves(checks, "/response/coupling_", flatten(library.responses, coupling_of),
                 library.responses);
    checks.numbers("/response/coupling_base", coupling_bases(library.responses), rules::kPositive);
  }
  if (library.relaxes()) check_relaxation(checks, library, relaxation_fractions(library));
  check_leans(checks, library);
  check_soft_axes(checks, library);
  check_certificate(checks, library);
  check_provenance(checks, library.provenance);
}

}  // namespace palpate
