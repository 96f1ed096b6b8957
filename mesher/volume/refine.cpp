// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/refine.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>

#include <atomic>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/volume/samples.hpp"

namespace palpate::mesher {
namespace {

/// Questions that may still be asked. At acute edges refinement may go on for ever without a new
/// node: a count, unlike a clock, ends it at the same question on every machine.
class Budget {
 public:
  explicit Budget(std::size_t questions) : left_(questions) {}
  void spend() const {
    if (left_ == 0) {
      stop_ = true;
    } else {
      --left_;
    }
  }
  bool is_spent() const { return stop_; }
  std::atomic<bool>* stop() const { return &stop_; }

 private:
  mutable std::size_t left_;
  mutable std::atomic<bool> stop_ = false;
};

constexpr std::size_t kQuestionsPerNode = 200;  // three times what ordinary bodies take

/// The Oracle in the terms of CGAL (concept MeshDomain_3). CGAL numbers sub-domains from 1 and
/// keeps 0 for the outside: region + 1.
class OracleDomain {
 public:
  using R = Kernel;
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Segment_3 = Kernel::Segment_3;
  using Ray_3 = Kernel::Ray_3;
  using Line_3 = Kernel::Line_3;
  using Vector_3 = Kernel::Vector_3;
  using Sphere_3 = Kernel::Sphere_3;
  using Has_features = CGAL::Tag_false;
  using Subdomain_index = int;
  using Surface_patch_index = std::pair<int, int>;
  using Index = boost::variant<Subdomain_index, Surface_patch_index>;
  using Subdomain = boost::optional<Subdomain_index>;
  using Surface_patch = boost::optional<Surface_patch_index>;
  using Intersection = std::tuple<Point_3, Index, int>;

  OracleDomain(const Oracle& oracle, const SizeField& seed_spacing, const Budget& budget)
      : oracle_(oracle), seed_spacing_(seed_spacing), budget_(budget) {
    const Bounds box = oracle.box();
    const Vec3 margin = 0.1 * (box.high - box.low);
    const Vec3 low = box.low - margin, high = box.high + margin;
    box_ = CGAL::Bbox_3(low[0], low[1], low[2], high[0], high[1], high[2]);
  }

  struct InitialPoints {
    const OracleDomain& domain;
    template <typename Out>
    Out operator()(Out out, int = 0) const {
      for (const Crossing& seed : domain.oracle_.seeds(domain.seed_spacing_)) {
        *out++ = std::make_pair(to_point(seed.point), Index(patch(seed)));
      }
      // With these, the triangulation reaches beyond the domain: CGAL 5.5 fails where a new node
      // lies outside the convex hull of the others, as at the edges of a box.
      for (const Vec3& far : domain.far_points()) {
        *out++ = std::make_pair(to_point(far), Index(Surface_patch_index{0, 0}));
      }
      return out;
    }
  };
  struct IsInSubdomain {
    const OracleDomain& domain;
    Subdomain operator()(const Point_3& point) const {
      domain.budget_.spend();
      const std::int32_t region = domain.oracle_.region(to_vec3(point));
      return region == kVoid ? Subdomain() : Subdomain(region + 1);
    }
  };
  struct Intersect {
    const OracleDomain& domain;
    Intersection operator()(const Segment_3& s) const { return along(s.source(), s.target()); }
    Intersection operator()(const Ray_3& ray) const { return clipped(ray); }
    Intersection operator()(const Line_3& line) const { return clipped(line); }

   private:
    template <typename Query>
    Intersection clipped(const Query& query) const {
      const auto cut = CGAL::intersection(query, Kernel::Iso_cuboid_3(domain.box_));
      const Segment_3* inside = cut ? boost::get<Segment_3>(&*cut) : nullptr;
      return inside == nullptr ? Intersection() : (*this)(*inside);
    }
    Intersection along(const Point_3& from, const Point_3& to) const {
      domain.budget_.spend();
      const auto crossing = domain.oracle_.crossing(to_vec3(from), to_vec3(to));
      return crossing ? Intersection(to_point(crossing->point), Index(patch(*crossing)), 2)
                      : Intersection();
    }
  };

  // The names that CGAL asks a domain for [CGAL 5.5, concept MeshDomain_3].
  using Construct_initial_points = InitialPoints;
  using Is_in_subdomain = IsInSubdomain;
  using Construct_intersection = Intersect;
  Construct_initial_points construct_initial_points_object() const { return {*this}; }
  Is_in_subdomain is_in_domain_object() const { return {*this}; }
  Construct_intersection construct_intersection_object() const { return {*this}; }

  Index index_from_surface_patch_index(const Surface_patch_index& i) const { return Index(i); }
  Index index_from_subdomain_index(const Subdomain_index& i) const { return Index(i); }
  Surface_patch_index surface_patch_index(const Index& i) const {
    return boost::get<Surface_patch_index>(i);
  }
  Subdomain_index subdomain_index(const Index& i) const { return boost::get<Subdomain_index>(i); }
  CGAL::Bbox_3 bbox() const { return box_; }

 private:
  /// Corners and middles of the faces of a box around the domain, three times as large, a little
  /// irregular so that no five lie on a sphere.
  std::vector<Vec3> far_points() const {
    const Bounds box = oracle_.box();
    const Vec3 middle = 0.5 * (box.low + box.high);
    const double reach = 1.5 * norm(box.high - box.low);
    std::vector<Vec3> points;
    for (int n = 0; n < 27; ++n) {
      const Vec3 direction = towards_neighbour(n);
      const double length = norm(direction);
      if (length == 0 || (length > 1.2 && length < 1.6)) continue;  // the middle, and edges
      points.push_back(middle + (reach * (1 + 0.01 * std::sin(n)) / length) * direction);
    }
    return points;
  }

  static Surface_patch_index patch(const Crossing& crossing) {
    return {crossing.low + 1, crossing.high + 1};
  }

  const Oracle& oracle_;
  const SizeField& seed_spacing_;
  const Budget& budget_;
  CGAL::Bbox_3 box_;
};

/// A size by place, for CGAL (concept MeshDomainField_3).
struct Size {
  using FT = OracleDomain::FT;
  using Point_3 = OracleDomain::Point_3;
  using Index = OracleDomain::Index;

  const SizeField* size;
  const Budget* budget;
  double factor = 1;

  FT operator()(const Point_3& point, int /*dimension*/, const Index& /*index*/) const {
    budget->spend();
    return factor * (*size)(to_vec3(point));
  }
};

using Triangulation = CGAL::Mesh_triangulation_3<OracleDomain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

Criteria criteria_of(const RefineSettings& settings, const Budget& budget) {
  namespace p = CGAL::parameters;
  return Criteria(p::facet_angle = settings.smallest_facet_angle,
                  p::facet_size = Size{&settings.facet_size, &budget},
                  p::facet_distance = Size{&settings.facet_size, &budget, settings.facet_distance},
                  p::cell_radius_edge_ratio = settings.radius_edge_ratio,
                  p::cell_size = Size{&settings.cell_size, &budget});
}

/// Moves nodes by gradients and, where that does not help, a few times at random (with a seed of
/// CGAL's own). Random moves cost most of the time: exudation removes what they would.
void perturb(Complex& complex, const OracleDomain& domain, double smallest_dihedral) {
  namespace p = CGAL::parameters;
  using Criterion = CGAL::Mesh_3::Min_dihedral_angle_criterion<Triangulation>;
  using Perturber = CGAL::Mesh_3::Sliver_perturber<Complex, OracleDomain, Criterion>;
  // The perturber owns them.
  const std::vector<Perturber::Perturbation*> moves = {
      new CGAL::Mesh_3::Sq_radius_perturbation<Complex, OracleDomain, Criterion>(40, 0.05),
      new CGAL::Mesh_3::Dihedral_angle_perturbation<Complex, OracleDomain, Criterion>(40, 0.05),
      new CGAL::Mesh_3::Li_random_perturbation<Complex, OracleDomain, Criterion>(10, 0.15)};
  // A limit of time would make the result depend on the machine.
  CGAL::perturb_mesh_3(complex, domain, p::time_limit = 0,
                       p::sliver_criterion = Criterion(smallest_dihedral, complex.triangulation()),
                       p::perturbation_vector = moves);
}

VolumeMesh mesh_of(const Complex& complex) {
  VolumeMesh mesh;
  std::unordered_map<const void*, std::int32_t> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    Tetrahedron corners{};
    for (int k = 0; k < 4; ++k) {
      const auto vertex = cell->vertex(k);
      const auto [entry, is_new] =
          number.emplace(&*vertex, static_cast<std::int32_t>(mesh.nodes.size()));
      if (is_new) mesh.nodes.push_back(to_vec3(vertex->point().point()));
      corners[static_cast<std::size_t>(k)] = entry->second;
    }
    mesh.tetrahedra.push_back(corners);
    mesh.region.push_back(complex.subdomain_index(cell) - 1);
  }
  return mesh;
}

}  // namespace

namespace {

/// CGAL prints warnings of its own, such as that a refinement cannot start: the mesh is checked
/// anyway.
class NoWarnings {
 public:
  NoWarnings() : before_(CGAL::set_warning_handler(ignore)) {}
  ~NoWarnings() { CGAL::set_warning_handler(before_); }
  NoWarnings(const NoWarnings&) = delete;
  NoWarnings& operator=(const NoWarnings&) = delete;

 private:
  static void ignore(const char*, const char*, const char*, int, const char*) {}
  CGAL::Failure_function before_;
};

Refinement run(const Oracle& oracle, const RefineSettings& settings) {
  namespace p = CGAL::parameters;
  const Budget budget(kQuestionsPerNode * settings.most_nodes);
  const OracleDomain domain(oracle, settings.seed_spacing, budget);
  const Criteria criteria = criteria_of(settings, budget);
  CGAL::Mesh_error_code code = CGAL::CGAL_MESH_3_NO_ERROR;
  const auto options = p::mesh_3_options(p::maximal_number_of_vertices = settings.most_nodes,
                                         p::pointer_to_error_code = &code,
                                         p::pointer_to_stop_atomic_boolean = budget.stop());
  // CGAL forbids an edge with more than two facets, which several regions need.
  const auto topology =
      settings.refine_until_manifold && oracle.has_one_region() ? p::manifold() : p::non_manifold();
  Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, p::no_perturb(), p::no_exude(),
                                               topology, options);
  Refinement result;
  result.cut_short = budget.is_spent() || code != CGAL::CGAL_MESH_3_NO_ERROR;
  if (settings.smallest_dihedral > 0 && !result.cut_short) {
    perturb(complex, domain, settings.smallest_dihedral);
    CGAL::exude_mesh_3(complex, p::time_limit = 0, p::sliver_bound = settings.smallest_dihedral);
  }
  result.mesh = mesh_of(complex);
  return result;
}

}  // namespace

Refinement refine(const Oracle& oracle, const RefineSettings& settings) {
  const NoWarnings quiet;
  try {
    return run(oracle, settings);
  } catch (const CGAL::Failure_exception& failure) {
    return {{}, true, failure.what()};
  }
}

}  // namespace palpate::mesher
