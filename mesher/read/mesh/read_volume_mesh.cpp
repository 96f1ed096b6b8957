// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_volume_mesh.hpp"

#include <set>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/mesh/assemble.hpp"
#include "mesher/read/mesh/read_abaqus.hpp"
#include "mesher/read/mesh/read_febio.hpp"
#include "mesher/read/mesh/read_gmsh.hpp"
#include "mesher/read/mesh/read_medit.hpp"
#include "mesher/read/mesh/read_tetgen.hpp"
#include "mesher/read/vtk/read_vtk_legacy.hpp"
#include "mesher/read/vtk/read_vtk_xml.hpp"

namespace palpate::mesher {
namespace {

MeshEntities read_tetgen_files(std::filesystem::path path) {
  const auto sibling = [&](const char* kind) { return path.replace_extension(kind); };
  const std::filesystem::path node = sibling(".node"), ele = sibling(".ele"),
                              face = sibling(".face");
  const std::string nodes = read_bytes(node), elements = read_bytes(ele);
  const std::string faces = std::filesystem::exists(face) ? read_bytes(face) : std::string();
  return read_tetgen({nodes, node.string()}, {elements, ele.string()}, {faces, face.string()});
}

/// Some programs give files in XML the ending .vtk, as VTK itself reads them.
MeshEntities read_vtk_entities(const VolumeMeshFile& file) {
  const std::string where = file.path.string(), bytes = read_bytes(file.path);
  const bool is_xml = bytes.starts_with("<?xml") || bytes.starts_with("<VTKFile");
  return volume_entities(is_xml ? read_vtk_xml(bytes, where) : read_vtk_legacy(bytes, where),
                         file.region_array, where);
}

MeshEntities read_entities(const VolumeMeshFile& file) {
  const std::string where = file.path.string(), kind = ending(file.path);
  check_readable(file.path);
  if (kind == ".node" || kind == ".ele") return read_tetgen_files(file.path);
  if (kind == ".msh") return read_gmsh(read_bytes(file.path), where);
  if (kind == ".inp") return read_abaqus(read_bytes(file.path), where);
  if (kind == ".feb") return read_febio(read_bytes(file.path), where);
  if (kind == ".mesh") return read_medit(read_bytes(file.path), where);
  if (kind == ".vtu" || kind == ".vtk") return read_vtk_entities(file);
  refuse_kind(file.path, "volume mesh",
              ".msh, .mesh, .vtu, .vtk, .inp, .feb or .node and .ele (meshio does)");
}

/// Names of the regions that have elements, and of the other groups.
std::set<std::string> group_names(const MeshEntities& entities) {
  std::set<std::string> names;
  for (const ListedTetrahedron& t : entities.tetrahedra)
    names.insert(entities.region_names[to_index(t.region)]);
  for (const auto& [name, tetrahedra] : entities.groups) names.insert(name);
  return names;
}

/// Under their names in the file, groups stay sets of nodes.
void keep_as_set(MeshEntities& entities, const std::string& group,
                 const std::vector<std::int32_t>& members) {
  if (entities.node_sets.contains(group)) return;
  auto& set = entities.node_sets[group];
  for (const std::int32_t t : members) {
    const auto& nodes = entities.tetrahedra[to_index(t)].nodes;
    set.insert(set.end(), nodes.begin(), nodes.begin() + 4);
  }
}

/// The tetrahedra of a region of the file, or of another group.
std::vector<std::int32_t> members_of(const MeshEntities& entities, const std::string& group) {
  std::vector<std::int32_t> members;
  for (std::size_t t = 0; t < entities.tetrahedra.size(); ++t)
    if (entities.region_names[to_index(entities.tetrahedra[t].region)] == group)
      members.push_back(static_cast<std::int32_t>(t));
  const auto other = entities.groups.find(group);
  return members.empty() && other != entities.groups.end() ? other->second : members;
}

/// Groups of one region are joined.
void rename_regions(MeshEntities& entities, const VolumeMeshFile& file) {
  std::vector<std::vector<std::int32_t>> members;
  for (const GroupRegion& entry : file.regions) {
    members.push_back(members_of(entities, entry.group));
    if (members.back().empty()) {
      std::string list;
      for (const std::string& name : group_names(entities))
        list += text(list.empty() ? "" : ", ", "'", name, "'");
      refuse(file.path.string(), text("no tetrahedron belongs to the group '", entry.group, "'"),
             list.empty() ? "the file has no tetrahedra" : text("use one of ", list));
    }
    keep_as_set(entities, entry.group, members.back());
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::int32_t region = entities.region(file.regions[i].region);
    for (const std::int32_t t : members[i]) entities.tetrahedra[to_index(t)].region = region;
  }
}

}  // namespace

VolumeMesh read_volume_mesh(const VolumeMeshFile& file, const Log& log) {
  MeshEntities entities = read_entities(file);
  rename_regions(entities, file);
  return assemble(std::move(entities), file.unit, file.path.string(), log);
}

}  // namespace palpate::mesher
