// The scattering models that a Bsdf may hold: small, trivially copyable values. Each works in its local frame (z is the
// shading normal, unit directions pointing away from the surface, none exactly in the plane z = 0) and has
//   Evaluate(wo, wi, mode), Sample(wo, uLobe, u, mode), IsDelta(), IsTransmissive()
// with the meaning of the same methods of Bsdf. PhaseBsdf, the model of a medium, accepts all directions, in any frame.
#pragma once

#include <type_traits>
#include <variant>

#include "materials/coated_conductor.h"
#include "materials/coated_diffuse.h"
#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/diffuse.h"
#include "materials/hair.h"
#include "materials/measured.h"
#include "materials/phase.h"
#include "materials/scattering.h"

namespace lampyr {

// Absorbs everything.
struct AbsorbingBsdf {
  BsdfEvaluation Evaluate(const Vector3&, const Vector3&, TransportMode) const { return {}; }
  BsdfSample Sample(const Vector3&, float, const Point2&, TransportMode) const { return {}; }
  bool IsDelta() const { return true; }
  bool IsTransmissive() const { return false; }
};

using BsdfModel =
    std::variant<AbsorbingBsdf, DiffuseBsdf, DiffuseTransmissionBsdf, ConductorBsdf, DielectricBsdf, DispersiveBsdf,
                 ThinDielectricBsdf, CoatedDiffuseBsdf, CoatedConductorBsdf, MeasuredBsdf, HairBsdf, PhaseBsdf>;
static_assert(std::is_trivially_copyable_v<BsdfModel> && sizeof(BsdfModel) <= 96);

// Models from here on may have other cosines than a surface's, and gather no photons of surfaces. They come last, so
// that one comparison identifies them.
inline constexpr size_t kFirstWithOwnCosines = 10;
static_assert(std::is_same_v<std::variant_alternative_t<kFirstWithOwnCosines, BsdfModel>, HairBsdf> &&
              std::is_same_v<std::variant_alternative_t<kFirstWithOwnCosines + 1, BsdfModel>, PhaseBsdf> &&
              std::variant_size_v<BsdfModel> == kFirstWithOwnCosines + 2);

}  // namespace lampyr
