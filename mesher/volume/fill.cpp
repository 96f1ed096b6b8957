// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/fill.hpp"

#define TETLIBRARY
#include <sys/wait.h>
#include <tetgen.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <system_error>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

// TetGen's size test is a plain function without a context.
thread_local double longest_edge_squared = 0;

bool too_large(REAL* a, REAL* b, REAL* c, REAL* d, REAL*, REAL) {
  const REAL* corner[] = {a, b, c, d};
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      double squared = 0;
      for (int k = 0; k < 3; ++k) {
        const double difference = corner[i][k] - corner[j][k];
        squared += difference * difference;
      }
      if (squared > longest_edge_squared) return true;
    }
  }
  return false;
}

/// TetGen frees its arrays with delete[]; the facets own theirs.
void copy_to(tetgenio& in, const Surface& shells) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(shells.points.size());
  in.pointlist = new REAL[3 * shells.points.size()];
  for (std::size_t i = 0; i < shells.points.size(); ++i) {
    std::copy(shells.points[i].begin(), shells.points[i].end(), in.pointlist + 3 * i);
  }
  in.numberoffacets = static_cast<int>(shells.triangles.size());
  in.facetlist = new tetgenio::facet[shells.triangles.size()];
  for (std::size_t t = 0; t < shells.triangles.size(); ++t) {
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    std::copy(shells.triangles[t].begin(), shells.triangles[t].end(),
              facet.polygonlist->vertexlist);
  }
}

[[noreturn]] void refuse(int status, const std::string& where) {
  throw Error(ErrorKind::Geometry, where,
              text("TetGen cannot fill the facets with tetrahedra (",
                   WIFSIGNALED(status) ? "it crashed with signal " : "its code ",
                   WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), ")"),
              "smooth the surface or change patch_spacing and element_size a little");
}

double signed_volume6(const std::vector<Vec3>& x, const Tetrahedron& t) {
  const auto at = [&](std::size_t k) { return x[to_index(t[k])]; };
  return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0));
}

Filling filling_of(const tetgenio& out) {
  Filling filling;
  for (std::ptrdiff_t i = 0; i < out.numberofpoints; ++i) {
    const REAL* x = out.pointlist + 3 * i;
    filling.nodes.push_back({x[0], x[1], x[2]});
  }
  for (std::ptrdiff_t t = 0; t < out.numberoftetrahedra; ++t) {
    const int* v = out.tetrahedronlist + t * out.numberofcorners;
    Tetrahedron corners{v[0], v[1], v[2], v[3]};
    if (signed_volume6(filling.nodes, corners) < 0) std::swap(corners[2], corners[3]);
    filling.tetrahedra.push_back(corners);
    const REAL* attributes = out.tetrahedronattributelist;
    filling.part.push_back(
        attributes ? static_cast<int>(attributes[t * out.numberoftetrahedronattributes]) : 0);
  }
  return filling;
}

template <typename Record>
void send(std::FILE* pipe, const std::vector<Record>& records) {
  const std::size_t count = records.size();
  if (std::fwrite(&count, sizeof count, 1, pipe) != 1 ||
      std::fwrite(records.data(), sizeof(Record), count, pipe) != count) {
    _exit(EXIT_FAILURE);
  }
}

template <typename Record>
bool receive(std::FILE* pipe, std::vector<Record>& records) {
  std::size_t count = 0;
  if (std::fread(&count, sizeof count, 1, pipe) != 1) return false;
  records.resize(count);
  return std::fread(records.data(), sizeof(Record), count, pipe) == count;
}

[[noreturn]] void fill_as_child(const Surface& shells, std::string switches, int pipe_end) {
  tetgenio in, out;
  copy_to(in, shells);
  in.tetunsuitable = too_large;
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    _exit(code);
  }
  const Filling filling = filling_of(out);
  std::FILE* pipe = fdopen(pipe_end, "wb");
  send(pipe, filling.nodes);
  send(pipe, filling.tetrahedra);
  send(pipe, filling.part);
  _exit(std::fclose(pipe) == 0 ? EXIT_SUCCESS : EXIT_FAILURE);
}

/// TetGen 1.5.0 frees its memory twice when it throws, which crashes the process: the child
/// contains the crash.
Filling fill_in_child(const Surface& shells, const std::string& switches,
                      const std::string& where) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) fill_as_child(shells, switches, ends[1]);
  close(ends[1]);
  std::FILE* pipe = fdopen(ends[0], "rb");
  Filling filling;
  const bool complete = receive(pipe, filling.nodes) && receive(pipe, filling.tetrahedra) &&
                        receive(pipe, filling.part);
  std::fclose(pipe);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!complete || status != 0) refuse(status, where);
  return filling;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Checks that the points of the shells come first and that their triangles are faces.
void check_conforming(const Filling& filling, const Surface& shells, const std::string& where) {
  std::set<Triangle> faces;
  for (const Tetrahedron& t : filling.tetrahedra) {
    faces.insert({sorted({t[1], t[2], t[3]}), sorted({t[0], t[2], t[3]}),
                  sorted({t[0], t[1], t[3]}), sorted({t[0], t[1], t[2]})});
  }
  const bool same_points =
      filling.nodes.size() >= shells.points.size() &&
      std::equal(shells.points.begin(), shells.points.end(), filling.nodes.begin());
  const auto lost = std::count_if(shells.triangles.begin(), shells.triangles.end(),
                                  [&](const Triangle& t) { return !faces.contains(sorted(t)); });
  if (!same_points || lost > 0) {
    throw Error(ErrorKind::Internal, where,
                text("TetGen changed ", lost, " of ", shells.triangles.size(), " facets"),
                "change element_size or patch_spacing a little and report the case");
  }
}

/// A uniform filling with edges h takes about 1.5 V/h^3 points. Refinement that needs twenty times
/// as many does not converge.
std::size_t most_interior_points(const Surface& shells, double longest_edge) {
  const double uniform = 1.5 * std::abs(signed_volume(shells)) / std::pow(longest_edge, 3);
  return shells.points.size() * 20 + static_cast<std::size_t>(std::min(20 * uniform, 5e7));
}

}  // namespace

Filling fill(const Surface& shells, double longest_edge, const std::string& where) {
  longest_edge_squared = longest_edge * longest_edge;
  // p: from a surface; Y: preserve its triangles; M: do not merge coplanar ones; q: radius-edge
  // ratio and least dihedral angle; o: improve dihedral angles above 150 degrees; A: number the
  // closed cells; S: bound on the points it adds, and so on the time; Q: print nothing.
  const std::size_t most = most_interior_points(shells, longest_edge);
  Filling filling = fill_in_child(shells, text("pYMq1.3/12o/150AQS", most), where);
  check_conforming(filling, shells, where);
  filling.cut_short = filling.nodes.size() >= shells.points.size() + most;
  return filling;
}

}  // namespace palpate::mesher
