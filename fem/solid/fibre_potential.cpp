// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/fibre_potential.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "fem/mesh/to_eigen.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

using Eigen::Vector3d;

/// An element of the region: its volume, its centroid and the gradients of its four linear shapes.
struct Element {
  Tetrahedron nodes;
  double volume;
  Vector3d centroid;
  std::array<Vector3d, 4> gradient;
};

Element element_of(const Body& body, const Tetrahedron& nodes) {
  std::array<Vector3d, 4> X;
  for (std::size_t i = 0; i < 4; ++i) X[i] = to_eigen(body.nodes[to_index(nodes[i])]);
  const Vector3d a = X[1] - X[0], b = X[2] - X[0], c = X[3] - X[0];
  const double six_volumes = a.dot(b.cross(c));
  Element e{nodes, six_volumes / 6, 0.25 * (X[0] + X[1] + X[2] + X[3]), {}};
  e.gradient[1] = b.cross(c) / six_volumes;
  e.gradient[2] = c.cross(a) / six_volumes;
  e.gradient[3] = a.cross(b) / six_volumes;
  e.gradient[0] = -(e.gradient[1] + e.gradient[2] + e.gradient[3]);
  return e;
}

std::vector<Element> elements_of(const Body& body, std::int32_t region) {
  std::vector<Element> elements;
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t)
    if (body.tetrahedron_region[t] == region)
      elements.push_back(element_of(body, body.tetrahedra[t]));
  return elements;
}

/// Nodes of the facets that belong to one element only.
std::vector<bool> surface_nodes(const Body& body, const std::vector<Element>& elements) {
  std::map<std::array<std::int32_t, 3>, int> count;
  for (const Element& e : elements)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      std::array<std::int32_t, 3> facet{e.nodes[(opposite + 1) % 4], e.nodes[(opposite + 2) % 4],
                                        e.nodes[(opposite + 3) % 4]};
      std::sort(facet.begin(), facet.end());
      ++count[facet];
    }
  std::vector<bool> on_surface(body.nodes.size(), false);
  for (const auto& [facet, elements_at] : count)
    if (elements_at == 1)
      for (const std::int32_t node : facet) on_surface[to_index(node)] = true;
  return on_surface;
}

constexpr double kFree = -1;

/// 0 or 1 where the potential is prescribed, kFree elsewhere.
std::vector<double> given_values(const Body& body, const std::vector<Element>& elements,
                                 const FibreField& field, const std::string& where) {
  const std::vector<bool> on_surface = surface_nodes(body, elements);
  std::vector<double> given(body.nodes.size(), kFree);
  bool from = false, to = false;
  for (std::size_t node = 0; node < given.size(); ++node) {
    if (!on_surface[node]) continue;
    const bool low = field.from.holds(body.nodes[node]), high = field.to.holds(body.nodes[node]);
    if (low && high)
      throw Error(ErrorKind::Configuration, where,
                  "the two boxes of the fibres contain the same part of the surface",
                  "give boxes without a common part of the surface");
    if (low || high) given[node] = high ? 1 : 0;
    from = from || low;
    to = to || high;
  }
  if (!from || !to)
    throw Error(
        ErrorKind::Configuration, where,
        std::string("no node of the surface of the region lies in the box where the fibres ") +
            (from ? "end" : "begin"),
        "give a box that encloses a part of the surface");
  return given;
}

/// Computes the values that are not given.
void solve(const std::vector<Element>& elements, std::vector<double>& phi,
           const std::string& where) {
  std::vector<int> equation(phi.size(), -1);
  int n = 0;
  for (const Element& e : elements)
    for (const std::int32_t node : e.nodes)
      if (phi[to_index(node)] == kFree && equation[to_index(node)] < 0)
        equation[to_index(node)] = n++;
  if (n == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (const Element& e : elements)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const int row = equation[to_index(e.nodes[i])], column = equation[to_index(e.nodes[j])];
        if (row < 0) continue;
        const double k = e.volume * e.gradient[i].dot(e.gradient[j]);
        if (column < 0)
          b[row] -= k * phi[to_index(e.nodes[j])];
        else
          entries.emplace_back(row, column, k);
      }
  Eigen::SparseMatrix<double> K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(K);
  const Eigen::VectorXd x = factor.solve(b);
  // In a part that neither box touches the potential is determined up to a constant only.
  const double off = (K * x - b).lpNorm<Eigen::Infinity>();
  if (factor.info() != Eigen::Success || !x.allFinite() || x.minCoeff() < -1e-6 ||
      x.maxCoeff() > 1 + 1e-6 ||
      factor.vectorD().minCoeff() < 1e-10 * factor.vectorD().maxCoeff() || !(off < 1e-6))
    throw Error(ErrorKind::Configuration, where,
                "the potential of the fibres is not determined: a part of the region is connected "
                "to neither box",
                "give boxes that both touch every part of the region");
  for (std::size_t node = 0; node < phi.size(); ++node)
    if (equation[node] >= 0) phi[node] = x[equation[node]];
}

}  // namespace

FibreField fibres_of_potential(const Body& body, std::int32_t region, const FibreField& field,
                               const std::string& where) {
  const std::vector<Element> elements = elements_of(body, region);
  std::vector<double> phi = given_values(body, elements, field, where);
  solve(elements, phi, where);
  std::vector<FibreSample> samples;
  for (const Element& e : elements) {
    Vector3d slope = Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) slope += phi[to_index(e.nodes[i])] * e.gradient[i];
    // Relative to the steepest gradient possible in an element of this size.
    const bool flat = slope.norm() * std::cbrt(e.volume) < 1e-9;
    if (!flat)
      samples.push_back(
          {{e.centroid[0], e.centroid[1], e.centroid[2]}, {slope[0], slope[1], slope[2]}, {}});
  }
  FibreField sampled = field;
  sampled.kind = FibreField::Kind::Sampled;
  sampled.samples = std::make_shared<const FibreSamples>(std::move(samples));
  return sampled;
}

}  // namespace palpate::fem
