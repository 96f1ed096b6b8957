// SPDX-License-Identifier: AGPL-3.0-or-later
// A law of any type behind one interface: eight elements at once.
#pragma once

#include <memory>

#include "fem/laws/holzapfel_gasser_ogden.hpp"
#include "fem/laws/material.hpp"

namespace palpate::fem {

template <class L>
concept Anisotropic = requires(const L& law) {
  law.fibres();
};

/// One of the laws of this folder, whose class has the formulas. Cheap to copy: copies share the
/// constants, which never change. Every method may be called from several threads.
class Law {
 public:
  template <class L>
  requires(!std::same_as<std::remove_cvref_t<L>, Law>)
      Law(L law)  // NOLINT(google-explicit-constructor): every law is a Law
      : kernel_(std::make_shared<Holder<L>>(std::move(law))) {}

  /// Isochoric energy density, J/m^3, its derivative by F and the addition of its second one, Pa.
  Lanes psi(const Tensor2<Lanes>& F, const Lanes& J, const Fibres<Lanes>& a) const {
    return kernel_->psi(F, J, a);
  }
  Tensor2<Lanes> piola(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                       const Fibres<Lanes>& a) const {
    return kernel_->piola(F, cof, J, a);
  }
  void add_tangent(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                   const Fibres<Lanes>& a, Tensor4<Lanes>& A) const {
    kernel_->add_tangent(F, cof, J, a, A);
  }

  /// U, dU/dJ and d2U/dJ2.
  Lanes volumetric_energy(const Lanes& J) const { return kernel_->volumetric_energy(J); }
  Lanes pressure(const Lanes& J) const { return kernel_->pressure(J); }
  Lanes pressure_slope(const Lanes& J) const { return kernel_->pressure_slope(J); }

  /// Whether the constants make the energy polyconvex, so that it is elliptic in every state.
  bool polyconvex() const { return kernel_->polyconvex(); }

  /// Directions of the fibres at X; zero for a law without.
  std::array<Vec3, 2> fibres_at(const Vec3& X) const { return kernel_->fibres_at(X); }

 private:
  struct Kernel {
    virtual ~Kernel() = default;
    virtual Lanes psi(const Tensor2<Lanes>&, const Lanes&, const Fibres<Lanes>&) const = 0;
    virtual Tensor2<Lanes> piola(const Tensor2<Lanes>&, const Tensor2<Lanes>&, const Lanes&,
                                 const Fibres<Lanes>&) const = 0;
    virtual void add_tangent(const Tensor2<Lanes>&, const Tensor2<Lanes>&, const Lanes&,
                             const Fibres<Lanes>&, Tensor4<Lanes>&) const = 0;
    virtual Lanes volumetric_energy(const Lanes&) const = 0;
    virtual Lanes pressure(const Lanes&) const = 0;
    virtual Lanes pressure_slope(const Lanes&) const = 0;
    virtual bool polyconvex() const = 0;
    virtual std::array<Vec3, 2> fibres_at(const Vec3&) const = 0;
  };

  template <class L>
  struct Holder final : Kernel {
    explicit Holder(L l) : law(std::move(l)) {}
    Lanes psi(const Tensor2<Lanes>& F, const Lanes& J, const Fibres<Lanes>& a) const override {
      if constexpr (Anisotropic<L>)
        return law.psi(F, J, a);
      else
        return law.psi(F, J);
    }
    Tensor2<Lanes> piola(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                         const Fibres<Lanes>& a) const override {
      if constexpr (Anisotropic<L>)
        return law.piola(F, cof, J, a);
      else
        return law.piola(F, cof, J);
    }
    void add_tangent(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                     const Fibres<Lanes>& a, Tensor4<Lanes>& A) const override {
      if constexpr (Anisotropic<L>)
        law.add_tangent(F, cof, J, a, A);
      else
        law.add_tangent(F, cof, J, A);
    }
    Lanes volumetric_energy(const Lanes& J) const override { return law.volumetric_energy(J); }
    Lanes pressure(const Lanes& J) const override { return law.pressure(J); }
    Lanes pressure_slope(const Lanes& J) const override { return law.pressure_slope(J); }
    bool polyconvex() const override { return law.polyconvex(); }
    std::array<Vec3, 2> fibres_at(const Vec3& X) const override {
      if constexpr (Anisotropic<L>)
        return law.fibres().at(X);
      else
        return {};
    }
    L law;
  };

  std::shared_ptr<const Kernel> kernel_;
};

}  // namespace palpate::fem
