// Angular shaping of a surface's emission in render space: the factor of its radiance, and sampling of photon
// directions.
//
// Shaping is defined over the light's local directions; the transform of the call maps them to render space, with shear
// and reflection (direction_map.h). A two-sided surface is shaped by the angle from -z alone, as in UsdLux: a cone of
// less than 90° darkens the far side of a flat light.
#pragma once

#include <memory>

#include "lights/direction_map.h"
#include "lights/light.h"
#include "lights/types/shaping.h"

namespace lampyr {

class ShapedDirections {
 public:
  // `axes`: from the space whose -z is the primary axis to the space that the light's transform maps from. `built`: the
  // usual transform of the light.
  // `isBackDark`: a cone of at most 90° is in force.
  ShapedDirections(std::shared_ptr<const Shaping> shaping, Shaping::Emitter emitter, bool twoSided, bool isBackDark,
                   const LightTransform& axes, const LightTransform& built);

  // Factor of the radiance in the unit direction `outgoing`, in render space.
  Color Factor(const LightTransform& transform, const Vector3& outgoing) const;
  float Largest() const { return shaping_->Largest(); }

  // True if photon directions are sampled by shaping; otherwise by the cosine.
  bool GuidesEmission() const { return guides_; }
  // Unit; may be on a side that does not emit.
  Vector3 Sample(const LightTransform& transform, const Normal3& normal, const Point2& u) const;
  // For the unit direction `outgoing`: the factor and, if shaping samples photons, their density; 0 if the factor is
  // black.
  struct Leaving {
    Color factor;
    PdfSolidAngle density;
  };
  Leaving Look(const LightTransform& transform, const Normal3& normal, const Vector3& outgoing) const;

  // -z of the shaping in render space, unit.
  Vector3 PrimaryAxis(const LightTransform& transform) const;
  // True if the axis is along the normal of a flat surface, in the space of the shaping. `normal`: unit, in render
  // space.
  bool IsAlong(const LightTransform& transform, const Normal3& normal) const;
  // True if nothing is emitted towards +z, even by a two-sided surface.
  bool IsBackDark() const { return isBackDark_; }
  const Shaping& Parts() const { return *shaping_; }
  // True if the map to render space preserves angles.
  bool KeepsAngles(const LightTransform& transform) const;

 private:
  // From the space whose -z is the primary axis to render space. `scratch`: storage for it.
  struct Axes {
    const LightTransform& map;
    float scale;  // of lengths, if the map is known to preserve angles; 0: unknown

    Vector3 ToLocal(const Vector3& direction) const {
      return scale > 0 ? map.toLocal.Vector(direction) * scale : ToLocalDirection(map, direction);
    }
  };
  Axes AxesUnder(const LightTransform& transform, LightTransform& scratch) const;

  std::shared_ptr<const Shaping> shaping_;
  bool guides_;
  bool isBackDark_;
  float frontShare_ = 1;  // fraction of photons; the others leave the back of a flat light by the cosine
  bool hasAxes_;
  LightTransform axes_, built_, builtAxes_;
  float builtScale_ = 0;
};

}  // namespace lampyr
