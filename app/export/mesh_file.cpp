// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/export/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "app/markup.hpp"
#include "format/base64.hpp"
#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::app {
namespace {

/// The edges of the mid-nodes 4 to 9, in the order of VTK, Abaqus and FEBio.
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

using Nodes = std::vector<std::int32_t>;

/// Body::nodes with mid-nodes behind them, and the nodes of each element.
struct Elements {
  std::vector<Vec3> nodes;
  std::vector<Nodes> tetrahedra;
  std::vector<Nodes> facets;  ///< of the boundary
  bool quadratic = false;
};

class MidNodes {
 public:
  MidNodes(const Body& body, std::vector<Vec3>& nodes) : nodes_(nodes) {
    for (const CurvedEdge& edge : body.curved_edges) middles_[edge.ends] = edge.middle;
  }
  std::int32_t of(std::int32_t a, std::int32_t b) {
    const Edge ends = edge_between(a, b);
    const auto [found, is_new] = index_.try_emplace(ends, static_cast<std::int32_t>(nodes_.size()));
    if (is_new) {
      const auto curved = middles_.find(ends);
      const Vec3 halfway = 0.5 * (nodes_[to_index(a)] + nodes_[to_index(b)]);
      nodes_.push_back(curved == middles_.end() ? halfway : curved->second);
    }
    return found->second;
  }

 private:
  std::vector<Vec3>& nodes_;
  std::map<Edge, Vec3> middles_;
  std::map<Edge, std::int32_t> index_;
};

Elements elements_of(const Body& body) {
  Elements all{body.nodes, {}, {}, !body.curved_edges.empty()};
  MidNodes middles(body, all.nodes);
  for (const Tetrahedron& t : body.tetrahedra) {
    Nodes nodes(t.begin(), t.end());
    if (all.quadratic)
      for (const auto& [a, b] : kEdges) nodes.push_back(middles.of(t[a], t[b]));
    all.tetrahedra.push_back(std::move(nodes));
  }
  for (const Triangle& t : body.boundary) {
    Nodes nodes(t.begin(), t.end());
    if (all.quadratic)
      for (std::size_t k = 0; k < 3; ++k) nodes.push_back(middles.of(t[k], t[(k + 1) % 3]));
    all.facets.push_back(std::move(nodes));
  }
  return all;
}

/// Sets of nodes that are not empty, ascending.
std::vector<std::pair<std::string, Nodes>> sets_of(const Body& body) {
  std::set<std::int32_t> sprung, boundary, response, sites;
  for (const SprungFacet& facet : body.foundation)
    for (const std::int32_t node : body.boundary[to_index(facet.facet)]) sprung.insert(node);
  for (const Triangle& facet : body.boundary) boundary.insert(facet.begin(), facet.end());
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    response.insert(body.response.node[v]);
    if (body.response.is_site[v] != 0) sites.insert(body.response.node[v]);
  }
  std::vector<std::pair<std::string, Nodes>> sets{{"fixed", body.fixed_nodes}};
  for (const auto& [name, nodes] : {std::pair("sprung", &sprung),
                                    {"boundary", &boundary},
                                    {"response", &response},
                                    {"sites", &sites}})
    sets.emplace_back(name, Nodes(nodes->begin(), nodes->end()));
  std::erase_if(sets, [](const auto& set) { return set.second.empty(); });
  return sets;
}

/// Numbers from 1, between commas or blanks.
std::string numbers(const Nodes& nodes, const char* between) {
  std::string list;
  for (const std::int32_t node : nodes)
    list += fmt::format("{}{}", list.empty() ? "" : between, node + 1);
  return list;
}

std::string coordinates(const Vec3& x, const char* between) {
  return fmt::format("{}{}{}{}{}", x[0], between, x[1], between, x[2]);
}

template <class... Args>
void add(std::string& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

/// Names of letters, digits and underscores that differ whatever the case of their letters.
class PlainNames {
 public:
  std::string of(const std::string& name) {
    std::string plain, folded;
    for (const char letter : name)
      plain += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    if (plain.empty() || std::isdigit(static_cast<unsigned char>(plain.front())) != 0)
      plain = "R" + plain;
    const auto fold = [](std::string word) {
      for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      return word;
    };
    std::string candidate = plain;
    for (int k = 2; !taken_.insert(fold(candidate)).second; ++k)
      candidate = fmt::format("{}_{}", plain, k);
    return candidate;
  }

 private:
  std::set<std::string> taken_;
};

/// An array of a VTU file: the number of bytes, then the bytes, in base64.
template <class Number>
void add_array(std::string& out, const char* type, const std::string& name, int components,
               const std::vector<Number>& values) {
  std::string bytes(8 + values.size() * sizeof(Number), '\0');
  const std::uint64_t size = values.size() * sizeof(Number);
  std::memcpy(bytes.data(), &size, 8);
  if (size > 0) std::memcpy(bytes.data() + 8, values.data(), size);
  add(out,
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
      "format=\"binary\">{}</DataArray>\n",
      type, escape_markup(name), components, base64(bytes));
}

void add_cells(std::string& out, const Elements& all) {
  std::vector<std::int64_t> connectivity, offsets;
  for (const Nodes& t : all.tetrahedra) {
    connectivity.insert(connectivity.end(), t.begin(), t.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  constexpr std::uint8_t linear = 10, quadratic = 24;
  out += "<Cells>\n";
  add_array(out, "Int64", "connectivity", 1, connectivity);
  add_array(out, "Int64", "offsets", 1, offsets);
  add_array(out, "UInt8", "types", 1,
            std::vector<std::uint8_t>(all.tetrahedra.size(), all.quadratic ? quadratic : linear));
  out += "</Cells>\n";
}

}  // namespace

std::string gmsh_mesh(const Body& body) {
  const Elements all = elements_of(body);
  const auto sets = sets_of(body);
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  add(out, "$PhysicalNames\n{}\n", body.region_names.size() + sets.size());
  // "boundary" is a surface, the others are points.
  std::size_t group = body.region_names.size();
  for (const auto& [name, nodes] : sets)
    add(out, "{} {} \"{}\"\n", name == "boundary" ? 2 : 0, ++group, name);
  for (std::size_t r = 0; r < body.region_names.size(); ++r)
    add(out, "3 {} \"{}\"\n", r + 1, body.region_names[r]);
  add(out, "$EndPhysicalNames\n$Nodes\n{}\n", all.nodes.size());
  for (std::size_t i = 0; i < all.nodes.size(); ++i)
    add(out, "{} {}\n", i + 1, coordinates(all.nodes[i], " "));
  std::string elements;
  std::size_t number = 0;
  const auto element = [&](int type, std::size_t tag, const Nodes& nodes) {
    add(elements, "{} {} 2 {} {} {}\n", ++number, type, tag, tag, numbers(nodes, " "));
  };
  group = body.region_names.size();
  for (const auto& [name, nodes] : sets) {
    ++group;
    if (name == "boundary") {
      for (const Nodes& facet : all.facets) element(all.quadratic ? 9 : 2, group, facet);
    } else {
      for (const std::int32_t node : nodes) element(15, group, {node});
    }
  }
  for (std::size_t t = 0; t < all.tetrahedra.size(); ++t) {
    Nodes nodes = all.tetrahedra[t];
    if (all.quadratic) std::swap(nodes[8], nodes[9]);  // Gmsh: edge 2-3 before edge 1-3
    element(all.quadratic ? 11 : 4, to_index(body.tetrahedron_region[t]) + 1, nodes);
  }
  add(out, "$EndNodes\n$Elements\n{}\n{}$EndElements\n", number, elements);
  return out;
}

std::string vtu_mesh(const Body& body) {
  const Elements all = elements_of(body);
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n";
  add(out,
      "<DataArray type=\"String\" Name=\"region_names\" NumberOfTuples=\"{}\" format=\"ascii\">",
      body.region_names.size());
  for (const std::string& name : body.region_names) {
    for (const char letter : name)
      add(out, "{} ", static_cast<int>(static_cast<unsigned char>(letter)));
    out += "0 ";
  }
  add(out,
      "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"{}\" "
      "NumberOfCells=\"{}\">\n<PointData>\n",
      all.nodes.size(), all.tetrahedra.size());
  for (const auto& [name, nodes] : sets_of(body)) {
    std::vector<std::uint8_t> marks(all.nodes.size(), 0);
    for (const std::int32_t node : nodes) marks[to_index(node)] = 1;
    add_array(out, "UInt8", name, 1, marks);
  }
  out += "</PointData>\n<CellData>\n";
  add_array(out, "Int32", "region", 1, body.tetrahedron_region);
  out += "</CellData>\n<Points>\n";
  std::vector<double> points;
  for (const Vec3& x : all.nodes) points.insert(points.end(), x.begin(), x.end());
  add_array(out, "Float64", "Points", 3, points);
  out += "</Points>\n";
  add_cells(out, all);
  return out + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string abaqus_mesh(const Body& body) {
  const Elements all = elements_of(body);
  PlainNames names;
  std::string sets;
  for (const auto& [name, nodes] : sets_of(body)) {
    add(sets, "*NSET, NSET={}\n", names.of(name));
    for (const std::int32_t node : nodes) add(sets, "{},\n", node + 1);
  }
  std::string out = "*HEADING\npalpate body, m\n*NODE, NSET=ALL_NODES\n";
  for (std::size_t i = 0; i < all.nodes.size(); ++i)
    add(out, "{}, {:.12e}, {:.12e}, {:.12e}\n", i + 1, all.nodes[i][0], all.nodes[i][1],
        all.nodes[i][2]);  // CalculiX takes fields of at most 20 characters
  for (std::size_t r = 0; r < body.region_names.size(); ++r) {
    add(out, "*ELEMENT, TYPE={}, ELSET={}\n", all.quadratic ? "C3D10" : "C3D4",
        names.of(body.region_names[r]));
    for (std::size_t t = 0; t < all.tetrahedra.size(); ++t)
      if (to_index(body.tetrahedron_region[t]) == r)
        add(out, "{}, {}\n", t + 1, numbers(all.tetrahedra[t], ", "));
  }
  return out + sets;
}

std::string febio_mesh(const Body& body) {
  const Elements all = elements_of(body);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n"
      "<Module type=\"solid\">\n<units>SI</units>\n</Module>\n<Mesh>\n<Nodes>\n";
  for (std::size_t i = 0; i < all.nodes.size(); ++i)
    add(out, "<node id=\"{}\">{}</node>\n", i + 1, coordinates(all.nodes[i], ","));
  out += "</Nodes>\n";
  for (std::size_t r = 0; r < body.region_names.size(); ++r) {
    add(out, "<Elements type=\"{}\" name=\"{}\">\n", all.quadratic ? "tet10" : "tet4",
        escape_markup(body.region_names[r]));
    for (std::size_t t = 0; t < all.tetrahedra.size(); ++t)
      if (to_index(body.tetrahedron_region[t]) == r)
        add(out, "<elem id=\"{}\">{}</elem>\n", t + 1, numbers(all.tetrahedra[t], ","));
    out += "</Elements>\n";
  }
  for (const auto& [name, nodes] : sets_of(body))
    add(out, "<NodeSet name=\"{}\">{}</NodeSet>\n", name, numbers(nodes, ","));
  return out + "</Mesh>\n</febio_spec>\n";
}

std::string off_surface(const Body& body) {
  const ResponseSurface& surface = body.response;
  std::string out = fmt::format("OFF\n{} {} 0\n", surface.node.size(), surface.triangles.size());
  for (const std::int32_t node : surface.node)
    add(out, "{}\n", coordinates(body.nodes[to_index(node)], " "));
  for (const Triangle& t : surface.triangles) add(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

}  // namespace palpate::app
