// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/unloaded_shape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "fem/factor/cholesky.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/preload.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/heavy_rod.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

constexpr double kDensity = 1000, kGravity = 9.81;

Body block() {
  return test::make_block(test::even(-0.016, 0.016, 3), test::even(-0.016, 0.016, 3),
                          test::even(-0.024, 0, 3));
}

/// A body and how it lies under its weight.
struct Sagged {
  Sagged(Body at_rest, const LawConstants& law, Dilatation d, const Gravity& g)
      : body(std::move(at_rest)),
        dilatation(d),
        gravity(g),
        model(body, {make_law(law, "t")}, d, g),
        permutation(nested_dissection(model.pattern())),
        u(equilibrium_under_weight(model, permutation, body.name)) {}

  Body shape() const {
    Body shape = body;
    for (std::size_t i = 0; i < shape.nodes.size(); ++i)
      shape.nodes[i] = shape.nodes[i] + to_vec3(u.col(static_cast<Eigen::Index>(i)));
    return shape;
  }

  UnloadedBody unloaded(const LawConstants& law) const {
    return find_unloaded_body(shape(), {make_law(law, "t")}, dilatation, gravity, permutation);
  }

  /// Largest distance of a node from where it was, over the largest displacement.
  double error_of(const UnloadedBody& found) const {
    double error = 0;
    for (std::size_t i = 0; i < body.nodes.size(); ++i)
      error = std::max(error, norm(found.body.nodes[i] - body.nodes[i]));
    return error / u.colwise().norm().maxCoeff();
  }

  Body body;
  Dilatation dilatation;
  Gravity gravity;
  SolidModel model;
  std::vector<int> permutation;
  Displacement u;
};

TEST(UnloadedShape, IsThatFromWhichTheBodySagged) {
  const LawConstants law{1.5e3, 0.45};
  for (const Dilatation dilatation :
       {Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise, Dilatation::LinearNodal}) {
    const Sagged sagged(block(), law, dilatation, Gravity{{0, 3, -kGravity}, kDensity});
    EXPECT_GT(sagged.u.colwise().norm().maxCoeff(), 0.08 * 0.024);
    const UnloadedBody found = sagged.unloaded(law);
    EXPECT_LT(sagged.error_of(found), 1e-5) << name_of(dilatation);
    EXPECT_LT(found.distance, 1e-6 * sagged.u.colwise().norm().maxCoeff());
    // The model is that of the unloaded body, in equilibrium at the given shape.
    Eigen::VectorXd residual;
    found.model.forces(found.u, residual);
    EXPECT_LT(residual.norm(), 2e-9 * found.model.weight_norm());
  }
}

/// The rod turns by ten degrees, and its unloaded shape is straight.
TEST(UnloadedShape, OfABentRodIsStraight) {
  const double radius = 0.005, length = 0.15;
  const LawConstants law{8e6, 0.49};
  const Sagged sagged(test::make_rod(radius, length, 12), law, Dilatation::Mean,
                      Gravity{{0, -kGravity, 0}, kDensity});
  EXPECT_GT(sagged.u.colwise().norm().maxCoeff(), 0.05 * length);
  EXPECT_LT(sagged.error_of(sagged.unloaded(law)), 1e-4);
}

/// Levels of a standing column of Saint Venant-Kirchhoff, nu = 0, at large strain: E/2 lambda
/// (lambda^2 - 1) = -rho g (H - Z), dz/dZ = lambda.
TEST(UnloadedShape, OfAStandingColumnIsTheClosedForm) {
  constexpr double kHeight = 0.08, kYoung = 10e3, kG = 10;
  constexpr int kLevels = 10, kSteps = 400;
  const auto stretch = [&](double Z) {
    double low = 1 / std::sqrt(3.0), high = 1;
    for (int i = 0; i < 60; ++i) {
      const double l = 0.5 * (low + high);
      (0.5 * kYoung * l * (l * l - 1) < -kDensity * kG * (kHeight - Z) ? low : high) = l;
    }
    return low;
  };
  std::vector<double> level{0};
  for (int k = 0; k < kLevels; ++k) {
    level.push_back(level.back());
    for (int i = 0; i < kSteps; ++i)
      level.back() +=
          stretch(kHeight * (k + (i + 0.5) / kSteps) / kLevels) * kHeight / (kLevels * kSteps);
  }
  const Body given = test::make_block(test::even(0, 0.06, 1), test::even(0, 0.06, 1), level);
  const LawConstants law("saint-venant-kirchhoff", {{"young", kYoung}, {"poisson", 0}});
  const Gravity gravity{{0, 0, -kG}, kDensity};
  const SolidModel model(given, {make_law(law, "t")}, Dilatation::Pointwise, gravity);
  const UnloadedBody found = find_unloaded_body(given, {make_law(law, "t")}, Dilatation::Pointwise,
                                                gravity, nested_dissection(model.pattern()));
  const double sag = kHeight - level.back();
  EXPECT_GT(sag, 0.03 * kHeight);
  for (std::size_t i = 0; i < given.nodes.size(); ++i) {
    const auto k = static_cast<std::size_t>(
        std::lower_bound(level.begin(), level.end(), given.nodes[i][2] - 1e-12) - level.begin());
    EXPECT_NEAR(found.body.nodes[i][2], kHeight * static_cast<double>(k) / kLevels, 2e-3 * sag);
  }
}

/// The fibres of the case lie in the given shape. Straight fibres of the unloaded body, carried
/// along by its sag, are found straight again.
TEST(UnloadedShape, PullsFibresBack) {
  const Vec3 along{0.6, 0, 0.8};
  LawConstants law("holzapfel-gasser-ogden",
                   {{"c", 600}, {"k1", 5e3}, {"k2", 1}, {"kappa", 0}, {"poisson", 0.45}});
  law.fibres.first = along;
  const Sagged sagged(block(), law, Dilatation::Mean, Gravity{{4, 0, kGravity}, kDensity});
  EXPECT_GT(sagged.u.colwise().norm().maxCoeff(), 0.05 * 0.024);

  const Body shape = sagged.shape();
  std::vector<FibreSample> samples;
  for (const Tetrahedron& t : shape.tetrahedra) {
    const auto edges = [&](const Body& body) {
      Eigen::Matrix3d D;
      for (int c = 0; c < 3; ++c)
        D.col(c) = to_eigen(body.nodes[to_index(t[to_index(c + 1)])] - body.nodes[to_index(t[0])]);
      return D;
    };
    Vec3 centroid{};
    for (const auto node : t) centroid = centroid + 0.25 * shape.nodes[to_index(node)];
    const Eigen::Vector3d a = edges(shape) * edges(sagged.body).inverse() * to_eigen(along);
    samples.push_back({centroid, to_vec3(a), {}});
  }
  LawConstants carried = law;
  carried.fibres.kind = FibreField::Kind::Sampled;
  carried.fibres.samples = std::make_shared<const FibreSamples>(samples);
  EXPECT_LT(sagged.error_of(sagged.unloaded(carried)), 1e-5);
  EXPECT_GT(sagged.error_of(sagged.unloaded(law)), 1e-3);  // or the fibres would not matter
}

TEST(UnloadedShape, KeepsItsSupportsAndTheGivenSurface) {
  Body given = block();
  for (const Edge ends : {Edge{0, 1}})
    given.curved_edges.push_back({ends, 0.5 * (given.nodes[0] + given.nodes[1])});
  const LawConstants law{3e3, 0.45};
  const Gravity gravity{{0, 0, -kGravity}, kDensity};
  const SolidModel model(given, {make_law(law, "t")}, Dilatation::Mean, gravity);
  const UnloadedBody found = find_unloaded_body(given, {make_law(law, "t")}, Dilatation::Mean,
                                                gravity, nested_dissection(model.pattern()));
  for (const auto node : given.fixed_nodes)
    EXPECT_EQ(found.body.nodes[to_index(node)], given.nodes[to_index(node)]);
  const QuadraticMesh& mesh = found.model.mesh();
  for (const Facet& facet : mesh.facets)
    for (const int node : facet)
      EXPECT_LT((mesh.X.col(node) + found.u.col(node) - model.mesh().X.col(node)).norm(), 1e-8);
}

/// A column above the height at which it buckles stands in no shape.
TEST(UnloadedShape, IsRefusedWithAReasonWhereThereIsNone) {
  constexpr double kWidth = 0.01, kYoung = 1e6;
  const double greatest = std::cbrt(7.837 * kYoung * kWidth * kWidth / 12 / (kDensity * kGravity));
  const Body given = test::make_block(test::even(0, kWidth, 1), test::even(0, kWidth, 1),
                                      test::even(0, 1.4 * greatest, 16));
  const Gravity gravity{{0, 0, -kGravity}, kDensity};
  const std::vector<Law> laws{make_law({kYoung, 0.0}, "t")};
  const SolidModel model(given, laws, Dilatation::Pointwise, gravity);
  try {
    find_unloaded_body(given, laws, Dilatation::Pointwise, gravity,
                       nested_dissection(model.pattern()));
    FAIL() << "a shape is found";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), HasSubstr("no shape without weight is found beyond 3"));
    EXPECT_THAT(error.problem(), HasSubstr("of the weight: the "));
  }
}

}  // namespace
}  // namespace palpate::fem
