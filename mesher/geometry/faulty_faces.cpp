// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/faulty_faces.hpp"

#include <limits>
#include <sstream>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::mesher {

void FaultyFaces::add(const Vec3& a, const Vec3& b, const Vec3& c, Fault fault) {
  points.insert(points.end(), {a, b, c});
  faults.push_back(fault);
}

void FaultyFaces::add(const Surface& surface, const Triangle& triangle, Fault fault) {
  const auto corner = [&](std::size_t k) { return surface.points[to_index(triangle[k])]; };
  add(corner(0), corner(1), corner(2), fault);
}

void FaultyFaces::add(const std::vector<Vec3>& from, const std::vector<std::size_t>& corners,
                      Fault fault) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    add(from[corners[0]], from[corners[k - 1]], from[corners[k]], fault);
}

FaultySurface::FaultySurface(std::string where, std::string problem, std::string remedy,
                             FaultyFaces faces)
    : Error(ErrorKind::Geometry, std::move(where), std::move(problem), std::move(remedy)),
      faces_(std::move(faces)) {}

std::string vtp_text(const FaultyFaces& faces) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  const std::size_t count = faces.faults.size();
  const auto open = [&](const char* type, const char* name) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
  };
  const auto close = [&] { out << "</DataArray>\n"; };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
      << "<Piece NumberOfPoints=\"" << faces.points.size() << "\" NumberOfPolys=\"" << count
      << "\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      << "format=\"ascii\">\n";
  for (const Vec3& x : faces.points) out << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  close();
  out << "</Points>\n<Polys>\n";
  open("Int32", "connectivity");
  for (std::size_t v = 0; v < faces.points.size(); ++v) out << v << (v % 3 == 2 ? '\n' : ' ');
  close();
  open("Int32", "offsets");
  for (std::size_t f = 1; f <= count; ++f) out << 3 * f << '\n';
  close();
  out << "</Polys>\n<CellData Scalars=\"fault\">\n";
  open("Int32", "fault");
  for (const Fault fault : faces.faults) out << static_cast<std::int32_t>(fault) << '\n';
  close();
  out << "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return out.str();
}

}  // namespace palpate::mesher
