// SPDX-License-Identifier: AGPL-3.0-or-later
// [TetGen 1.5 manual, chapter 5]
#include "mesher/read/mesh/read_tetgen.hpp"

#include <algorithm>
#include <utility>

#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

/// In which place of TetGen the mid-node of each of kTetrahedronEdges is.
constexpr std::array<std::size_t, 6> kMidNodes{6, 7, 9, 5, 8, 4};

/// A file of rows that begin with a number, after a row of counts. "#" begins a comment.
class Table {
 public:
  Table(const NamedBytes& file, std::string_view row, std::size_t smallest)
      : scanner_(file.bytes, file.file), row_(row) {
    if (!advance()) scanner_.refuse("the file has no row of counts");
    Fields fields(line_, scanner_);
    count_ =
        scanner_.checked_count(fields.integer("a number of rows"), "the number of rows", smallest);
    while (!fields.at_end()) header_.push_back(fields.integer("a number of columns"));
  }

  std::size_t count() const { return count_; }
  /// A number of the first row behind the count; 0 where there is none.
  std::int64_t header(std::size_t column) const {
    return column < header_.size() ? header_[column] : 0;
  }
  Fields next() {
    if (!advance()) scanner_.refuse(text("the file ends where ", row_, " is expected"));
    return {line_, scanner_};
  }
  Scanner& scanner() { return scanner_; }

 private:
  bool advance() {
    for (auto line = scanner_.line(); line; line = scanner_.line()) {
      line_ = line->substr(0, line->find('#'));
      if (!line_.empty()) return true;
    }
    return false;
  }

  Scanner scanner_;
  std::string_view row_, line_;
  std::size_t count_ = 0;
  std::vector<std::int64_t> header_;
};

class TetgenReader {
 public:
  void read_nodes(const NamedBytes& file) {
    Table table(file, "a node", 7);
    if (table.header(0) != 3) table.scanner().refuse("nodes that are not of dimension 3");
    const std::int64_t attributes = table.header(1);
    for (std::size_t i = 0; i < table.count(); ++i) {
      Fields fields = table.next();
      const std::int64_t number = fields.integer("the number of a node");
      Vec3 x{};
      for (double& component : x) component = fields.real("a coordinate");
      if (!index_.add(number)) table.scanner().refuse(text("node ", number, " is listed twice"));
      mesh_.nodes.push_back(x);
      mesh_.node_numbers.push_back(number);
      for (std::int64_t k = 0; k < attributes; ++k) fields.real("an attribute");
      if (table.header(2) > 0) mark(fields, {static_cast<std::int32_t>(i)});
    }
  }

  void read_tetrahedra(const NamedBytes& file) {
    Table table(file, "a tetrahedron", 10);
    const std::int64_t corners = table.header(0);
    if (corners != 4 && corners != 10) {
      table.scanner().refuse(text("tetrahedra of ", corners, " nodes"));
    }
    for (std::size_t i = 0; i < table.count(); ++i) {
      Fields fields = table.next();
      ListedTetrahedron& t = mesh_.tetrahedra.emplace_back();
      t.number = fields.integer("the number of a tetrahedron");
      const std::vector<std::int32_t> nodes = take_nodes(table, fields, corners);
      std::copy_n(nodes.begin(), 4, t.nodes.begin());
      t.quadratic = corners == 10;
      for (std::size_t k = 0; t.quadratic && k < kMidNodes.size(); ++k)
        t.nodes[4 + k] = nodes[kMidNodes[k]];
      const bool has_region = table.header(1) > 0;
      t.region = mesh_.region(has_region ? text("region=", fields.real("an attribute"))
                                         : std::string(kUnnamedRegion));
    }
  }

  void read_faces(const NamedBytes& file) {
    Table table(file, "a face", 8);
    const bool is_quadratic = !mesh_.tetrahedra.empty() && mesh_.tetrahedra.front().quadratic;
    for (std::size_t i = 0; i < table.count() && table.header(0) > 0; ++i) {
      Fields fields = table.next();
      fields.integer("the number of a face");
      const std::vector<std::int32_t> nodes = take_nodes(table, fields, is_quadratic ? 6 : 3);
      mark(fields, nodes);
    }
  }

  MeshEntities take() { return std::move(mesh_); }

 private:
  std::vector<std::int32_t> take_nodes(Table& table, Fields& fields, std::int64_t count) {
    std::vector<std::int32_t> nodes;
    for (std::int64_t k = 0; k < count; ++k) {
      const std::int64_t number = fields.integer("a node");
      const auto found = index_.find(number);
      if (!found) table.scanner().refuse(text("node ", number, " is not in the .node file"));
      nodes.push_back(*found);
    }
    return nodes;
  }
  void mark(Fields& fields, const std::vector<std::int32_t>& nodes) {
    const std::int64_t marker = fields.integer("a boundary marker");
    if (marker != 0) mesh_.add_to_set(text("marker=", marker), nodes);
  }

  MeshEntities mesh_;
  NumberIndex index_;
};

}  // namespace

MeshEntities read_tetgen(const NamedBytes& node, const NamedBytes& ele, const NamedBytes& face) {
  TetgenReader reader;
  reader.read_nodes(node);
  reader.read_tetrahedra(ele);
  if (!face.bytes.empty()) reader.read_faces(face);
  return reader.take();
}

}  // namespace palpate::mesher
