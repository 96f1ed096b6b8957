// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/prolongation.hpp"

namespace palpate::fem {

Prolongation::Prolongation(const RefinedMesh& refined, const std::vector<Tetrahedron10>& elements,
                           const SolidModel& whole)
    : all_(whole.pattern().n) {
  const int old_nodes = whole.mesh().nodes() - static_cast<int>(refined.new_nodes.size());
  for (int node = 0; node < old_nodes; ++node)
    if (whole.equation(node) >= 0) old_ += 3;
  for (std::size_t i = 0; i < refined.new_nodes.size(); ++i) {
    const int first = whole.equation(old_nodes + static_cast<int>(i));
    if (first < 0) continue;
    const RefinedMesh::NewNode& added = refined.new_nodes[i];
    for (std::size_t a = 0; a < kTetNodes; ++a) {
      const int parent = whole.equation(elements[to_index(added.parent)][a]);
      if (parent >= 0 && added.N[a] != 0) weights_.push_back({first, parent, added.N[a]});
    }
  }
}

Eigen::VectorXd Prolongation::extended(const Eigen::VectorXd& d) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(all_);
  all.head(old_) = d;
  for (const Weight& weight : weights_)
    all.segment<3>(weight.node) += weight.N * d.segment<3>(weight.parent);
  return all;
}

Eigen::VectorXd Prolongation::reduced(const Eigen::VectorXd& f) const {
  Eigen::VectorXd old = f.head(old_);
  for (const Weight& weight : weights_)
    old.segment<3>(weight.parent) += weight.N * f.segment<3>(weight.node);
  return old;
}

}  // namespace palpate::fem
