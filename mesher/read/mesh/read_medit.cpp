// SPDX-License-Identifier: AGPL-3.0-or-later
// [Frey, MEDIT: an interactive mesh visualization software, INRIA RT-0253, 2001, section 7]
#include "mesher/read/mesh/read_medit.hpp"

#include <array>
#include <cctype>
#include <utility>

#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

/// A section whose rows are the nodes of an element and its reference.
struct ElementKind {
  std::string_view keyword;
  int dimension;
  std::size_t nodes;
  const char* name;  ///< plural
};

constexpr std::array kKinds{
    ElementKind{"Triangles", 2, 3, "triangles"},   ElementKind{"TrianglesP2", 2, 6, "triangles"},
    ElementKind{"Tetrahedra", 3, 4, "tetrahedra"}, ElementKind{"TetrahedraP2", 3, 10, "tetrahedra"},
    ElementKind{"Hexahedra", 3, 8, "hexahedra"},   ElementKind{"Prisms", 3, 6, "prisms"},
    ElementKind{"Pyramids", 3, 5, "pyramids"},
};

bool is_keyword(std::string_view word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0;
}

class MeditReader {
 public:
  MeditReader(std::string_view bytes, const std::string& file) : scanner_(bytes, file) {}

  MeshEntities read() {
    if (next() != "MeshVersionFormatted") {
      scanner_.refuse("the file does not begin with MeshVersionFormatted",
                      "export it as MEDIT .mesh, in text");
    }
    scanner_.integer("the version of the format");
    for (std::string_view word = next(); !word.empty() && word != "End"; word = next())
      section(word);
    return std::move(mesh_);
  }

 private:
  /// The next word that is in no comment.
  std::string_view next() {
    std::string_view word = scanner_.word();
    while (!word.empty() && word.front() == '#') {
      scanner_.line();
      word = scanner_.word();
    }
    return word;
  }

  void section(std::string_view keyword) {
    if (keyword == "Dimension") {
      if (scanner_.integer("the dimension") != 3)
        scanner_.refuse("a mesh that is not of dimension 3");
    } else if (keyword == "Vertices") {
      vertices();
    } else if (is_keyword(keyword)) {
      for (const ElementKind& kind : kKinds)
        if (kind.keyword == keyword) return elements(kind);
      skip();
    } else {
      scanner_.refuse(text("'", keyword, "' where the name of a section is expected"));
    }
  }

  /// Sections of no interest here: normals, ridges, required vertices.
  void skip() {
    while (!scanner_.peek().empty() && !is_keyword(scanner_.peek())) scanner_.word();
  }

  void vertices() {
    if (!mesh_.nodes.empty()) scanner_.refuse("a second section of vertices");
    const std::size_t count = scanner_.count("the number of vertices", 8);
    mesh_.nodes.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      Vec3 x{};
      for (double& component : x) component = scanner_.real("a coordinate");
      scanner_.integer("the reference of a vertex");
      mesh_.nodes.push_back(x);
      mesh_.node_numbers.push_back(static_cast<std::int64_t>(i) + 1);
    }
  }

  std::int32_t node() {
    const std::int64_t number = scanner_.integer("a vertex of an element");
    if (number < 1 || number > static_cast<std::int64_t>(mesh_.nodes.size()))
      scanner_.refuse(text("vertex ", number, ", which is not among the vertices before it"));
    return static_cast<std::int32_t>(number - 1);
  }

  void elements(const ElementKind& kind) {
    const std::size_t count = scanner_.count("the number of elements", 2 * (kind.nodes + 1));
    std::vector<std::int32_t> nodes(kind.nodes);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::int32_t& n : nodes) n = node();
      const std::int64_t reference = scanner_.integer("the reference of an element");
      if (kind.dimension == 2) {
        if (reference != 0) mesh_.add_to_set(text("marker=", reference), nodes);
      } else if (kind.nodes == 4 || kind.nodes == 10) {
        tetrahedron(nodes, reference);
      } else {
        ++mesh_.other_solids[kind.name];
      }
    }
  }

  void tetrahedron(const std::vector<std::int32_t>& nodes, std::int64_t reference) {
    ListedTetrahedron& t = mesh_.tetrahedra.emplace_back();
    std::copy(nodes.begin(), nodes.end(), t.nodes.begin());
    t.quadratic = nodes.size() == 10;
    t.region =
        mesh_.region(reference == 0 ? std::string(kUnnamedRegion) : text("region=", reference));
    t.number = static_cast<std::int64_t>(mesh_.tetrahedra.size());
  }

  Scanner scanner_;
  MeshEntities mesh_;
};

}  // namespace

MeshEntities read_medit(std::string_view bytes, const std::string& file) {
  return MeditReader(bytes, file).read();
}

}  // namespace palpate::mesher
