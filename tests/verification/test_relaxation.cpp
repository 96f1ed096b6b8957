// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies that relax, compared with hereditary integrals of the incompressible neo-Hookean solid:
// S = mu (1 - I1/3 C^-1) at once, S(t) = integral of g(t - s) dS(s), and a pressure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fem/relaxation/branch_stresses.hpp"
#include "fem/relaxation/relaxing_press.hpp"
#include "fem/solid/solid_model.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/verification/calculix.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

using test::Prescribed;

const RelaxationSeries kSeries{{0.4, 0.1}, {0.3, 1}};
constexpr double kRamp = 0.2;  ///< s
constexpr int kRampSteps = 20;
constexpr double kPoisson = 0.4999;

/// From 0 at 0 s to 1 at the end of the ramp, then constant.
double ramp(double t) {
  return std::min(1.0, t / kRamp);
}

/// Integral of g(t - s) d value(ramp(s)), by Simpson's rule on the derivative by differences.
double hereditary(const std::function<double(double)>& value, double t) {
  constexpr int kPieces = 2000;
  const double end = std::min(t, kRamp);
  double sum = 0;
  for (int i = 0; i < kPieces; ++i) {
    const double from = end * i / kPieces, to = end * (i + 1) / kPieces;
    sum += relaxed_fraction(kSeries, t - 0.5 * (from + to)) * (value(ramp(to)) - value(ramp(from)));
  }
  return sum;
}

/// Bulk modulus of mu = 1.
double bulk_modulus(double poisson) {
  return 2 * (1 + poisson) / (3 * (1 - 2 * poisson));
}

/// A body of mu = 1 with prescribed displacements in time.
class RelaxingBody {
 public:
  explicit RelaxingBody(const Body& body, double poisson = kPoisson,
                        Dilatation dilatation = Dilatation::Mean)
      : elastic_(body, {NeoHookean::from_moduli(1, bulk_modulus(poisson))}, dilatation),
        branches_(over_one_list({kSeries}, "t"), elastic_.mesh().region),
        u_(Displacement::Zero(3, elastic_.mesh().nodes())) {}

  void advance(double h, const std::vector<Prescribed>& prescribed) {
    step_ = branches_.step(h);
    test::equilibrate(model_, test::Loads::Zero(3, mesh().nodes()), prescribed, u_);
    branches_.advance(h, elastic_.isochoric_stress(u_));
  }

  /// At the times, ascending: the ramp in even steps and the hold in one step for each.
  template <class At>
  void follow(const std::function<std::vector<Prescribed>(double)>& prescribed,
              const std::vector<double>& times, At at) {
    for (int i = 1; i <= kRampSteps; ++i)
      advance(kRamp / kRampSteps, prescribed(static_cast<double>(i) / kRampSteps));
    double now = kRamp;
    for (const double t : times) {
      if (t > now) advance(t - now, prescribed(1));
      now = t;
      at(t);
    }
  }

  Eigen::VectorXd forces() const {
    Eigen::VectorXd f;
    model_.forces(u_, f);
    return f;
  }
  const QuadraticMesh& mesh() const { return elastic_.mesh(); }
  int equation(int node) const { return elastic_.equation(node); }

 private:
  SolidModel elastic_;
  HistoryStress step_;
  SolidModel model_ = SolidModel::relaxing(elastic_, &step_);
  BranchStresses branches_;
  Displacement u_;
};

/// Force on the face at 1 across an axis, along another.
double on_face(const RelaxingBody& body, int face_axis, int axis) {
  const Eigen::VectorXd f = body.forces();
  double sum = 0;
  for (int node = 0; node < body.mesh().nodes(); ++node)
    if (body.mesh().X(face_axis, node) == 1) sum += f[body.equation(node) + axis];
  return sum;
}

constexpr auto kBlocks = "Relaxation of a block: a ramp of 0.2 s and a hold, tau = 0.1 s and 1 s";
const std::vector<double> kTimes{kRamp, 0.5, 3};

void check(const char* problem, const char* what, double t, double computed, double expected,
           double bound) {
  char name[96];
  std::snprintf(name, sizeof name, "%s at %.1f s", what, t);
  test::verify({problem, name, "mu", computed, expected, test::Reference::ClosedForm,
                "hereditary integral, incompressible neo-Hookean", bound});
}

/// P = l (S1 - S2/l^3) of the stretches l, l^-1/2, l^-1/2.
TEST(RelaxingBlock, StretchedAlongAnAxisHasTheStressOfTheHereditaryIntegral) {
  constexpr double kStretch = 1.4;
  const auto l_of = [](double part) { return 1 + (kStretch - 1) * part; };
  const auto I1 = [&](double l) { return l * l + 2 / l; };
  const auto prescribed_on = [&](const RelaxingBody& body, double part) {
    std::vector<Prescribed> list;
    for (int node = 0; node < body.mesh().nodes(); ++node)
      for (int axis = 0; axis < 3; ++axis) {
        if (body.mesh().X(axis, node) == 0) list.push_back({body.equation(node) + axis, 0});
        if (axis == 0 && body.mesh().X(axis, node) == 1)
          list.push_back({body.equation(node) + axis, l_of(part) - 1});
      }
    return list;
  };
  RelaxingBody body(test::uneven_cube());
  body.follow([&](double part) { return prescribed_on(body, part); }, kTimes,
              [&](double t) {
                const auto S1 = [&](double part) {
                  const double l = l_of(part);
                  return 1 - I1(l) / (3 * l * l);
                };
                const auto S2 = [&](double part) {
                  const double l = l_of(part);
                  return 1 - I1(l) * l / 3;
                };
                const double l = l_of(ramp(t));
                check(kBlocks, "uniaxial nominal stress, stretch 1.4", t, on_face(body, 0, 0),
                      l * (hereditary(S1, t) - hereditary(S2, t) / (l * l * l)), 1e-3);
              });
}

/// P_12 = S_12 + k S_22, whatever the pressure.
TEST(RelaxingBlock, ShearedHasTheStressOfTheHereditaryIntegral) {
  constexpr double kShear = 0.5;
  const auto prescribed_on = [&](const RelaxingBody& body, double part) {
    std::vector<Prescribed> list;
    for (int node = 0; node < body.mesh().nodes(); ++node) {
      const Eigen::Vector3d X = body.mesh().X.col(node);
      if (((X.array() > 0) && (X.array() < 1)).all()) continue;
      for (int axis = 0; axis < 3; ++axis)
        list.push_back({body.equation(node) + axis, axis == 0 ? kShear * part * X[1] : 0});
    }
    return list;
  };
  RelaxingBody body(test::uneven_cube());
  body.follow([&](double part) { return prescribed_on(body, part); }, kTimes,
              [&](double t) {
                const auto S12 = [&](double part) {
                  const double k = kShear * part;
                  return k * (3 + k * k) / 3;
                };
                const auto S22 = [&](double part) { return -std::pow(kShear * part, 2) / 3; };
                check(kBlocks, "simple shear of 0.5", t, on_face(body, 1, 0),
                      hereditary(S12, t) + kShear * ramp(t) * hereditary(S22, t), 1e-3);
              });
}

/// Elements on one set of nodes with springs and dashpots of small strains: an elastic part of
/// g_inf mu, and one for each branch, whose deviatoric stress relaxes as a Maxwell element since it
/// creeps with the rate (3/2) s/(3 g_i mu tau_i) [Norton's law, exponent 1]. They share kappa.
std::string maxwell_elements(const QuadraticMesh& mesh, double poisson) {
  std::ostringstream deck;
  deck.precision(15);
  deck << "*NODE, NSET=ALL\n";
  for (int node = 0; node < mesh.nodes(); ++node) {
    deck << node + 1;
    for (int axis = 0; axis < 3; ++axis) deck << ',' << mesh.X(axis, node);
    deck << '\n';
  }
  std::size_t number = 0;
  const auto part = [&](const std::string& name, double fraction, double time) {
    deck << "*ELEMENT, TYPE=C3D10, ELSET=" << name << '\n';
    for (const auto& nodes : mesh.tetrahedra) {
      deck << ++number;
      for (const auto node : nodes) deck << ',' << node + 1;
      deck << '\n';
    }
    deck << "*MATERIAL, NAME=" << name << "\n*ELASTIC\n"
         << 2 * (1 + poisson) * fraction << ',' << poisson << '\n';
    if (time > 0) deck << "*CREEP, LAW=NORTON\n" << 1 / (3 * fraction * time) << ",1.,0.\n";
    deck << "*SOLID SECTION, ELSET=" << name << ", MATERIAL=" << name << '\n';
  };
  part("RUBBER", long_term_fraction(kSeries), 0);
  for (std::size_t i = 0; i < kSeries.size(); ++i)
    part("BRANCH" + std::to_string(i), kSeries[i].fraction, kSeries[i].time_s);
  return deck.str();
}

constexpr double kSqueeze = 1e-3;  ///< so that the strain is small
constexpr double kSqueezedPoisson = 0.4;

/// The base is held, the top moves down by kSqueeze without moving sideways; then it rests.
std::string squeezing_deck(const QuadraticMesh& mesh) {
  std::ostringstream deck;
  deck << maxwell_elements(mesh, kSqueezedPoisson);
  for (const int level : {0, 1}) {
    deck << "*NSET, NSET=LEVEL" << level << '\n';
    for (int node = 0; node < mesh.nodes(); ++node)
      if (mesh.X(2, node) == level) deck << node + 1 << ",\n";
  }
  // Without an amplitude a viscous step moves the top at once.
  deck << "*BOUNDARY\nLEVEL0,1,3\nLEVEL1,1,2\n*AMPLITUDE, NAME=RAMP\n0.,0.," << kRamp << ",1.\n";
  double now = 0;
  for (const double end : kTimes) {
    const bool ramping = now == 0;
    const char* increment = ramping ? "0.005" : "0.02";
    deck << "*STEP, INC=100000\n*VISCO, CETOL=1.\n"
         << increment << ',' << end - now << ",1e-8," << increment << '\n'
         << (ramping ? "*BOUNDARY, AMPLITUDE=RAMP\n" : "*BOUNDARY\n") << "LEVEL1,3,3," << -kSqueeze
         << '\n'
         << "*NODE PRINT, NSET=LEVEL1, TOTALS=ONLY, FREQUENCY=100000\nRF\n*END STEP\n";
    now = end;
  }
  return deck.str();
}

/// The stress is not even, and the material compressible: no hereditary integral of one curve.
TEST(RelaxingBlock, SqueezedBetweenPlatesHasTheForceOfMaxwellElementsInCalculix) {
  RelaxingBody body(test::uneven_cube(), kSqueezedPoisson, Dilatation::Pointwise);
  const auto printed =
      test::numbers_below<3>("total force", test::printed_by_calculix(squeezing_deck(body.mesh())));
  ASSERT_EQ(printed.size(), kTimes.size());
  const auto prescribed_on = [&](double part) {
    std::vector<Prescribed> list;
    for (int node = 0; node < body.mesh().nodes(); ++node)
      for (int axis = 0; axis < 3; ++axis) {
        const double height = body.mesh().X(2, node);
        if (height == 0 || height == 1)
          list.push_back({body.equation(node) + axis, axis == 2 ? -kSqueeze * part * height : 0});
      }
    return list;
  };
  std::size_t i = 0;
  body.follow(prescribed_on, kTimes, [&](double t) {
    char name[64];
    std::snprintf(name, sizeof name, "force at %.1f s", t);
    test::verify({"Relaxation of a block squeezed by 0.001 between plates, nu = 0.4", name, "mu",
                  on_face(body, 2, 2), printed[i++][2], test::Reference::OtherSolver,
                  "CalculiX, Maxwell elements on the same nodes", 5e-3});
  });
}

/// Radii 1 and 2. p = integral of 2 (sigma_t - sigma_r) dr/r, with hoop stretch l, radial l^-2.
double inner_pressure(double inner_stretch, double t) {
  constexpr int kShells = 100;
  double p = 0;
  for (int i = 0; i < kShells; ++i) {
    const double R = 1 + (i + 0.5) / kShells, dR = 1.0 / kShells;
    const auto hoop = [&](double part) {
      const double inner = 1 + (inner_stretch - 1) * part;
      return std::cbrt(1 + (inner * inner * inner - 1) / (R * R * R));
    };
    const auto I1 = [](double l) { return 2 * l * l + std::pow(l, -4); };
    const auto S_t = [&](double part) {
      const double l = hoop(part);
      return 1 - I1(l) / (3 * l * l);
    };
    const auto S_r = [&](double part) {
      const double l = hoop(part);
      return 1 - I1(l) * std::pow(l, 4) / 3;
    };
    const double l = hoop(ramp(t));
    const double difference = l * l * hereditary(S_t, t) - std::pow(l, -4) * hereditary(S_r, t);
    p += 2 * difference * dR / (R * l * l * l);  // dr/r = dR/(R l^3)
  }
  return p;
}

/// An octant between its planes of symmetry, the nodes of its inner wall moved outwards.
TEST(RelaxingSphere, InflatedAndHeldHasThePressureOfTheHereditaryIntegral) {
  constexpr double kStretch = 1.5;
  constexpr int kLayers = 5;
  const Body octant =
      test::make_prisms(test::octant_of_sphere(6), kLayers, [](const Vec3& x, int layer) {
        return std::pow(2.0, layer / static_cast<double>(kLayers)) * x;
      });
  RelaxingBody body(octant);
  const QuadraticMesh& mesh = body.mesh();
  double hollow = 0;
  std::vector<Prescribed> wall, planes;
  std::vector<bool> known(to_index(mesh.nodes()), false);
  for (const Facet& f : mesh.facets) {
    const bool inside = std::ranges::all_of(f, [&](int node) {
      return node >= static_cast<int>(octant.nodes.size()) || mesh.X.col(node).norm() < 1 + 1e-9;
    });
    if (!inside) continue;
    hollow -= mesh.X.col(f[0]).dot(mesh.X.col(f[1]).cross(mesh.X.col(f[2]))) / 6;
    for (const auto node : f) {
      for (int i = 0; i < 3 && !known[to_index(node)]; ++i)
        wall.push_back({body.equation(node) + i, mesh.X(i, node)});
      known[to_index(node)] = true;
    }
  }
  for (int node = 0; node < mesh.nodes(); ++node)
    for (int i = 0; i < 3; ++i)
      if (std::abs(mesh.X(i, node)) < 1e-9) planes.push_back({body.equation(node) + i, 0});
  const auto prescribed = [&](double part) {
    std::vector<Prescribed> list = wall;
    for (Prescribed& entry : list) entry.value *= (kStretch - 1) * part;
    list.insert(list.end(), planes.begin(), planes.end());
    return list;
  };
  body.follow(prescribed, kTimes, [&](double t) {
    const Eigen::VectorXd f = body.forces();
    double slope = 0;
    for (const auto& [unknown, X] : wall) slope += f[unknown] * X;
    const double stretch = 1 + (kStretch - 1) * ramp(t);
    check("Relaxation of a thick sphere 1:2: inflated in 0.2 s and held, tau = 0.1 s and 1 s",
          "pressure, inner stretch 1.5", t, slope / (3 * stretch * stretch * hollow),
          inner_pressure(kStretch, t), 5e-3);
  });
}

/// A sphere pressed by a hundredth of its radius into nearly incompressible tissue: while the
/// contact grows, the force is the hereditary integral of that of the elastic body [Lee & Radok
/// 1960], here that of the same mesh, so that its discretization error cancels.
TEST(RelaxingIndentation, OfAGrowingContactIsTheHereditaryIntegralOfLeeAndRadok) {
  const Body body = test::graded_block(0.02, 0.0015, 1.5e-3, 3);
  const std::int32_t site = test::site_nearest(body);
  CampaignSettings settings;
  settings.indentation.tool.radius = 0.01;
  settings.indentation.depth = 1e-4;
  settings.indentation.increments = 20;
  settings.indentation.force_tolerance = 1e-6;
  settings.indentation.lateral_depths.clear();
  const std::vector<ToolMotion> motion{{0, 0}, {kRamp, 1e-4}, {1, 1e-4}};
  const auto press = [&](const RelaxationSeries& series) {
    settings.materials = {{"tissue", {10e3, 0.4995}, 0, series}};
    const RelaxingPress found = press_relaxing(body, settings, site, motion, {3e-4, 2000});
    EXPECT_TRUE(found.complete) << found.reason;
    return found.samples;
  };
  const std::vector<RelaxingSample> elastic = press({}), relaxing = press(kSeries);
  const auto force = [](const RelaxingSample& sample) { return -sample.force[2]; };
  const auto expected = [&](double t) {
    double sum = 0;
    for (std::size_t i = 1; i < elastic.size() && elastic[i].time_s <= kRamp * (1 + 1e-9); ++i)
      sum += relaxed_fraction(kSeries, t - 0.5 * (elastic[i].time_s + elastic[i - 1].time_s)) *
             (force(elastic[i]) - force(elastic[i - 1]));
    return sum;
  };
  const double peak = force(elastic.back());
  for (const RelaxingSample& sample : relaxing) {
    const bool end = sample.time_s == kRamp || sample.time_s == 1;
    if (!end) continue;
    char name[96];
    std::snprintf(name, sizeof name, "force over that of the elastic body at %.1f s",
                  sample.time_s);
    test::verify({"Relaxation of an indentation, d/R = 0.01: pressed in 0.2 s and held", name, "1",
                  force(sample) / peak, expected(sample.time_s) / peak, test::Reference::Theory,
                  "Lee & Radok 1960", 0.003});
  }
}

}  // namespace
}  // namespace palpate::fem
