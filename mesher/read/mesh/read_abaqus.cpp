// SPDX-License-Identifier: AGPL-3.0-or-later
// [CalculiX CrunchiX user's manual 2.20, chapter 7; Abaqus keywords reference guide]
#include "mesher/read/mesh/read_abaqus.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kMostElementNodes = 32;

constexpr const char* kFlatten =
    "export one part as a flat input file (Abaqus/CAE: model attributes, no parts and assemblies)";

/// Keywords that make or move nodes and elements, which palpate does not repeat.
constexpr std::array<std::string_view, 9> kGenerators{
    "*include", "*ngen", "*nfill", "*ncopy", "*nmap", "*elgen", "*elcopy", "*system", "*transform"};

/// The corners of side S1 to S4 of a tetrahedron.
constexpr std::array<std::array<std::size_t, 3>, 4> kSides{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

/// A keyword line in lower case but for the values of its parameters.
struct Keyword {
  std::string where;
  std::string name;
  std::map<std::string, std::string> parameters;

  std::string value(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? std::string() : found->second;
  }
  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
};

/// Nodes of an element by its type: C3D10 and its variants have ten.
struct ElementType {
  bool is_solid = false;
  std::size_t nodes = 0;  ///< 0: unknown
};

ElementType element_type(const std::string& name) {
  const std::size_t mark = name.find("3d");
  if (mark == std::string::npos || mark + 2 >= name.size()) return {};
  ElementType type;
  type.is_solid = mark > 0 && name[mark - 1] == 'c';
  for (std::size_t i = mark + 2; i < name.size() && name[i] >= '0' && name[i] <= '9'; ++i)
    type.nodes = 10 * type.nodes + static_cast<std::size_t>(name[i] - '0');
  return type.nodes > kMostElementNodes ? ElementType{} : type;
}

std::string solid_name(std::size_t nodes) {
  switch (nodes) {
    case 5:
    case 13:
      return "pyramids";
    case 6:
    case 15:
      return "wedges";
    case 8:
    case 20:
    case 27:
      return "hexahedra";
    default:
      return text("elements of ", nodes, " nodes");
  }
}

struct AbaqusElement {
  std::vector<std::int32_t> nodes;
  std::int32_t tetrahedron = -1;  ///< index into MeshEntities::tetrahedra
};

class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, const std::string& file) : scanner_(bytes, file) {}

  MeshEntities read() {
    advance();
    while (line_) {
      if (!is_keyword()) {
        advance();  // data of a keyword that is skipped, or a title
        continue;
      }
      const Keyword keyword = take_keyword();
      dispatch(keyword);
    }
    if (mesh_.nodes.empty())
      scanner_.refuse("the file has no *NODE", "give a mesh of Abaqus or CalculiX");
    set_regions();
    return std::move(mesh_);
  }

 private:
  /// To the next line that is neither empty nor a comment.
  void advance() {
    do {
      line_ = scanner_.line();
    } while (line_ && (line_->empty() || line_->starts_with("**")));
  }
  bool is_keyword() const { return line_->front() == '*'; }
  bool has_data() const { return line_ && !is_keyword(); }

  Keyword take_keyword() {
    Keyword keyword;
    keyword.where = scanner_.where();
    std::string whole(*line_);
    advance();
    while (whole.back() == ',' && has_data()) {
      whole += *line_;
      advance();
    }
    Fields fields(whole, scanner_, ',');
    keyword.name = lower(std::string(fields.next()));
    while (!fields.at_end()) {
      const std::string field(fields.next());
      const std::size_t equals = std::min(field.find('='), field.size());
      std::string name = lower(std::string(trimmed_blanks(field.substr(0, equals))));
      keyword.parameters[name] =
          equals < field.size() ? trimmed_blanks(field.substr(equals + 1)) : std::string();
    }
    return keyword;
  }
  static std::string trimmed_blanks(const std::string& word) {
    const std::size_t first = word.find_first_not_of(" \t\"");
    return first == std::string::npos
               ? std::string()
               : word.substr(first, word.find_last_not_of(" \t\"") - first + 1);
  }

  void dispatch(const Keyword& keyword) {
    if (keyword.name == "*node") {
      nodes(keyword);
    } else if (keyword.name == "*element") {
      elements(keyword);
    } else if (keyword.name == "*nset") {
      node_set(keyword);
    } else if (keyword.name == "*elset") {
      element_set(keyword);
    } else if (keyword.name == "*surface") {
      surface(keyword);
    } else if (keyword.name == "*solid section") {
      sections_.push_back(name_of(keyword.value("elset")));
    } else if (keyword.name == "*part" && ++parts_ > 1) {
      refuse_geometry(keyword.where, "several parts", kFlatten);
    } else if (keyword.name == "*instance" && (++instances_ > 1 || has_data())) {
      refuse_geometry(keyword.where,
                      instances_ > 1 ? "several instances" : "an instance that is moved", kFlatten);
    } else if (std::find(kGenerators.begin(), kGenerators.end(), keyword.name) !=
               kGenerators.end()) {
      refuse_geometry(keyword.where,
                      text("the keyword ", keyword.name, ", which palpate does not follow"),
                      "write all nodes and elements into one file, in Cartesian coordinates");
    }
  }

  /// Names differ by more than the case of their letters; the first spelling is kept.
  std::string name_of(const std::string& name) {
    return spelling_.try_emplace(lower(name), name).first->second;
  }
  std::string required(const Keyword& keyword, const std::string& parameter) {
    if (keyword.value(parameter).empty()) {
      refuse_geometry(keyword.where, text(keyword.name, " without ", parameter), kDamagedFile);
    }
    return name_of(keyword.value(parameter));
  }

  void nodes(const Keyword& keyword) {
    if (keyword.has("system") && lower(keyword.value("system")) != "r") {
      refuse_geometry(keyword.where, "nodes in cylindrical or spherical coordinates",
                      "write them in Cartesian coordinates");
    }
    std::vector<std::int32_t>* set =
        keyword.has("nset") ? &mesh_.node_sets[required(keyword, "nset")] : nullptr;
    for (; has_data(); advance()) {
      Fields fields(*line_, scanner_, ',');
      const std::int64_t number = fields.integer("the number of a node");
      Vec3 x{};
      for (double& component : x)
        if (!fields.at_end()) component = fields.real("a coordinate");
      if (!index_.add(number)) scanner_.refuse(text("node ", number, " is listed twice"));
      if (set != nullptr) set->push_back(static_cast<std::int32_t>(mesh_.nodes.size()));
      mesh_.nodes.push_back(x);
      mesh_.node_numbers.push_back(number);
    }
  }

  std::int32_t node(std::int64_t number) {
    const auto found = index_.find(number);
    if (!found) scanner_.refuse(text("node ", number, " is not among the nodes before it"));
    return *found;
  }

  void elements(const Keyword& keyword) {
    const std::string name = lower(keyword.value("type"));
    if (name.empty()) refuse_geometry(keyword.where, "*ELEMENT without TYPE", kDamagedFile);
    const ElementType type = element_type(name);
    std::vector<std::int64_t>* set =
        keyword.has("elset") ? &element_sets_[required(keyword, "elset")] : nullptr;
    const std::int32_t region =
        mesh_.region(keyword.has("elset") ? name_of(keyword.value("elset")) : kUnnamedRegion);
    while (has_data()) {
      std::int64_t number = 0;
      AbaqusElement element;
      bool is_first = true, goes_on = true;
      while (goes_on && has_data()) {
        Fields fields(*line_, scanner_, ',');
        if (is_first) number = fields.integer("the number of an element");
        is_first = false;
        while (!fields.at_end()) {
          element.nodes.push_back(node(fields.integer("a node of an element")));
          if (element.nodes.size() > kMostElementNodes)
            scanner_.refuse("an element of too many nodes");
        }
        goes_on = type.nodes != 0 ? element.nodes.size() < type.nodes : line_->back() == ',';
        advance();
      }
      if (type.nodes != 0 && element.nodes.size() != type.nodes) {
        scanner_.refuse(text("element ", number, " has ", element.nodes.size(), " nodes, ",
                             type.nodes, " expected"));
      }
      add_element(number, type, region, std::move(element));
      if (set != nullptr) set->push_back(number);
    }
  }

  void add_element(std::int64_t number, const ElementType& type, std::int32_t region,
                   AbaqusElement element) {
    if (type.is_solid && (type.nodes == 4 || type.nodes == 10)) {
      element.tetrahedron = static_cast<std::int32_t>(mesh_.tetrahedra.size());
      ListedTetrahedron& t = mesh_.tetrahedra.emplace_back();
      std::copy(element.nodes.begin(), element.nodes.end(), t.nodes.begin());
      t.quadratic = type.nodes == 10;
      t.region = region;
      t.number = number;
    } else if (type.is_solid) {
      ++mesh_.other_solids[solid_name(type.nodes)];
    }
    if (!elements_.emplace(number, std::move(element)).second) {
      scanner_.refuse(text("element ", number, " is listed twice"));
    }
    element_numbers_.push_back(number);
  }

  const AbaqusElement& element(std::int64_t number) {
    const auto found = elements_.find(number);
    if (found == elements_.end()) {
      scanner_.refuse(text("element ", number, " is not among the elements before it"));
    }
    return found->second;
  }

  /// The numbers of a set: listed, those of `known` from first to last by steps, or those of
  /// another set.
  /// @param of_set the numbers of a set by its name
  template <class OfSet>
  std::vector<std::int64_t> numbers(const Keyword& keyword, const std::vector<std::int64_t>& known,
                                    const OfSet& of_set) {
    std::vector<std::int64_t> found;
    for (; has_data(); advance()) {
      Fields fields(*line_, scanner_, ',');
      if (keyword.has("generate")) {
        add_range(fields, known, found);
        continue;
      }
      while (!fields.at_end()) {
        const std::string_view field = fields.next();
        if (field.empty()) continue;
        if (const auto number = integer_of(field)) {
          found.push_back(*number);
        } else {
          const auto more = of_set(name_of(trimmed_blanks(std::string(field))));
          found.insert(found.end(), more.begin(), more.end());
        }
      }
    }
    return found;
  }

  void add_range(Fields& fields, const std::vector<std::int64_t>& known,
                 std::vector<std::int64_t>& found) {
    const std::int64_t first = fields.integer("the first number");
    const std::int64_t last = fields.integer("the last number");
    const std::int64_t step = fields.at_end() ? 1 : fields.integer("a step");
    if (step < 1 || first < 0 || last < first) {
      scanner_.refuse(text("numbers from ", first, " to ", last, " by ", step));
    }
    for (const std::int64_t number : known)
      if (number >= first && number <= last && (number - first) % step == 0)
        found.push_back(number);
  }

  void node_set(const Keyword& keyword) {
    const std::string name = required(keyword, "nset");
    std::vector<std::int32_t> nodes;
    if (keyword.has("elset")) {
      for (const std::int64_t number : element_set_of(name_of(keyword.value("elset"))))
        nodes.insert(nodes.end(), element(number).nodes.begin(), element(number).nodes.end());
    }
    const auto of_set = [&](const std::string& other) {
      std::vector<std::int64_t> found;
      const auto set = mesh_.node_sets.find(other);
      if (set == mesh_.node_sets.end()) scanner_.refuse(text("there is no node set '", other, "'"));
      for (const std::int32_t i : set->second) found.push_back(mesh_.node_numbers[to_index(i)]);
      return found;
    };
    for (const std::int64_t number : numbers(keyword, mesh_.node_numbers, of_set))
      nodes.push_back(node(number));
    mesh_.add_to_set(name, nodes);
  }

  const std::vector<std::int64_t>& element_set_of(const std::string& name) {
    const auto found = element_sets_.find(name);
    if (found == element_sets_.end()) scanner_.refuse(text("there is no element set '", name, "'"));
    return found->second;
  }

  void element_set(const Keyword& keyword) {
    const std::string name = required(keyword, "elset");
    const auto more = numbers(keyword, element_numbers_,
                              [&](const std::string& other) { return element_set_of(other); });
    for (const std::int64_t number : more) element(number);
    auto& set = element_sets_[name];
    set.insert(set.end(), more.begin(), more.end());
  }

  /// Sides of elements or of the elements of a set, "S1" to "S4"; or nodes.
  void surface(const Keyword& keyword) {
    const std::string name = required(keyword, "name");
    const bool is_of_nodes = lower(keyword.value("type")) == "node";
    std::vector<std::int32_t> found;
    for (; has_data(); advance()) {
      Fields fields(*line_, scanner_, ',');
      const std::string_view first = fields.next();
      const std::string side = lower(std::string(fields.next()));
      const auto number = integer_of(first);
      const std::string set = number ? std::string() : name_of(trimmed_blanks(std::string(first)));
      if (is_of_nodes) {
        if (number) found.push_back(node(*number));
        if (!number && !mesh_.node_sets.contains(set))
          scanner_.refuse(text("there is no node set '", set, "'"));
        if (!number)
          found.insert(found.end(), mesh_.node_sets[set].begin(), mesh_.node_sets[set].end());
        continue;
      }
      for (const std::int64_t e : number ? std::vector<std::int64_t>{*number} : element_set_of(set))
        add_side(element(e), side, found);
    }
    mesh_.add_to_set(name, found);
  }

  void add_side(const AbaqusElement& element, const std::string& side,
                std::vector<std::int32_t>& found) {
    if (element.tetrahedron < 0) {  // a shell: all of it
      found.insert(found.end(), element.nodes.begin(), element.nodes.end());
      return;
    }
    const bool is_side = side.size() == 2 && side[0] == 's' && side[1] >= '1' && side[1] <= '4';
    if (!is_side) scanner_.refuse(text("side '", side.substr(0, 10), "' of a tetrahedron"));
    for (const std::size_t corner : kSides[static_cast<std::size_t>(side[1] - '1')])
      found.push_back(element.nodes[corner]);
  }

  void set_regions() {
    for (const auto& [name, numbers] : element_sets_) {
      auto& group = mesh_.groups[name];
      std::vector<std::int32_t> nodes;
      for (const std::int64_t number : numbers) {
        const AbaqusElement& member = elements_.at(number);
        nodes.insert(nodes.end(), member.nodes.begin(), member.nodes.end());
        if (member.tetrahedron >= 0) group.push_back(member.tetrahedron);
      }
      if (!mesh_.node_sets.contains(name)) mesh_.add_to_set(name, nodes);
    }
    for (const std::string& section : sections_) assign(section);
    if (sections_.empty() && sets_divide_the_body())
      for (const auto& [name, members] : mesh_.groups) assign(name);
  }

  void assign(const std::string& set) {
    const std::int32_t region = mesh_.region(set);
    for (const std::int32_t t : mesh_.groups[set]) mesh_.tetrahedra[to_index(t)].region = region;
  }

  /// Whether each tetrahedron is in one element set and no more.
  bool sets_divide_the_body() const {
    std::vector<int> sets(mesh_.tetrahedra.size(), 0);
    for (const auto& [name, members] : mesh_.groups)
      for (const std::int32_t t : std::set<std::int32_t>(members.begin(), members.end()))
        ++sets[to_index(t)];
    return std::all_of(sets.begin(), sets.end(), [](int count) { return count == 1; });
  }

  Scanner scanner_;
  std::optional<std::string_view> line_;
  MeshEntities mesh_;
  NumberIndex index_;
  std::unordered_map<std::int64_t, AbaqusElement> elements_;
  std::vector<std::int64_t> element_numbers_;
  std::map<std::string, std::vector<std::int64_t>> element_sets_;
  std::map<std::string, std::string> spelling_;  ///< by the name in lower case
  std::vector<std::string> sections_;            ///< element sets
  int parts_ = 0, instances_ = 0;
};

}  // namespace

MeshEntities read_abaqus(std::string_view bytes, const std::string& file) {
  return AbaqusReader(bytes, file).read();
}

}  // namespace palpate::mesher
