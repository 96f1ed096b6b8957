// SPDX-License-Identifier: AGPL-3.0-or-later
// Forces that an embedding program receives through the C interface.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "format/vec3.hpp"

struct palpate_deformation;
struct palpate_library;

namespace palpate::fidelity {

class RenderedBody;

/// A deformation file, loaded through the public C interface for one body, which must outlive it.
class RenderedSkin {
 public:
  /// @throws Error(Configuration) when the runtime refuses the file.
  RenderedSkin(const RenderedBody& body, const std::filesystem::path& deformation);

  const std::vector<Vec3>& at_rest() const { return at_rest_; }  ///< m

 private:
  friend class RenderedBody;
  struct Unload {
    void operator()(palpate_deformation* deformation) const;
  };
  std::unique_ptr<palpate_deformation, Unload> deformation_;
  std::vector<Vec3> at_rest_;
};

/// A library file, loaded and pressed through the public C interface.
class RenderedBody {
 public:
  /// @throws Error(Configuration) when the runtime refuses the file.
  explicit RenderedBody(const std::filesystem::path& library);

  /// Deflection of the tip from the contact point, in the frame of the contact.
  struct Deflection {
    double depth = 0;    ///< m along n
    double lateral = 0;  ///< m along the tangent, >= 0
    Vec3 tangent{};      ///< unit, normal to n
  };

  /// The tip enters at `contact` along `inward`, sticks there (unlimited friction) and moves to
  /// each deflection in order. @return forces on the body, N. @throws Error(Internal) when the
  /// runtime chooses another contact point or direction, so that the forces are not comparable.
  std::vector<Vec3> press(const Vec3& contact, const Vec3& inward,
                          const std::vector<Deflection>& deflections) const;

  /// The tip follows a travel along `inward` over time, linear between the times, in steps of a
  /// millisecond or less. Before the first positive travel it is out of contact.
  /// @param time    s, strictly increasing. @param travel  m, from the contact point.
  /// @return force on the body along `inward` at each time, N. @throws as press().
  std::vector<double> follow(const Vec3& contact, const Vec3& inward,
                             const std::vector<double>& time,
                             const std::vector<double>& travel) const;

  /// The same path, with the skin of a deformation file. @return the displacement of each vertex of
  /// the skin from its position at rest, m, at each deflection.
  std::vector<std::vector<Vec3>> displace(const RenderedSkin& skin, const Vec3& contact,
                                          const Vec3& inward,
                                          const std::vector<Deflection>& deflections) const;

 private:
  friend class RenderedSkin;
  struct Unload {
    void operator()(palpate_library* library) const;
  };
  std::unique_ptr<palpate_library, Unload> library_;
};

}  // namespace palpate::fidelity
