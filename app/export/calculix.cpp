// SPDX-License-Identifier: AGPL-3.0-or-later
// Keywords as in the CalculiX CrunchiX user's manual 2.20.
#include <fmt/format.h>

#include <array>
#include <iterator>

#include "app/export/deck.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

/// A coefficient of (J - 1)^4 and higher terms that adds nothing; zero would mean a default.
constexpr double kNone = 1e20;
/// Contact without slip: a friction coefficient and the tangential stiffness over that of the
/// contact, of a no-slip press and of a surface that sticks once it is pressed. With larger ones
/// the iterations of CalculiX take several times as long or do not end.
constexpr double kFriction = 5, kStick = 0.03, kStickOncePressed = 0.01;
/// Without friction: CalculiX changes only a friction that there is.
constexpr double kSliding = 1e-6;

std::string list(std::initializer_list<double> values) {
  std::string text;
  std::size_t count = 0;
  for (const double value : values) {
    text += fmt::format("{:.10g}", value);
    // At most eight constants a line, as the manual has it; and no line ends in a comma otherwise.
    if (++count < values.size()) text += count % 8 == 0 ? ",\n" : ",";
  }
  return text + "\n";
}

/// The *HYPERELASTIC (or *ELASTIC) card of a law; empty where there is none.
std::string law_card(const fem::LawConstants& c) {
  const fem::RestModuli rest = fem::rest_moduli(c);
  const double D = 2 / rest.kappa();
  if (c.law == "neo-hookean") return "*HYPERELASTIC, NEO HOOKE\n" + list({rest.mu() / 2, D});
  if (c.law == "mooney-rivlin") {
    return "*HYPERELASTIC, MOONEY-RIVLIN\n" + list({c.at("C10"), c.at("C01"), D});
  }
  if (c.law == "mooney-rivlin-5") {
    return "*HYPERELASTIC, POLYNOMIAL, N=2\n" +
           list({c.at("C10"), c.at("C01"), c.at("C20"), c.at("C11"), c.at("C02"), D, kNone});
  }
  if (c.law == "yeoh") {
    return "*HYPERELASTIC, YEOH\n" + list({c.at("C10"), c.at("C20"), c.at("C30"), D, kNone, kNone});
  }
  if (c.law == "ogden-1") {
    return "*HYPERELASTIC, OGDEN, N=1\n" + list({c.at("mu_1"), c.at("alpha_1"), D});
  }
  if (c.law == "ogden-2") {
    return "*HYPERELASTIC, OGDEN, N=2\n" +
           list({c.at("mu_1"), c.at("alpha_1"), c.at("mu_2"), c.at("alpha_2"), D, kNone});
  }
  if (c.law == "ogden-3") {
    return "*HYPERELASTIC, OGDEN, N=3\n" +
           list({c.at("mu_1"), c.at("alpha_1"), c.at("mu_2"), c.at("alpha_2"), c.at("mu_3"),
                 c.at("alpha_3"), D, kNone, kNone});
  }
  if (c.law == "arruda-boyce") {
    // The parameter of CalculiX is the modulus mu' before the series: mu = mu' (1 + 3/(5 l^2) +
    // ...).
    const double n = c.at("lambda_m") * c.at("lambda_m");
    const double series = 1 + 3 / (5 * n) + 99 / (175 * n * n) + 513 / (875 * n * n * n) +
                          42039 / (67375 * n * n * n * n);
    return "*HYPERELASTIC, ARRUDA-BOYCE\n" + list({c.at("mu") / series, c.at("lambda_m"), D});
  }
  if (c.law == "saint-venant-kirchhoff") return "*ELASTIC\n" + list({rest.young, rest.poisson});
  return {};
}

class CalculixWriter {
 public:
  explicit CalculixWriter(const Deck& deck) : deck_(deck) {}

  std::string write() {
    add("*HEADING\n{}\n** SI units: m, N, Pa\n", deck_.title);
    nodes("ALL", deck_.mesh.X, 0);
    for (std::size_t region = 0; region < deck_.laws.size(); ++region) elements(region);
    node_set("FIXED", fixed());
    if (deck_.tool)
      tool(*deck_.tool);
    else
      node_set("PATCH", deck_.patch);
    steps(deck_.tool ? "TOOL" : "PATCH");
    return std::move(out_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }

  void nodes(const char* set, const Eigen::Matrix3Xd& X, Eigen::Index before) {
    add("*NODE, NSET={}\n", set);
    for (Eigen::Index i = 0; i < X.cols(); ++i) {
      add("{},{:.12e},{:.12e},{:.12e}\n", before + i + 1, X(0, i), X(1, i), X(2, i));
    }
  }

  void element(std::size_t number, const fem::Tetrahedron10& nodes, Eigen::Index nodes_before) {
    add("{}", number);
    for (const std::int32_t node : nodes) add(",{}", nodes_before + node + 1);
    add("\n");
  }

  void elements(std::size_t region) {
    const auto& mesh = deck_.mesh;
    const std::string card = law_card(deck_.laws[region]);
    if (card.empty()) {
      throw Error(ErrorKind::Configuration,
                  "material of region '" + deck_.region_names[region] + "'",
                  "CalculiX has no law like " + deck_.laws[region].law,
                  "compare with a law that it has: neo-hookean, mooney-rivlin, mooney-rivlin-5, "
                  "yeoh, ogden, arruda-boyce, saint-venant-kirchhoff");
    }
    // Names by number: those of the case may hold what CalculiX does not take.
    add("** region {}: {}\n*ELEMENT, TYPE=C3D10, ELSET=REGION{}\n", deck_.region_names[region],
        deck_.laws[region].law, region + 1);
    for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
      if (mesh.region[e] != static_cast<std::int32_t>(region)) continue;
      element(e + 1, mesh.tetrahedra[e], 0);
    }
    add("*MATERIAL, NAME=LAW{0}\n{1}*SOLID SECTION, ELSET=REGION{0}, MATERIAL=LAW{0}\n", region + 1,
        card);
  }

  std::vector<std::int32_t> fixed() const {
    std::vector<std::int32_t> nodes;
    const auto& mesh = deck_.mesh;
    for (std::size_t node = 0; node < mesh.fixed.size(); ++node) {
      if (mesh.fixed[node]) nodes.push_back(static_cast<std::int32_t>(node));
    }
    return nodes;
  }

  void node_set(const char* name, const std::vector<std::int32_t>& nodes) {
    add("*NSET, NSET={}\n", name);
    for (const std::int32_t node : nodes) add("{},\n", node + 1);
  }

  /// The tool beside the body, every node of it moved alike, and its contact.
  void tool(const PressingTool& tool) {
    const Eigen::Index nodes_before = deck_.mesh.X.cols();
    nodes("TOOL", tool.mesh.X, nodes_before);
    add("*ELEMENT, TYPE=C3D10, ELSET=TOOL\n");
    for (std::size_t e = 0; e < tool.mesh.tetrahedra.size(); ++e) {
      element(deck_.mesh.tetrahedra.size() + e + 1, tool.mesh.tetrahedra[e], nodes_before);
    }
    // Rigid by its motion: what it is made of does not matter.
    add("*MATERIAL, NAME=TOOL\n*ELASTIC\n1.e6,0.\n*SOLID SECTION, ELSET=TOOL, MATERIAL=TOOL\n");
    add("*SURFACE, NAME=SKIN, TYPE=ELEMENT\n");
    for (const ElementSide& s : tool.skin) add("{},S{}\n", s.element + 1, s.side + 1);
    add("*SURFACE, NAME=TOOL, TYPE=ELEMENT\nTOOL,S1\n"
        "*SURFACE INTERACTION, NAME=CONTACT\n"
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{:.10g}\n"
        "{}*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\nSKIN,TOOL\n",
        tool.stiffness, friction_of_press());
  }

  std::string friction(double coefficient) const {
    const double stick = deck_.no_slip ? kStick : kStickOncePressed;
    return fmt::format("*FRICTION\n{:.10g},{:.10g}\n", coefficient, stick * deck_.tool->stiffness);
  }
  std::string friction_of_press() const {
    if (deck_.no_slip) return friction(kFriction);
    return deck_.lateral ? friction(kSliding) : "";
  }

  /// `moved`: the node set that is moved to `target`.
  void step(const char* moved, const Vec3& target, int increments, const std::string& changes) {
    const double first = 1.0 / increments;
    add("*STEP, NLGEOM, INC=10000\n*STATIC\n{0:.10g},1.,{1:.3g},{0:.10g}\n{2}", first, 1e-4 * first,
        changes);
    // The default lets the forces be off by half a percent.
    add("*CONTROLS, PARAMETERS=FIELD\n1.e-5,1.e-3\n*BOUNDARY\n");
    for (std::size_t i = 0; i < 3; ++i) add("{0},{1},{1},{2:.12e}\n", moved, i + 1, target[i]);
    add("*NODE PRINT, NSET={}, TOTALS=ONLY\nRF\n*END STEP\n", moved);
  }

  void steps(const char* moved) {
    const Vec3 pressed = deck_.depth * deck_.direction;
    add("*BOUNDARY\nFIXED,1,3\n");
    step(moved, pressed, deck_.increments, "");
    if (!deck_.lateral) return;
    const LateralMove& lateral = *deck_.lateral;
    step(moved, pressed + lateral.travel * lateral.direction, lateral.increments,
         deck_.no_slip ? "" : "*CHANGE FRICTION, INTERACTION=CONTACT\n" + friction(kFriction));
  }

  const Deck& deck_;
  std::string out_;
};

}  // namespace

std::string calculix_deck(const Deck& deck) {
  if (deck.relaxes())
    refuse("site", "CalculiX has no law that relaxes by a series, and tissue of the case does",
           "export for FEBio (--febio), or a case without relaxation");
  return CalculixWriter(deck).write();
}

}  // namespace palpate::app
