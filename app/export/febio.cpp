// SPDX-License-Identifier: AGPL-3.0-or-later
// Sections and parameters as in the FEBio user's manual, file format 4.0.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "app/export/deck.hpp"
#include "app/markup.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

using Parameters = std::vector<std::pair<std::string, double>>;

struct FebioLaw {
  std::string type;  ///< empty where FEBio has no such law
  Parameters parameters;
};

Parameters ogden_parameters(const fem::LawConstants& c, int terms) {
  Parameters parameters;
  for (int i = 1; i <= terms; ++i) {
    // FEBio: sum of c_i/m_i^2 (...).
    parameters.emplace_back(fmt::format("c{}", i), 2 * c.at(fmt::format("mu_{}", i)));
    parameters.emplace_back(fmt::format("m{}", i), c.at(fmt::format("alpha_{}", i)));
  }
  return parameters;
}

/// Uncoupled laws of the same isochoric energy. Its Arruda-Boyce has other coefficients.
FebioLaw febio_law(const fem::LawConstants& c) {
  const fem::RestModuli rest = fem::rest_moduli(c);
  if (c.law == "neo-hookean") return {"Mooney-Rivlin", {{"c1", rest.mu() / 2}, {"c2", 0}}};
  if (c.law == "mooney-rivlin") {
    return {"Mooney-Rivlin", {{"c1", c.at("C10")}, {"c2", c.at("C01")}}};
  }
  if (c.law == "yeoh") {
    // Its stress is that of W = sum of c_i/i (I1 - 3)^i, although the energy it prints is not.
    return {"Yeoh", {{"c1", c.at("C10")}, {"c2", 2 * c.at("C20")}, {"c3", 3 * c.at("C30")}}};
  }
  if (c.law == "ogden-1") return {"Ogden", ogden_parameters(c, 1)};
  if (c.law == "ogden-2") return {"Ogden", ogden_parameters(c, 2)};
  if (c.law == "ogden-3") return {"Ogden", ogden_parameters(c, 3)};
  if (c.law == "veronda-westmann") {
    return {"Veronda-Westmann", {{"c1", c.at("C1")}, {"c2", c.at("C2")}}};
  }
  if (c.law == "gent") return {"Gent", {{"G", c.at("mu")}, {"Jm", c.at("J_m")}}};
  if (c.law == "saint-venant-kirchhoff") {
    return {"isotropic elastic", {{"E", rest.young}, {"v", rest.poisson}}};
  }
  if (c.law == "holzapfel-gasser-ogden" && c.fibres.kind == fem::FibreField::Kind::Constant) {
    // FEBio has two families at +-gamma; one family is two that coincide, of half the stiffness.
    const double part = c.fibres.families == 1 ? 0.5 : 1;
    const double degrees = c.fibres.families == 1 ? 0 : c.fibres.angle * 180 / 3.141592653589793;
    return {"Holzapfel-Gasser-Ogden",
            {{"c", c.at("c")},
             {"k1", part * c.at("k1")},
             {"k2", c.at("k2")},
             {"gamma", degrees},
             {"kappa", c.at("kappa")}}};
  }
  return {};
}

/// Times of a hold, from its start, in intervals that grow: the force changes most in the first.
std::vector<double> times_of_hold(double hold) {
  constexpr int kIntervals = 16;
  constexpr double kGrowth = 1.4;
  std::vector<double> times;
  for (int i = 1; i <= kIntervals && hold > 0; ++i)
    times.push_back(hold * (std::pow(kGrowth, i) - 1) / (std::pow(kGrowth, kIntervals) - 1));
  return times;
}

class FebioWriter {
 public:
  explicit FebioWriter(const Deck& deck)
      : deck_(deck),
        press_(deck.pace ? deck.pace->press : 1),
        hold_(deck.pace ? deck.pace->hold : 0) {}

  std::string write() {
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- {} -->\n<febio_spec version=\"4.0\">\n",
        comment(deck_.title));
    add("<Module type=\"solid\">\n<units>SI</units>\n</Module>\n");
    control();
    materials();
    mesh();
    domains();
    boundary();
    if (deck_.tool) contact(*deck_.tool);
    add("<LoadData>\n<load_controller id=\"1\" name=\"ramp\" type=\"loadcurve\">\n"
        "<interpolate>LINEAR</interpolate>\n<points><pt>0,0</pt><pt>{:.12g},1</pt>",
        press_);
    if (hold_ > 0) add("<pt>{:.12g},1</pt>", press_ + hold_);
    add("</points>\n</load_controller>\n");
    if (deck_.tool) must_points();
    add("</LoadData>\n");
    output();
    add("</febio_spec>\n");
    return std::move(out_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }

  /// XML comments hold no double hyphen.
  static std::string comment(std::string text) {
    for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--")) {
      text.replace(at, 2, "-");
    }
    return escape_markup(text);
  }

  void control() {
    add("<Control>\n<analysis>STATIC</analysis>\n");
    if (deck_.tool)
      steps_of_contact();
    else
      add("<time_steps>{}</time_steps>\n<step_size>{:.12g}</step_size>\n", deck_.increments,
          1.0 / deck_.increments);
    add("<solver type=\"solid\">\n<symmetric_stiffness>symmetric</symmetric_stiffness>\n"
        "<dtol>0.001</dtol>\n<etol>1e-8</etol>\n<rtol>1e-6</rtol>\n");
    if (deck_.tool)
      add("<max_refs>60</max_refs>\n<qn_method type=\"BFGS\">\n<max_ups>0</max_ups>\n"
          "</qn_method>\n");
    else
      add("<qn_method type=\"BFGS\"/>\n");
    add("</solver>\n</Control>\n");
  }

  /// Steps from a fiftieth of the path on, halved where they fail: after a large first one the
  /// tool is so deep in the surface that elements are inverted. They meet each increment.
  void steps_of_contact() {
    const double length = press_ + hold_;
    const int steps = static_cast<int>(std::ceil(50 * length / press_));
    add("<time_steps>{0}</time_steps>\n<step_size>{1:.12g}</step_size>\n"
        "<time_stepper type=\"default\">\n<max_retries>10</max_retries>\n<opt_iter>15</opt_iter>\n"
        "<dtmin>{2:.12g}</dtmin>\n<dtmax lc=\"2\">1</dtmax>\n</time_stepper>\n",
        steps, length / steps, 1e-3 * length / steps);
  }

  /// The longest step; FEBio meets every point of this curve.
  void must_points() {
    const double increment = press_ / deck_.increments;
    add("<load_controller id=\"2\" name=\"increments\" type=\"loadcurve\">\n"
        "<interpolate>STEP</interpolate>\n<points>");
    for (int i = 0; i <= deck_.increments; ++i)
      add("<pt>{:.12g},{:.12g}</pt>", i * increment, increment);
    for (const double time : times_of_hold(hold_))
      add("<pt>{:.12g},{:.12g}</pt>", press_ + time, hold_);
    add("</points>\n</load_controller>\n");
  }

  void materials() {
    add("<Material>\n");
    for (std::size_t region = 0; region < deck_.laws.size(); ++region) {
      const fem::LawConstants& c = deck_.laws[region];
      const FebioLaw law = febio_law(c);
      if (law.type.empty()) {
        throw Error(ErrorKind::Configuration,
                    "material of region '" + deck_.region_names[region] + "'",
                    "FEBio has no law like " + c.law + " of this energy",
                    "compare with a law that it has: neo-hookean, mooney-rivlin, yeoh, ogden, "
                    "veronda-westmann, gent, saint-venant-kirchhoff, holzapfel-gasser-ogden with a "
                    "constant direction");
      }
      const RelaxationSeries& series = deck_.relaxation[region];
      add("<material id=\"{}\" name=\"{}\" type=\"{}\">\n", region + 1,
          escape_markup(deck_.region_names[region]),
          series.empty() ? law.type : "uncoupled viscoelastic");
      if (!series.empty()) terms(series, law.type);
      for (const auto& [name, value] : law.parameters) add("<{0}>{1:.12g}</{0}>\n", name, value);
      if (!series.empty()) add("</elastic>\n");
      if (c.law != "saint-venant-kirchhoff") {
        add("<k>{:.12g}</k>\n<pressure_model>3</pressure_model>\n", fem::rest_moduli(c).kappa());
      }
      if (c.law == "holzapfel-gasser-ogden") material_axes(c.fibres);
      add("</material>\n");
    }
    if (deck_.tool) {
      add("<material id=\"{}\" name=\"{}\" type=\"rigid "
          "body\">\n<density>1</density>\n</material>\n",
          tool_material(), tool_name());
    }
    add("</Material>\n");
  }

  /// The series, and the beginning of the law that relaxes. Of it g0 is left in the long term.
  void terms(const RelaxationSeries& series, const std::string& law) {
    add("<g0>{:.12g}</g0>\n", long_term_fraction(series));
    for (std::size_t i = 0; i < series.size(); ++i)
      add("<g{0}>{1:.12g}</g{0}>\n<t{0}>{2:.12g}</t{0}>\n", i + 1, series[i].fraction,
          series[i].time_s);
    add("<elastic type=\"{}\">\n", law);
  }

  /// First axis: the mean direction, or that of the only family.
  void material_axes(const fem::FibreField& fibres) {
    fem::FibreField frame = fibres;
    if (fibres.families == 2) frame.angle = 0;
    frame.families = 1;
    const Vec3 a = frame.at({})[0];
    frame.angle += 1.5707963267948966;
    const Vec3 d = frame.at({})[0];
    add("<mat_axis "
        "type=\"vector\">\n<a>{:.12g},{:.12g},{:.12g}</a>\n<d>{:.12g},{:.12g},{:.12g}</d>\n"
        "</mat_axis>\n",
        a[0], a[1], a[2], d[0], d[1], d[2]);
  }

  void mesh() {
    const auto& mesh = deck_.mesh;
    add("<Mesh>\n");
    nodes("body", mesh.X, 0);
    if (deck_.tool) nodes("tool", deck_.tool->mesh.X, mesh.X.cols());
    for (std::size_t region = 0; region < deck_.laws.size(); ++region) {
      add("<Elements type=\"tet10\" name=\"{}\">\n", part(region));
      for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
        if (mesh.region[e] != static_cast<std::int32_t>(region)) continue;
        element("elem", e + 1, mesh.tetrahedra[e], 0);
      }
      add("</Elements>\n");
    }
    std::vector<std::int32_t> fixed;
    for (std::size_t node = 0; node < mesh.fixed.size(); ++node) {
      if (mesh.fixed[node]) fixed.push_back(static_cast<std::int32_t>(node));
    }
    if (deck_.tool) tool_elements(*deck_.tool);
    node_set("fixed", fixed);
    if (deck_.tool) {
      surfaces(*deck_.tool);
    } else {
      node_set("patch", deck_.patch);
    }
    add("</Mesh>\n");
  }

  void nodes(const char* name, const Eigen::Matrix3Xd& X, Eigen::Index before) {
    add("<Nodes name=\"{}\">\n", name);
    for (Eigen::Index i = 0; i < X.cols(); ++i) {
      add("<node id=\"{}\">{:.12e},{:.12e},{:.12e}</node>\n", before + i + 1, X(0, i), X(1, i),
          X(2, i));
    }
    add("</Nodes>\n");
  }

  /// An element or a facet.
  template <class Nodes>
  void element(const char* tag, std::size_t number, const Nodes& nodes, Eigen::Index before) {
    add("<{} id=\"{}\">", tag, number);
    const char* between = "";
    for (const std::int32_t node : nodes) {
      add("{}{}", between, before + node + 1);
      between = ",";
    }
    add("</{}>\n", tag);
  }

  void tool_elements(const PressingTool& tool) {
    add("<Elements type=\"tet10\" name=\"tool\">\n");
    for (std::size_t e = 0; e < tool.mesh.tetrahedra.size(); ++e) {
      element("elem", deck_.mesh.tetrahedra.size() + e + 1, tool.mesh.tetrahedra[e],
              deck_.mesh.X.cols());
    }
    add("</Elements>\n");
  }

  void surfaces(const PressingTool& tool) {
    add("<Surface name=\"skin\">\n");
    for (std::size_t i = 0; i < tool.skin.size(); ++i) {
      const auto [e, side] = tool.skin[i];
      element("tri6", i + 1, facet_of(deck_.mesh.tetrahedra[static_cast<std::size_t>(e)], side), 0);
    }
    add("</Surface>\n<Surface name=\"tool_surface\">\n");
    for (std::size_t e = 0; e < tool.mesh.tetrahedra.size(); ++e) {
      element("tri6", e + 1, facet_of(tool.mesh.tetrahedra[e], 0), deck_.mesh.X.cols());
    }
    add("</Surface>\n<SurfacePair name=\"contact\">\n<primary>skin</primary>\n"
        "<secondary>tool_surface</secondary>\n</SurfacePair>\n");
  }

  static std::string part(std::size_t region) { return fmt::format("region_{}", region + 1); }

  void node_set(const char* name, const std::vector<std::int32_t>& nodes) {
    add("<NodeSet name=\"{}\">", name);
    const char* between = "";
    for (const std::int32_t node : nodes) {
      add("{}{}", between, node + 1);
      between = ",";
    }
    add("</NodeSet>\n");
  }

  void domains() {
    add("<MeshDomains>\n");
    for (std::size_t region = 0; region < deck_.laws.size(); ++region) {
      add("<SolidDomain name=\"{}\" mat=\"{}\" elem_type=\"TET10G4\" type=\"elastic-solid\"/>\n",
          part(region), escape_markup(deck_.region_names[region]));
    }
    if (deck_.tool) add("<SolidDomain name=\"tool\" mat=\"{}\"/>\n", tool_name());
    add("</MeshDomains>\n");
  }

  void boundary() {
    add("<Boundary>\n<bc name=\"support\" node_set=\"fixed\" type=\"zero displacement\">\n"
        "<x_dof>1</x_dof>\n<y_dof>1</y_dof>\n<z_dof>1</z_dof>\n</bc>\n");
    for (std::size_t i = 0; i < 3 && !deck_.tool; ++i) {
      add("<bc name=\"press_{0}\" node_set=\"patch\" type=\"prescribed displacement\">\n"
          "<dof>{0}</dof>\n<value lc=\"1\">{1:.12e}</value>\n<relative>0</relative>\n</bc>\n",
          "xyz"[i], deck_.depth * deck_.direction[i]);
    }
    add("</Boundary>\n");
  }

  /// The tool is moved without turning. With the penalty of palpate Newton's method of FEBio does
  /// not converge; a tenth of it lets the tool in ten times as deep.
  void contact(const PressingTool& tool) {
    add("<Rigid>\n<rigid_bc name=\"upright\" "
        "type=\"rigid_fixed\">\n<rb>{}</rb>\n<Ru_dof>1</Ru_dof>\n"
        "<Rv_dof>1</Rv_dof>\n<Rw_dof>1</Rw_dof>\n</rigid_bc>\n",
        tool_name());
    for (std::size_t i = 0; i < 3; ++i) {
      add("<rigid_bc name=\"press_{0}\" type=\"rigid_displacement\">\n<rb>{1}</rb>\n"
          "<dof>{0}</dof>\n<value lc=\"1\">{2:.12e}</value>\n<relative>0</relative>\n</rigid_bc>\n",
          "xyz"[i], tool_name(), deck_.depth * deck_.direction[i]);
    }
    add("</Rigid>\n<Contact>\n<contact name=\"tool\" type=\"sliding-elastic\" "
        "surface_pair=\"contact\">\n<laugon>0</laugon>\n<penalty>{:.10g}</penalty>\n"
        "<auto_penalty>0</auto_penalty>\n<two_pass>0</two_pass>\n"
        "<symmetric_stiffness>1</symmetric_stiffness>\n<fric_coeff>0</fric_coeff>\n</contact>\n"
        "</Contact>\n",
        0.1 * tool.stiffness);
  }

  void output() {
    add("<Output>\n<logfile>\n");
    if (deck_.tool) {
      add("<rigid_body_data data=\"Fx;Fy;Fz\" file=\"tool_forces.txt\">{}</rigid_body_data>\n",
          tool_material());
    } else {
      add("<node_data data=\"Rx;Ry;Rz\" file=\"patch_forces.txt\" node_set=\"patch\"/>\n");
    }
    add("</logfile>\n</Output>\n");
  }

  std::size_t tool_material() const { return deck_.laws.size() + 1; }
  /// Unlike that of any region.
  std::string tool_name() const {
    std::string name = "rigid_tool";
    while (std::count(deck_.region_names.begin(), deck_.region_names.end(), name) > 0) name += "_";
    return name;
  }

  const Deck& deck_;
  double press_, hold_;  ///< s; without relaxation time means nothing, and the press takes 1
  std::string out_;
};

void check_relaxation_of(const Deck& deck) {
  constexpr std::size_t kMostTerms = 6;
  if (!deck.relaxes()) return;
  if (!deck.pace)
    refuse(
        "site", "tissue of the case relaxes, and the force depends on the speed of the tool",
        "say how long the press takes (--press-seconds), and the hold after it (--hold-seconds)");
  for (std::size_t region = 0; region < deck.relaxation.size(); ++region)
    if (deck.relaxation[region].size() > kMostTerms)
      refuse("material of region '" + deck.region_names[region] + "'",
             fmt::format("FEBio has at most {} terms of relaxation", kMostTerms),
             "merge terms whose times are close");
}

}  // namespace

std::string febio_deck(const Deck& deck) {
  if (deck.no_slip || deck.lateral)
    throw Error(ErrorKind::Configuration, "tool", "FEBio decks have contact without friction",
                "export for CalculiX (--calculix), or a press without friction");
  check_relaxation_of(deck);
  return FebioWriter(deck).write();
}

}  // namespace palpate::app
