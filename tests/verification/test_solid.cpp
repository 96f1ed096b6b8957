// SPDX-License-Identifier: AGPL-3.0-or-later
// The solid without a tool: locking and bending, inflation, rates of convergence.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "fem/laws/invariant_energies.hpp"
#include "fem/solid/solid_model.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Comparison;

double bulk_modulus(double mu, double nu) {
  return 2 * mu * (1 + nu) / (3 * (1 - 2 * nu));
}

/// Fixes every node along one axis.
std::vector<test::Prescribed> at_rest_along(const SolidModel& model, int axis) {
  std::vector<test::Prescribed> list;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0) list.push_back({model.equation(node) + axis, 0});
  return list;
}

/// Cook's membrane in plane strain: millimetres and megapascals, one layer of cells 1 mm thick.
/// The deflection is that of the middle of the loaded edge, (48, 52), as in the published table.
double cook_deflection(int cells) {
  Body body = test::make_block(test::even(0, 1, cells), test::even(0, 1, cells), {0, 1});
  test::deform(body, [](const Vec3& x) {
    const double low = 44 * x[0], high = 44 + 16 * x[0];
    return Vec3{48 * x[0], low + (high - low) * x[1], x[2]};
  });
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    if (body.nodes[i][0] == 0) body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  const double mu = 0.4225;
  const SolidModel model(body, {NeoHookean::from_moduli(mu, bulk_modulus(mu, 0.3))});
  const test::Loads loads = test::traction_loads(
      model.mesh(), Vector3d(0, 1.0 / 16, 0), [](const Vector3d& X) { return X[0] > 48 - 1e-9; });
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  for (const double fraction : {0.25, 0.5, 0.75, 1.0})
    test::equilibrate(model, fraction * loads, at_rest_along(model, 2), u);
  double deflection = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if ((model.mesh().X.col(node) - Vector3d(48, 52, 0)).norm() < 1e-9) deflection = u(1, node);
  return deflection;
}

TEST(Solid, CookMembraneBendsWithoutLocking) {
  const double coarse = cook_deflection(4), fine = cook_deflection(12);
  EXPECT_LT(std::abs(fine - 14.74), std::abs(coarse - 14.74));
  test::verify({"Cook's membrane, nu = 0.3, plane strain",
                "deflection of the middle of the loaded edge, 12 x 12 cells", "mm", fine, 14.74,
                test::Reference::Published, "deal.II code gallery, doi 10.5281/zenodo.1228964",
                0.005});
}

/// p/mu of a thick sphere of radii 1 and 2, of incompressible neo-Hookean solid, by its inner
/// stretch: [2/l + 1/(2 l^4)] at the outer minus at the inner stretch.
double inflation(double inner) {
  const double outer = std::cbrt(1 + (inner * inner * inner - 1) / 8);
  const auto g = [](double l) { return 2 / l + 0.5 / (l * l * l * l); };
  return g(outer) - g(inner);
}

/// An octant of a shell of radii 1 and 2 between its planes of symmetry, the nodes of its inner
/// wall moved outwards in proportion to their position.
class OctantOfSphere {
 public:
  using LawOf = std::function<Law(double bulk_modulus)>;

  /// @param law_of a law with a shear modulus of 1 and the given bulk modulus
  OctantOfSphere(int divisions, int layers, LawOf law_of, Dilatation dilatation = Dilatation::Mean)
      : law_of_(std::move(law_of)),
        dilatation_(dilatation),
        body_(test::make_prisms(test::octant_of_sphere(divisions), layers,
                                [layers](const Vec3& x, int layer) {
                                  return std::pow(2.0, layer / static_cast<double>(layers)) * x;
                                })) {
    const SolidModel model = with_poisson(0.3);
    find_wall(model);
    find_planes(model);
    path_ = Displacement::Zero(3, model.mesh().nodes());
  }

  SolidModel with_poisson(double nu) const {
    return {body_, {law_of_(bulk_modulus(1, nu))}, dilatation_};
  }

  /// Pressure over mu in the incompressible limit, extrapolated from two values of mu/kappa, to
  /// which the error is proportional. Stretches must ascend.
  double pressure(double stretch) {
    const SolidModel soft = with_poisson(0.49), stiff = with_poisson(0.499),
                     stiffest = with_poisson(0.4999);
    for (; reached_ < stretch - 1e-9; reached_ += 0.125) inflate(soft, reached_ + 0.125, path_);
    Displacement u = path_;
    inflate(stiff, stretch, u);
    const double p = wall_pressure(stiff, stretch, u);
    inflate(stiffest, stretch, u);
    const double q = wall_pressure(stiffest, stretch, u);
    const double ratio = bulk_modulus(1, 0.4999) / bulk_modulus(1, 0.499);
    return q + (q - p) / (ratio - 1);
  }

 private:
  void find_wall(const SolidModel& model) {
    const QuadraticMesh& mesh = model.mesh();
    std::vector<bool> known(to_index(mesh.nodes()), false);
    for (const Facet& f : mesh.facets) {
      const bool inside = std::ranges::all_of(
          f, [&](int node) { return node >= corners() || mesh.X.col(node).norm() < 1 + 1e-9; });
      if (!inside) continue;
      hollow_ -= mesh.X.col(f[0]).dot(mesh.X.col(f[1]).cross(mesh.X.col(f[2]))) / 6;
      for (const auto node : f) {
        for (int i = 0; i < 3 && model.equation(node) >= 0 && !known[to_index(node)]; ++i)
          wall_.push_back({model.equation(node) + i, mesh.X(i, node)});
        known[to_index(node)] = true;
      }
    }
  }
  void find_planes(const SolidModel& model) {
    for (int node = 0; node < model.mesh().nodes(); ++node)
      for (int i = 0; i < 3 && model.equation(node) >= 0; ++i)
        if (std::abs(model.mesh().X(i, node)) < 1e-9)
          planes_.push_back({model.equation(node) + i, 0});
  }
  int corners() const { return static_cast<int>(body_.nodes.size()); }

  void inflate(const SolidModel& model, double stretch, Displacement& u) const {
    auto prescribed = wall_;
    for (auto& entry : prescribed) entry.value *= stretch - 1;
    prescribed.insert(prescribed.end(), planes_.begin(), planes_.end());
    test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), prescribed, u);
  }

  /// From p dV = dE of a hollow that grows as V = stretch^3 V0.
  double wall_pressure(const SolidModel& model, double stretch, const Displacement& u) const {
    Eigen::VectorXd f;
    model.forces(u, f);
    double slope = 0;
    for (const auto& [unknown, X] : wall_) slope += f[unknown] * X;
    return slope / (3 * stretch * stretch * hollow_);
  }

  LawOf law_of_;
  Dilatation dilatation_;
  Body body_;
  double hollow_ = 0;                   ///< volume between the inner facets and the centre
  std::vector<test::Prescribed> wall_;  ///< its unknowns, with their reference coordinates
  std::vector<test::Prescribed> planes_;
  Displacement path_;
  double reached_ = 1;
};

constexpr auto kThickSphere = "Thick sphere 1:2, inflated, incompressible";

std::string at_stretch(double stretch) {
  char name[64];
  std::snprintf(name, sizeof name, "pressure over mu at an inner stretch of %.2f", stretch);
  return name;
}

TEST(Solid, ThickSphereInflates) {
  OctantOfSphere sphere(8, 6, [](double kappa) { return NeoHookean::from_moduli(1, kappa); });
  for (const double stretch : {1.25, 1.5, 2.0})
    test::verify({kThickSphere, at_stretch(stretch), "1", sphere.pressure(stretch),
                  inflation(stretch), test::Reference::ClosedForm, "neo-Hookean", 0.003});
}

/// Linear displacements alone would lock: they have about one free displacement for each element
/// whose volume is constrained.
TEST(Solid, ThickSphereOfLinearElementsInflatesWithoutLocking) {
  OctantOfSphere sphere(
      8, 6, [](double kappa) { return NeoHookean::from_moduli(1, kappa); },
      Dilatation::LinearNodal);
  for (const double stretch : {1.25, 1.5})
    test::verify({kThickSphere, at_stretch(stretch) + ", Tet4, nodal pressure", "1",
                  sphere.pressure(stretch), inflation(stretch), test::Reference::ClosedForm,
                  "neo-Hookean", 0.05});
}

TEST(Solid, ThickSphereOfMooneyRivlinInflates) {
  OctantOfSphere sphere(8, 6,
                        [](double kappa) { return MooneyRivlin({.C10 = 0.4, .C01 = 0.1}, kappa); });
  for (const auto& [stretch, expected] :
       {std::pair{1.25, 0.583743}, std::pair{1.5, 0.847427}, std::pair{2.0, 1.033830}})
    test::verify({kThickSphere, at_stretch(stretch) + ", Mooney-Rivlin, C01/C10 = 1/4", "1",
                  sphere.pressure(stretch), expected, test::Reference::ClosedForm,
                  "Mooney-Rivlin, six digits", 0.003});
}

/// A smooth finite deformation of the unit cube. The isochoric one has no pressure from the law;
/// the other has a pressure that varies.
struct Manufactured {
  double mu = 1, kappa = bulk_modulus(1, 0.3);
  bool isochoric = true;

  Vector3d u(const Vector3d& X) const {
    if (isochoric)
      return {0.06 * std::sin(2 * X[1]) * std::cos(X[2]), 0, 0.08 * std::sin(3 * X[1])};
    return 0.06 * Vector3d(std::sin(2 * X[1]) * X[2], std::cos(2 * X[2] + X[0]),
                           std::sin(X[0] + 2 * X[1]));
  }
  Matrix3d F(const Vector3d& X) const {
    Matrix3d f = Matrix3d::Identity();
    if (isochoric) {
      f(0, 1) = 0.12 * std::cos(2 * X[1]) * std::cos(X[2]);
      f(0, 2) = -0.06 * std::sin(2 * X[1]) * std::sin(X[2]);
      f(2, 1) = 0.24 * std::cos(3 * X[1]);
      return f;
    }
    f(0, 1) += 0.12 * std::cos(2 * X[1]) * X[2];
    f(0, 2) += 0.06 * std::sin(2 * X[1]);
    f(1, 0) -= 0.06 * std::sin(2 * X[2] + X[0]);
    f(1, 2) -= 0.12 * std::sin(2 * X[2] + X[0]);
    f(2, 0) += 0.06 * std::cos(X[0] + 2 * X[1]);
    f(2, 1) += 0.12 * std::cos(X[0] + 2 * X[1]);
    return f;
  }
  /// P = mu J^(-2/3) (F - I1/3 F^-T) + kappa/2 (J - 1/J) J F^-T.
  Matrix3d P(const Vector3d& X) const {
    const Matrix3d f = F(X), G = f.inverse().transpose();
    const double J = f.determinant();
    return mu * std::pow(J, -2.0 / 3) * (f - f.squaredNorm() / 3 * G) +
           0.5 * kappa * (J * J - 1) * G;
  }
  /// -Div P, by central differences of fourth order.
  Vector3d body_force(const Vector3d& X) const {
    Vector3d b = Vector3d::Zero();
    const double h = 1e-3;
    for (int j = 0; j < 3; ++j) {
      const auto column = [&](double s) {
        return Vector3d(P(X + s * h * Vector3d::Unit(j)).col(j));
      };
      b -= (8 * (column(1) - column(-1)) - (column(2) - column(-2))) / (12 * h);
    }
    return b;
  }
};

struct Norms {
  double displacement, gradient;
};

Norms manufactured_errors(const Manufactured& exact, Dilatation dilatation, int cells) {
  Body body =
      test::make_block(test::even(0, 1, cells), test::even(0, 1, cells), test::even(0, 1, cells));
  body.fixed_nodes.clear();
  std::vector<bool> outside(body.nodes.size(), false);
  for (const auto& t : body.boundary)
    for (const auto node : t) outside[to_index(node)] = true;
  for (std::size_t i = 0; i < outside.size(); ++i)
    if (outside[i]) body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  const SolidModel model(body, {NeoHookean::from_moduli(exact.mu, exact.kappa)}, dilatation);
  const QuadraticMesh& mesh = model.mesh();
  Displacement u(3, mesh.nodes());
  for (int node = 0; node < mesh.nodes(); ++node) u.col(node) = exact.u(mesh.X.col(node));
  straighten(mesh, u);
  test::equilibrate(
      model, test::body_loads(mesh, [&](const Vector3d& X) { return exact.body_force(X); }), {}, u);
  Norms squares{0, 0};
  test::for_each_volume_point(mesh, [&](const test::VolumePoint& p) {
    Vector3d value = -exact.u(p.X);
    Matrix3d gradient = Matrix3d::Identity() - exact.F(p.X);
    for (std::size_t n = 0; n < kTetNodes; ++n) {
      const Vector3d un = u.col(mesh.tetrahedra[p.element][n]);
      value += p.N[n] * un;
      gradient += un * p.dN[n].transpose();
    }
    squares.displacement += p.volume * value.squaredNorm();
    squares.gradient += p.volume * gradient.squaredNorm();
  });
  return {std::sqrt(squares.displacement), std::sqrt(squares.gradient)};
}

constexpr auto kRates = "Rates of convergence to a manufactured solution, 4 to 8 cells unless said";
constexpr auto kTheory = "order of the element [Brezzi & Fortin 1991]";

/// Orders of convergence of the displacement (L2) and of its gradient (H1) from a number of cells
/// to twice as many.
Norms rates(const Manufactured& exact, Dilatation dilatation, int cells = 4) {
  const Norms a = manufactured_errors(exact, dilatation, cells),
              b = manufactured_errors(exact, dilatation, 2 * cells);
  return {std::log2(a.displacement / b.displacement), std::log2(a.gradient / b.gradient)};
}

void verify_rate(const std::string& norm, const std::string& name, double rate, double expected) {
  test::verify({kRates, norm + ", " + name, "1", rate, expected, test::Reference::Theory, kTheory,
                0.15, test::Error::Absolute});
}

Manufactured pressing(double nu) {
  Manufactured exact;
  exact.isochoric = false;
  exact.kappa = bulk_modulus(exact.mu, nu);
  return exact;
}

TEST(Solid, QuadraticDisplacementsConvergeAsSuch) {
  const Norms constant = rates({}, Dilatation::Mean);
  const std::string isochoric = "element-constant pressure, isochoric deformation";
  verify_rate("displacement (L2)", isochoric, constant.displacement, 3);
  verify_rate("gradient (H1)", isochoric, constant.gradient, 2);
  const Norms pure = rates(pressing(0.3), Dilatation::Pointwise);
  const std::string compressing = "pure displacements, compressing deformation, nu = 0.3";
  verify_rate("displacement (L2)", compressing, pure.displacement, 3);
  verify_rate("gradient (H1)", compressing, pure.gradient, 2);
}

TEST(Solid, LinearDisplacementsConvergeAsSuch) {
  for (const double nu : {0.3, 0.49}) {
    const Norms linear = rates(pressing(nu), Dilatation::LinearNodal);
    char name[80];
    std::snprintf(name, sizeof name, "Tet4, nodal pressure, compressing deformation, nu = %.2g",
                  nu);
    verify_rate("displacement (L2)", name, linear.displacement, 2);
    verify_rate("gradient (H1)", name, linear.gradient, 1);
  }
}

/// Near nu = 1/2 on this regular mesh element-constant pressures converge more slowly than their
/// order, because they are not inf-sup stable (test_pressure.cpp); nodal pressures are.
TEST(Solid, PressuresLimitTheRates) {
  verify_rate("displacement (L2)", "element-constant pressure, compressing deformation, nu = 0.3",
              rates(pressing(0.3), Dilatation::Mean).displacement, 2);
  const Norms constant = rates(pressing(0.49), Dilatation::Mean);
  const Norms nodal = rates(pressing(0.49), Dilatation::Nodal, 5);
  verify_rate("gradient (H1)", "nodal pressure, compressing deformation, nu = 0.49, 5 to 10 cells",
              nodal.gradient, 2);
  EXPECT_LT(constant.gradient, nodal.gradient - 0.5);
}

}  // namespace
}  // namespace palpate::fem
