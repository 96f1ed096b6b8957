// SPDX-License-Identifier: AGPL-3.0-or-later
// The body as the solver of one site sees it.
#pragma once

#include <optional>
#include <vector>

#include "fem/campaign/contact_size.hpp"
#include "fem/contact/tool.hpp"
#include "fem/solid/prolongation.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// Radius of the window around a site, m: the part of the body where the strains are large.
double window_radius(const ToolGeometry& tool);

/// The window around a site: its nodes are free, all others fixed.
SolidModel window_at(const SolidModel& body, const Eigen::Vector3d& site, const ToolGeometry& tool);

/// Which models a site has.
enum class SiteMesh {
  WholeBody,     ///< the body alone
  Window,        ///< the body and a window, on the mesh of the body
  RefinedWindow  ///< the same with the elements around the tool divided into eight, several times
};

/// How the elements around a site are divided, each by as often as its distance from the site asks
/// for. By a number of levels: first the elements under the tool, then always those children that
/// are within half the distance. By the contact: while their size is above
///   h(s) = h_a max(a, min(s, b/2)) + h_b max(0, s - b),
/// s the distance from the line where the contact begins, a and b those of its edge at the first
/// and the last increment. A contact whose edge is anywhere up to b/2 then has elements of h_a s
/// there and smaller ones inside, and each doubling of s costs as many elements as the one before.
/// Contacts beyond b/2 have elements of h_a b/2 at their edges: outside of those that the last edge
/// meets, elements may be those of the body. With both, or with several lines, an element is
/// divided that any of them asks for.
struct SiteRefinement {
  int levels = 1;                    ///< 0: by the contact alone
  int first_levels = 1;              ///< of `levels`: that divide all under the tool
  std::vector<ContactCore> cores{};  ///< empty: by `levels` alone
  double size_over_distance = 0.5;   ///< h_a
  double growth_outside = 0.5;       ///< h_b
};

/// The body and the window around the tool. The factor of the campaign serves a refined mesh too:
/// every new node lies inside the window, which each site solves by itself. Immutable after
/// construction.
class SiteBody {
 public:
  /// `body` must outlive this. `rest`: the displacement of the body before the touch.
  SiteBody(const SolidModel& body, const Displacement& rest, const Eigen::Vector3d& site,
           const ToolGeometry& tool, SiteMesh mesh, const SiteRefinement& refinement = {});

  const SolidModel& whole() const { return refined_ ? *refined_ : *whole_; }
  const QuadraticMesh& mesh() const { return whole().mesh(); }
  /// There is none with SiteMesh::WholeBody.
  const SolidModel& window() const { return *window_; }
  /// Null where no element is refined.
  const Prolongation* prolongation() const { return prolongation_ ? &*prolongation_ : nullptr; }
  /// The displacement before the touch, on the nodes of mesh().
  const Displacement& rest() const { return rest_; }
  double bytes() const;  ///< without what the sites of a campaign share

 private:
  void refine(const Eigen::Vector3d& site, const ToolGeometry& tool,
              const SiteRefinement& refinement);

  const SolidModel* whole_;
  std::optional<SolidModel> refined_, window_;
  std::optional<Prolongation> prolongation_;
  Displacement rest_;
};

}  // namespace palpate::fem
