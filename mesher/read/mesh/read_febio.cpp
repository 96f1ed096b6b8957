// SPDX-License-Identifier: AGPL-3.0-or-later
// [FEBio user's manual 4.0, chapter 3, and appendices on the formats 2.5 and 3.0]
#include "mesher/read/mesh/read_febio.hpp"

#include <algorithm>
#include <utility>

#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"
#include "mesher/read/file/xml.hpp"

namespace palpate::mesher {
namespace {

struct FebioElement {
  std::vector<std::int32_t> nodes;
  std::int32_t tetrahedron = -1;  ///< index into MeshEntities::tetrahedra
};

class FebioReader {
 public:
  FebioReader(std::string_view bytes, const std::string& file) : xml_(bytes, file) {}

  MeshEntities read() {
    const pugi::xml_node root = xml_.document().child("febio_spec");
    if (!root) xml_.refuse({}, "the file has no febio_spec element", "give an input file of FEBio");
    const std::string version = root.attribute("version").value();
    if (version != "2.0" && version != "2.5" && version != "3.0" && version != "4.0") {
      xml_.refuse(root, text("version '", version, "' of the FEBio format"),
                  "save it as version 2.5, 3.0 or 4.0");
    }
    const pugi::xml_node mesh = root.child(version < "3" ? "Geometry" : "Mesh");
    if (!mesh) xml_.refuse(root, "there is no mesh");
    if (mesh.attribute("from") || mesh.child("Part") || mesh.child("Instance")) {
      xml_.refuse(mesh, "the mesh is in another file or in parts", "write it into one file");
    }
    for (const pugi::xml_node section : mesh.children()) {
      if (section.attribute("from"))
        xml_.refuse(section, "a section in another file", "write it into this one");
      add(root, section);
    }
    return std::move(mesh_);
  }

 private:
  void add(pugi::xml_node root, pugi::xml_node section) {
    const std::string tag = section.name();
    if (tag == "Nodes") {
      nodes(section);
    } else if (tag == "Elements") {
      elements(root, section);
    } else if (tag == "NodeSet") {
      node_set(section);
    } else if (tag == "ElementSet") {
      element_set(section);
    } else if (tag == "Surface" || tag == "Edge") {
      for (const pugi::xml_node facet : section.children())
        mesh_.add_to_set(name_of(section), node_list(facet));
    }
  }

  std::string name_of(pugi::xml_node section) const {
    std::string name = section.attribute("name").value();
    if (name.empty()) xml_.refuse(section, text("a ", section.name(), " without a name"));
    return name;
  }

  std::int64_t id_of(pugi::xml_node node) const {
    const auto id = integer_of(trimmed_text(node.attribute("id").value()));
    if (!id) xml_.refuse(node, text("a ", node.name(), " whose id is no number"));
    return *id;
  }

  /// The numbers of a text, between commas or blanks.
  template <class Number, class Parse>
  std::vector<Number> list(pugi::xml_node node, const Parse& parse) const {
    std::vector<Number> found;
    std::string_view rest = node.child_value();
    constexpr std::string_view between = ", \t\r\n";
    while (true) {
      rest.remove_prefix(std::min(rest.find_first_not_of(between), rest.size()));
      if (rest.empty()) return found;
      const std::string_view word = rest.substr(0, rest.find_first_of(between));
      const auto number = parse(word);
      if (!number) xml_.refuse(node, text("a word in a ", node.name(), " that is no number"));
      found.push_back(*number);
      rest.remove_prefix(word.size());
    }
  }

  std::int32_t node_index(pugi::xml_node at, std::int64_t number) const {
    const auto found = index_.find(number);
    if (!found) xml_.refuse(at, text("node ", number, " is not among the nodes before it"));
    return *found;
  }

  std::vector<std::int32_t> node_list(pugi::xml_node node) const {
    std::vector<std::int32_t> found;
    for (const std::int64_t number : list<std::int64_t>(node, integer_of))
      found.push_back(node_index(node, number));
    return found;
  }

  void nodes(pugi::xml_node section) {
    std::vector<std::int32_t> added;
    for (const pugi::xml_node node : section.children()) {
      const std::vector<double> x = list<double>(node, real_of);
      if (x.size() != 3) xml_.refuse(node, text("a node of ", x.size(), " coordinates"));
      const std::int64_t number = id_of(node);
      if (!index_.add(number)) xml_.refuse(node, text("node ", number, " is listed twice"));
      added.push_back(static_cast<std::int32_t>(mesh_.nodes.size()));
      mesh_.nodes.push_back({x[0], x[1], x[2]});
      mesh_.node_numbers.push_back(number);
    }
    if (section.attribute("name")) mesh_.add_to_set(name_of(section), added);
  }

  std::string region_of(pugi::xml_node root, pugi::xml_node section) const {
    if (section.attribute("name")) return name_of(section);
    const std::string material = section.attribute("mat").value();
    if (material.empty()) return kUnnamedRegion;
    const pugi::xml_node found =
        root.child("Material").find_child_by_attribute("material", "id", material.c_str());
    const std::string name = found.attribute("name").value();
    return name.empty() ? "material " + material : name;
  }

  void elements(pugi::xml_node root, pugi::xml_node section) {
    const std::string type = lower(section.attribute("type").value());
    const bool is_solid = !(type.starts_with("tri") || type.starts_with("quad") ||
                            type.starts_with("line") || type.starts_with("q4"));
    const bool is_quadratic = type == "tet10";
    const bool is_tetrahedron = is_quadratic || type == "tet4";
    const std::int32_t region = is_solid ? mesh_.region(region_of(root, section)) : 0;
    for (const pugi::xml_node node : section.children()) {
      const std::int64_t number = id_of(node);
      FebioElement element{node_list(node), -1};
      if (is_tetrahedron) {
        element.tetrahedron = static_cast<std::int32_t>(mesh_.tetrahedra.size());
        add_tetrahedron(node, number, element.nodes, is_quadratic, region);
      } else if (is_solid) {
        ++mesh_.other_solids["elements of type " + type];
      } else if (section.attribute("name")) {
        mesh_.add_to_set(name_of(section), element.nodes);
      }
      if (!elements_.emplace(number, std::move(element)).second) {
        xml_.refuse(node, text("element ", number, " is listed twice"));
      }
    }
  }

  void add_tetrahedron(pugi::xml_node at, std::int64_t number,
                       const std::vector<std::int32_t>& nodes, bool is_quadratic,
                       std::int32_t region) {
    if (nodes.size() != (is_quadratic ? 10 : 4)) {
      xml_.refuse(at, text("tetrahedron ", number, " has ", nodes.size(), " nodes"));
    }
    ListedTetrahedron& t = mesh_.tetrahedra.emplace_back();
    std::copy(nodes.begin(), nodes.end(), t.nodes.begin());
    t.quadratic = is_quadratic;
    t.region = region;
    t.number = number;
  }

  /// A list of numbers in format 4.0, elements with ids before, names of other sets in 2.5.
  void node_set(pugi::xml_node section) {
    std::vector<std::int32_t> found = node_list(section);
    for (const pugi::xml_node node : section.children()) {
      if (node.type() != pugi::node_element) continue;
      if (node.name() == std::string("NodeSet") || node.name() == std::string("node_set")) {
        const auto other = mesh_.node_sets.find(node.attribute("node_set").value());
        if (other == mesh_.node_sets.end())
          xml_.refuse(node, "there is no such node set before it");
        found.insert(found.end(), other->second.begin(), other->second.end());
      } else {
        found.push_back(node_index(node, id_of(node)));
      }
    }
    mesh_.add_to_set(name_of(section), found);
  }

  void element_set(pugi::xml_node section) {
    std::vector<std::int64_t> numbers = list<std::int64_t>(section, integer_of);
    for (const pugi::xml_node node : section.children())
      if (node.type() == pugi::node_element) numbers.push_back(id_of(node));
    for (const std::int64_t number : numbers) {
      const auto found = elements_.find(number);
      if (found == elements_.end()) xml_.refuse(section, text("there is no element ", number));
      mesh_.add_to_set(name_of(section), found->second.nodes);
      if (found->second.tetrahedron >= 0)
        mesh_.groups[name_of(section)].push_back(found->second.tetrahedron);
    }
  }

  XmlFile xml_;
  MeshEntities mesh_;
  NumberIndex index_;
  std::unordered_map<std::int64_t, FebioElement> elements_;
};

}  // namespace

MeshEntities read_febio(std::string_view bytes, const std::string& file) {
  return FebioReader(bytes, file).read();
}

}  // namespace palpate::mesher
