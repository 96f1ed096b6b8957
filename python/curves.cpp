// SPDX-License-Identifier: Apache-2.0
// palpate.Curves: curves.h5.
#include "format/curves.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "format/status_name.hpp"
#include "python/arrays.hpp"
#include "python/artifacts.hpp"
#include "python/errors.hpp"

namespace py = pybind11;

namespace palpate::python {
namespace {

Curves curves_of(const std::filesystem::path& path) {
  return read_file(path, "curves (curves.h5)",
                   [](const auto& file) { return palpate::read_curves(file); });
}

template <class Field>
auto of_samples(Field CurveSample::*field) {
  return column_of<CurvePath>(&CurvePath::samples, field);
}

py::array_t<double> force_along(const CurvePath& path) {
  py::array_t<double> along(static_cast<py::ssize_t>(path.samples.size()));
  std::transform(path.samples.begin(), path.samples.end(), along.mutable_data(),
                 [&](const CurveSample& sample) { return dot(sample.force, path.direction); });
  return along;
}

/// All rows have the regions of the body, or none.
py::array_t<double> isochoric_energy(const CurvePath& path) {
  const std::size_t regions =
      path.samples.empty() ? 0 : path.samples.front().isochoric_energy.size();
  py::array_t<double> energies({path.samples.size(), regions});
  double* to = energies.mutable_data();
  for (const CurveSample& sample : path.samples)
    to = std::copy(sample.isochoric_energy.begin(), sample.isochoric_energy.end(), to);
  return energies;
}

py::object normal_path(const py::object& self) {
  for (const CurvePath& path : self.cast<const SiteCurves&>().paths)
    if (path.kind == PathKind::Normal)
      return py::cast(path, py::return_value_policy::reference_internal, self);
  return py::none();
}

py::list lateral_paths(const py::object& self) {
  py::list paths;
  for (const CurvePath& path : self.cast<const SiteCurves&>().paths)
    if (path.kind == PathKind::Lateral)
      paths.append(py::cast(path, py::return_value_policy::reference_internal, self));
  return paths;
}

py::array_t<double> fractions(const Curves& curves) {
  const RegionRelaxation& all = curves.relaxation;
  py::array_t<double> made({all.fractions.size(), all.times_s.size()});
  double* to = made.mutable_data();
  for (const auto& region : all.fractions) to = std::copy(region.begin(), region.end(), to);
  return made;
}

py::array relaxation_times(const py::object& self) {
  return view(self, self.cast<const Curves&>().relaxation.times_s);
}

py::object site_of(const py::object& self, std::int32_t vertex) {
  const auto& sites = self.cast<const Curves&>().sites;
  const auto found =
      std::lower_bound(sites.begin(), sites.end(), vertex,
                       [](const SiteCurves& site, std::int32_t v) { return site.vertex < v; });
  if (found == sites.end() || found->vertex != vertex) {
    raise("ArgumentError", "Curves.site: vertex " + std::to_string(vertex) +
                               " is no site; those are the `vertex` of each of Curves.sites");
  }
  return py::cast(*found, py::return_value_policy::reference_internal, self);
}

std::string curves_text(const Curves& curves) {
  const auto complete =
      std::count_if(curves.sites.begin(), curves.sites.end(),
                    [](const SiteCurves& site) { return site.status == SiteStatus::Complete; });
  return "<palpate.Curves: " + std::to_string(curves.sites.size()) + " sites, " +
         std::to_string(complete) + " complete>";
}

void define_path(py::module_& module) {
  py::class_<CurvePath>(
      module, "CurvePath",
      "Converged states of the tool on a path, one row a sample, from the touch (normal) or from "
      "the\n"
      "state at the lateral depth (lateral). What is not known is NaN. Arrays are read-only views\n"
      "with strides, but force_along and isochoric_energy, which are copies.")
      .def("__len__", [](const CurvePath& path) { return path.samples.size(); })
      .def_property_readonly(
          "kind",
          [](const CurvePath& path) {
            return path.kind == PathKind::Normal ? "normal" : "lateral";
          },
          "\"normal\": along the press direction; \"lateral\": along `direction` at a constant "
          "depth, no slip.")
      .def_readonly("lateral_depth", &CurvePath::lateral_depth,
                    "m, of a lateral path; 0 for a normal one.")
      .def_property_readonly("direction", row_of(&CurvePath::direction),
                             "(3,) unit vector of the path.")
      .def_property_readonly("displacement", of_samples(&CurveSample::displacement),
                             "(K,) m, of the tool along the path, from 0.")
      .def_property_readonly("force", of_samples(&CurveSample::force),
                             "(K, 3) N, of the tool ON the body.")
      .def_property_readonly("force_along", &force_along, "(K,) N, the force along `direction`.")
      .def_property_readonly("strain_energy", of_samples(&CurveSample::strain_energy),
                             "(K,) J, since the touch.")
      .def_property_readonly("tool_work", of_samples(&CurveSample::tool_work),
                             "(K,) J, since the touch.")
      .def_property_readonly(
          "contact_energy", of_samples(&CurveSample::contact_energy),
          "(K,) J, in the springs that enforce the contact: tool_work = strain + contact energy.")
      .def_property_readonly(
          "isochoric_energy", &isochoric_energy,
          "(K, R) J, isochoric strain energy of each region; R = 0 where the tissue is elastic.")
      .def_property_readonly("min_jacobian", of_samples(&CurveSample::min_jacobian),
                             "(K,) smallest det F.")
      .def_property_readonly("penetration", of_samples(&CurveSample::penetration),
                             "(K,) m, of the contact.")
      .def_property_readonly("contact_area", of_samples(&CurveSample::contact_area), "(K,) m^2.")
      .def_property_readonly("tension", of_samples(&CurveSample::tension),
                             "(K,) N, that only a bonded contact carries.")
      .def_property_readonly("facets_in_contact", of_samples(&CurveSample::facets_in_contact),
                             "(K,) boundary facets that the contact covers.")
      .def_property_readonly("mesh_difference", of_samples(&CurveSample::mesh_difference),
                             "(K,) N, force expected from a finer mesh, less the force.")
      .def_property_readonly("mesh_error", of_samples(&CurveSample::mesh_error),
                             "(K,) N, bound of the error of the mesh along the path.")
      .def_property_readonly("volume_change", of_samples(&CurveSample::volume_change),
                             "(K,) m^3, of the body since the touch.")
      .def_property_readonly("iterations", of_samples(&CurveSample::iterations),
                             "(K,) int32, of Newton's method.")
      .def_property_readonly("force_scatter", of_samples(&CurveSample::force_scatter),
                             "(K,) N, between repeats.")
      .def_property_readonly("force_uncertainty", of_samples(&CurveSample::force_uncertainty),
                             "(K,) N, standard uncertainty along the path.")
      .def_readonly("repeats", &CurvePath::repeats, "Presses that were averaged; 0: simulated.")
      .def_readonly("contact_uncertainty", &CurvePath::contact_uncertainty,
                    "m, standard uncertainty of where the displacement begins.");
}

void define_site(py::module_& module) {
  py::class_<SiteCurves>(module, "SiteCurves", "All paths run at a response vertex.")
      .def_readonly("vertex", &SiteCurves::vertex, "Vertex of the response surface.")
      .def_property_readonly(
          "status", [](const SiteCurves& site) { return status_name(site.status); },
          "\"complete\", \"partial\" (a path stopped early) or \"failed\" (no usable sample).")
      .def_readonly("reason", &SiteCurves::reason, "Why it is not complete.")
      .def_readonly("cpu_seconds", &SiteCurves::cpu_seconds, "s.")
      .def_property_readonly(
          "paths",
          [](const py::object& self) {
            return references(self, self.cast<const SiteCurves&>().paths);
          },
          "A list of CurvePath.")
      .def_property_readonly("normal", &normal_path, "The normal CurvePath, or None.")
      .def_property_readonly("lateral", &lateral_paths, "A list of the lateral ones.");
  py::class_<ToolDescription>(module, "Tool", "The tool of a campaign.")
      .def_readonly("shape", &ToolDescription::shape, "\"sphere\", \"disc\" or \"cylinder\".")
      .def_readonly("radius", &ToolDescription::radius, "m.")
      .def_readonly("edge_radius", &ToolDescription::edge_radius, "m, of the edge of a disc.")
      .def_readonly("length", &ToolDescription::length,
                    "m, of a cylinder, between the centres of its ends.")
      .def_readonly("friction", &ToolDescription::friction,
                    "Of the normal path: \"frictionless\" or \"no-slip\".");
}

}  // namespace

void define_curves(py::module_& module) {
  define_path(module);
  define_site(module);
  py::class_<Curves>(module, "Curves",
                     "Raw force-deflection curves, curves.h5; made by read_curves.")
      .def_readonly("tool", &Curves::tool, "The Tool.")
      .def_readonly("depth", &Curves::depth, "m, requested end of the normal paths.")
      .def_readonly("lateral_travel", &Curves::lateral_travel,
                    "m, requested end of the lateral paths.")
      .def_readonly("body_sha256", &Curves::body_sha256,
                    "Of the body.h5 that the vertices refer to.")
      .def_property_readonly("relaxation_times", &relaxation_times,
                             "(B,) s; empty where the tissue is elastic.")
      .def_property_readonly("relaxation_fractions", &fractions,
                             "(R, B): fractions of each region.")
      .def_property_readonly(
          "sites",
          [](const py::object& self) { return references(self, self.cast<const Curves&>().sites); },
          "A list of SiteCurves, in ascending order of their vertices.")
      .def("site", &site_of, py::arg("vertex"),
           "site(vertex) -> SiteCurves\n\nRaises ArgumentError where the vertex is no site.")
      .def_property_readonly(
          "provenance",
          [](const py::object& self) {
            return references(self, self.cast<const Curves&>().provenance.steps);
          },
          kProvenanceText)
      .def("__repr__", &curves_text);
  module.def("read_curves", &curves_of, py::arg("path"),
             "read_curves(path) -> Curves\n\nReads and checks curves.h5. Raises FileError or "
             "FormatError.");
}

}  // namespace palpate::python
