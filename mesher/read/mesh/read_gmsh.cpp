// SPDX-License-Identifier: AGPL-3.0-or-later
// [Gmsh 4.8 reference manual, chapter 9]
#include "mesher/read/mesh/read_gmsh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"
#include "mesher/read/mesh/gmsh_types.hpp"

namespace palpate::mesher {
namespace {

constexpr std::array<const char*, 4> kEntityNames{"point", "curve", "surface", "volume"};

/// Numbers of a section, which are words or bytes.
class Values {
 public:
  explicit Values(Scanner& scanner) : scanner_(scanner) {}

  void read_format() {
    const std::string_view line = scanner_.required_line("the version of the format");
    Fields fields(line, scanner_);
    version_ = fields.real("the version of the format");
    is_binary_ = fields.integer("0 (text) or 1 (binary)") != 0;
    const auto size = fields.integer("the size of a number");
    if (std::floor(version_) != 2 && version_ != 4.1) {
      scanner_.refuse(text("version ", version_, " of the MSH format"),
                      "save it as version 4.1 or 2.2 (gmsh -format msh41)");
    }
    if (size != 8) scanner_.refuse(text("numbers of ", size, " bytes"));
    if (!is_binary_) return;
    constexpr std::int32_t one = 1;
    if (scanner_.binary<std::int32_t>("the byte order") == one) return;
    is_swapped_ = true;
  }
  bool is_version_4() const { return version_ > 4; }
  bool is_binary() const { return is_binary_; }

  std::int64_t integer(std::string_view what) {
    return is_binary_ ? scanner_.binary<std::int32_t>(what, is_swapped_) : scanner_.integer(what);
  }
  /// A number that version 4 stores in eight bytes.
  std::int64_t size(std::string_view what) {
    return is_binary_ ? scanner_.binary<std::int64_t>(what, is_swapped_) : scanner_.integer(what);
  }
  std::size_t count(std::string_view what, std::size_t smallest) {
    return scanner_.checked_count(size(what), what, smallest);
  }
  double real(std::string_view what) {
    return is_binary_ ? scanner_.binary<double>(what, is_swapped_) : scanner_.real(what);
  }

 private:
  Scanner& scanner_;
  double version_ = 0;
  bool is_binary_ = false, is_swapped_ = false;
};

/// What the elements of one group of the file have in common.
struct Group {
  std::int32_t region = 0;
  std::vector<std::string> sets;
};

class GmshReader {
 public:
  GmshReader(std::string_view bytes, const std::string& file)
      : scanner_(bytes, file), values_(scanner_) {}

  MeshEntities read() {
    const auto first = Fields(scanner_.required_line("$MeshFormat"), scanner_).next();
    if (first == "$NOD") {
      section(std::string(first));
    } else if (first == "$MeshFormat") {
      values_.read_format();
      skip("$EndMeshFormat");
    } else {
      scanner_.refuse("the file begins with neither $MeshFormat nor $NOD",
                      "export it as MSH by Gmsh");
    }
    while (const auto line = scanner_.line()) {
      if (line->empty() || line->front() != '$') continue;
      section(std::string(Fields(*line, scanner_).next()));
    }
    return std::move(mesh_);
  }

 private:
  void skip(const std::string& end) { scanner_.skip_past(end); }

  void section(const std::string& name) {
    if (name == "$PhysicalNames") {
      physical_names();
    } else if (name == "$Entities" && values_.is_version_4()) {
      entities();
    } else if (name == "$Nodes") {
      values_.is_version_4() ? nodes_4() : nodes_2();
    } else if (name == "$Elements") {
      values_.is_version_4() ? elements_4() : elements_2();
    } else if (name == "$NOD") {
      nodes_2();
    } else if (name == "$ELM") {
      elements_1();
    } else if (name == "$PartitionedEntities") {
      scanner_.refuse("the mesh is partitioned", "save it without partitions");
    }
    const bool is_version_1 = name == "$NOD" || name == "$ELM";
    skip((is_version_1 ? "$END" : "$End") + name.substr(1));
  }

  void physical_names() {
    const std::size_t count = scanner_.count("the number of physical names", 6);
    scanner_.line();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string_view line = scanner_.required_line("a physical name");
      Fields fields(line, scanner_);
      const std::int64_t dimension = fields.integer("a dimension");
      const std::int64_t tag = fields.integer("the number of a physical group");
      const std::size_t first = line.find('"'), last = line.rfind('"');
      if (first == last) scanner_.refuse("a physical name without quotes");
      names_[{dimension, tag}] = line.substr(first + 1, last - first - 1);
    }
  }

  void entities() {
    std::array<std::size_t, 4> counts{};
    for (std::size_t& count : counts) count = values_.count("the number of entities", 10);
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t tag = values_.integer("the number of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) values_.real("the bounds of an entity");
        auto& groups = groups_of_[{static_cast<std::int64_t>(dimension), tag}];
        const std::size_t physical = values_.count("the number of physical groups", 2);
        for (std::size_t k = 0; k < physical; ++k)
          groups.push_back(std::abs(values_.integer("the number of a physical group")));
        if (dimension == 0) continue;
        const std::size_t bounding = values_.count("the number of bounding entities", 2);
        for (std::size_t k = 0; k < bounding; ++k) values_.integer("a bounding entity");
      }
    }
  }

  void add_node(std::int64_t number, const Vec3& x) {
    if (!index_.add(number)) scanner_.refuse(text("node ", number, " is listed twice"));
    mesh_.nodes.push_back(x);
    mesh_.node_numbers.push_back(number);
  }
  Vec3 coordinates() {
    Vec3 x{};
    for (double& component : x) component = values_.real("a coordinate");
    return x;
  }

  void nodes_2() {
    const std::size_t count = scanner_.count("the number of nodes", 8);
    scanner_.line();
    index_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t number = values_.integer("the number of a node");
      add_node(number, coordinates());
    }
  }

  void nodes_4() {
    const std::size_t blocks = values_.count("the number of blocks of nodes", 8);
    index_.reserve(values_.count("the number of nodes", 8));
    for (int k = 0; k < 2; ++k) values_.size("the range of node numbers");
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = values_.integer("the dimension of an entity");
      values_.integer("the number of an entity");
      const bool is_parametric = values_.integer("0 or 1: parametric coordinates") != 0;
      std::vector<std::int64_t> numbers(values_.count("the number of nodes in a block", 8));
      for (std::int64_t& number : numbers) number = values_.size("the number of a node");
      for (const std::int64_t number : numbers) {
        add_node(number, coordinates());
        for (std::int64_t k = 0; is_parametric && k < std::min<std::int64_t>(dimension, 3); ++k)
          values_.real("a parametric coordinate");
      }
    }
  }

  const GmshType& type_of(std::int64_t number) {
    const auto found = std::find_if(kGmshTypes.begin(), kGmshTypes.end(),
                                    [&](const GmshType& type) { return type.number == number; });
    if (found == kGmshTypes.end()) {
      scanner_.refuse(text("elements of type ", number, " of Gmsh, which palpate does not know"),
                      "mesh the body with tetrahedra of the first or the second order");
    }
    return *found;
  }

  /// Version 1 [chapter 10 of the same manual]: "number type group entity count nodes...".
  void elements_1() {
    const std::size_t count = scanner_.count("the number of elements", 10);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t number = scanner_.integer("the number of an element");
      const GmshType& type = type_of(scanner_.integer("the type of an element"));
      const std::int64_t physical = std::abs(scanner_.integer("the number of a physical group"));
      const std::int64_t entity = scanner_.integer("the number of an entity");
      if (scanner_.integer("the number of nodes") != static_cast<std::int64_t>(type.nodes))
        scanner_.refuse(text("element ", number, " has another number of nodes than its type"));
      std::vector<std::int64_t> groups;
      if (physical != 0) groups.push_back(physical);
      for (std::size_t k = 0; k < type.nodes; ++k)
        nodes_.push_back(node(scanner_.integer("a node of an element"), number));
      add_element(type, number, group_of(type.dimension, entity, groups));
    }
  }

  /// Text: "number type tags... nodes...". Binary: blocks of elements of one type.
  void elements_2() {
    const std::size_t count = scanner_.count("the number of elements", 4);
    scanner_.line();
    for (std::size_t done = 0; done < count;) {
      std::int64_t number = values_.is_binary() ? 0 : values_.integer("the number of an element");
      const GmshType& type = type_of(values_.integer("the type of an element"));
      const std::size_t block =
          values_.is_binary()
              ? scanner_.checked_count(values_.integer("the number of elements"),
                                       "the number of elements", 4 * (1 + type.nodes))
              : 1;
      const std::size_t tags =
          scanner_.checked_count(values_.integer("the number of tags"), "the number of tags", 2);
      if (block == 0) scanner_.refuse("a block without elements");
      for (std::size_t i = 0; i < block; ++i, ++done) {
        if (values_.is_binary()) number = values_.integer("the number of an element");
        std::int64_t physical = 0, entity = 0;
        for (std::size_t k = 0; k < tags; ++k) {
          const std::int64_t tag = values_.integer("a tag of an element");
          if (k == 0) physical = std::abs(tag);
          if (k == 1) entity = tag;
        }
        std::vector<std::int64_t> groups;
        if (physical != 0) groups.push_back(physical);
        const Group& group = group_of(type.dimension, entity, groups);
        for (std::size_t k = 0; k < type.nodes; ++k)
          nodes_.push_back(node(values_.integer("a node of an element"), number));
        add_element(type, number, group);
      }
    }
  }

  void elements_4() {
    const std::size_t blocks = values_.count("the number of blocks of elements", 8);
    for (int k = 0; k < 3; ++k) values_.size("the range of element numbers");
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = values_.integer("the dimension of an entity");
      const std::int64_t entity = values_.integer("the number of an entity");
      const GmshType& type = type_of(values_.integer("the type of the elements"));
      if (type.dimension != dimension) {
        scanner_.refuse(text(type.name, " in an entity of dimension ", dimension));
      }
      const Group group = group_of(type.dimension, entity, groups_of_[{dimension, entity}]);
      const std::size_t count = values_.count("the number of elements in a block", 4);
      for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t number = values_.size("the number of an element");
        for (std::size_t k = 0; k < type.nodes; ++k)
          nodes_.push_back(node(values_.size("a node of an element"), number));
        add_element(type, number, group);
      }
    }
  }

  std::int32_t node(std::int64_t number, std::int64_t element) {
    const auto index = index_.find(number);
    if (!index) {
      scanner_.refuse(text("element ", element, " has node ", number,
                           ", which is not among the nodes before it"));
    }
    return *index;
  }

  const Group& group_of(int dimension, std::int64_t entity, const std::vector<std::int64_t>& tags) {
    const auto [found, is_new] = groups_.try_emplace({dimension, entity, tags});
    Group& group = found->second;
    if (!is_new) return group;
    const char* kind = kEntityNames[static_cast<std::size_t>(dimension)];
    for (const std::int64_t tag : tags) {
      const auto name = names_.find({dimension, tag});
      group.sets.push_back(name == names_.end() ? text("physical ", kind, " ", tag) : name->second);
    }
    if (dimension == 3) {
      group.region = mesh_.region(tags.empty() ? kUnnamedRegion : group.sets.front());
      if (!tags.empty()) group.sets.erase(group.sets.begin());
    }
    if (tags.empty()) group.sets.push_back(text(kind, " ", entity));
    return group;
  }

  /// Takes its nodes out of nodes_.
  void add_element(const GmshType& type, std::int64_t number, const Group& group) {
    for (const std::string& set : group.sets) mesh_.add_to_set(set, nodes_);
    const bool quadratic = type.number == kGmshQuadraticTetrahedron;
    if (quadratic || type.number == kGmshTetrahedron) {
      ListedTetrahedron& t = mesh_.tetrahedra.emplace_back();
      std::copy(nodes_.begin(), nodes_.end(), t.nodes.begin());
      if (quadratic) std::swap(t.nodes[8], t.nodes[9]);  // Gmsh: edge 2-3 before edge 1-3
      t.quadratic = quadratic;
      t.region = group.region;
      t.number = number;
      for (const std::string& set : group.sets)
        mesh_.groups[set].push_back(static_cast<std::int32_t>(mesh_.tetrahedra.size() - 1));
    } else if (type.dimension == 3) {
      ++mesh_.other_solids[type.name];
    }
    nodes_.clear();
  }

  Scanner scanner_;
  Values values_;
  MeshEntities mesh_;
  NumberIndex index_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::string> names_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::int64_t>> groups_of_;
  std::map<std::tuple<int, std::int64_t, std::vector<std::int64_t>>, Group> groups_;
  std::vector<std::int32_t> nodes_;
};

}  // namespace

MeshEntities read_gmsh(std::string_view bytes, const std::string& file) {
  return GmshReader(bytes, file).read();
}

}  // namespace palpate::mesher
