// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "format/number_text.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kFraction = 0.95;           // of the vertices
constexpr double kLeastLateralForce = 0.01;  // over the largest normal force

double last_force(const runtime::CompiledCurve& curve) {
  return curve.force(curve.last_knot());
}

double largest_normal_force(const NodeResponse& node) {
  return last_force(runtime::CompiledCurve(node.normal));
}

double largest_lateral_force(const NodeResponse& node, ResponseKind kind) {
  double force = last_force(runtime::CompiledCurve(node.lateral));
  if (kind == ResponseKind::Coupled)
    force *= last_force({node.coupling.curve, static_cast<double>(node.coupling.base)});
  return std::max(force, kLeastLateralForce * largest_normal_force(node));
}

/// The nearest rank of what is known.
double bound_of_most(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return kUnknown;
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(kFraction * static_cast<double>(values.size()) - 1e-9));
  const auto last = values.begin() + std::max<std::ptrdiff_t>(0, rank - 1);
  std::nth_element(values.begin(), last, values.end());
  return *last;
}

template <class Force>
Accuracy accuracy_of(const Library& library, double NodeResponse::*mesh, double NodeResponse::*fit,
                     const Force& largest_force) {
  std::vector<double> of_mesh, of_fit;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const double force = largest_force(node);
    if (!(force > 0)) continue;
    of_mesh.push_back(node.*mesh / force);
    of_fit.push_back(node.*fit / force);
  }
  return {bound_of_most(std::move(of_mesh)), bound_of_most(std::move(of_fit))};
}

/// "0.010 %" for what is smaller: it is a bound.
std::string bound_text(double fraction) {
  constexpr double kLeast = 1e-4;
  return percent_text(std::max(kLeast, fraction));
}

std::string sum_of(const Accuracy& accuracy) {
  const std::string fit = bound_text(accuracy.fit) + " (fit)";
  return std::isnan(accuracy.mesh) ? fit : bound_text(accuracy.mesh) + " (mesh) + " + fit;
}

}  // namespace

Accuracy normal_accuracy(const Library& library) {
  return accuracy_of(library, &NodeResponse::normal_mesh_error, &NodeResponse::normal_error,
                     largest_normal_force);
}

Accuracy lateral_accuracy(const Library& library) {
  return accuracy_of(
      library, &NodeResponse::lateral_mesh_error, &NodeResponse::lateral_error,
      [&](const NodeResponse& node) { return largest_lateral_force(node, library.kind); });
}

std::string accuracy_text(const Library& library) {
  const Accuracy normal = normal_accuracy(library), lateral = lateral_accuracy(library);
  if (std::isnan(normal.fit)) return {};
  const bool known = !std::isnan(normal.mesh);
  std::string text = "at 95 % of the vertices the normal force is within " + sum_of(normal) +
                     (known ? " of the converged force" : " of its curve");
  if (!std::isnan(lateral.fit))
    text += ", the lateral force within " + sum_of(lateral) +
            (known && std::isnan(lateral.mesh) ? " of its curve" : "");
  text += ", relative to the largest there";
  return known ? text : text + "; the error of the curves themselves is unknown";
}

}  // namespace palpate::fitting
