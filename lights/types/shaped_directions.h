// Angular shaping of a surface's emission, in render space: the factor of its radiance, and directions of photons.
//
// Shaping is defined over the light's local directions; the transform of the call carries them to render space, shear
// and mirroring included (direction_map.h). A two-sided surface is shaped by the angle from -z alone, as UsdLux has it:
// a cone of less than 90° darkens the far side of a flat light.
#pragma once

#include <memory>

#include "lights/direction_map.h"
#include "lights/light.h"
#include "lights/types/shaping.h"

namespace lampyr {

class ShapedDirections {
 public:
  // `axes` leads from the space whose -z is the primary axis to the space that the light's transform starts from;
  // `built` is the transform that it will mostly have.
  // `isBackDark`: a cone of at most 90° is in force.
  ShapedDirections(std::shared_ptr<const Shaping> shaping, Shaping::Emitter emitter, bool twoSided, bool isBackDark,
                   const LightTransform& axes, const LightTransform& built);

  // Of the radiance that leaves in the unit direction `outgoing`, in render space.
  Color Factor(const LightTransform& transform, const Vector3& outgoing) const;
  float Largest() const { return shaping_->Largest(); }

  // Whether photons' directions are sampled by this; by the cosine law otherwise.
  bool GuidesEmission() const { return guides_; }
  // Unit; may be on a side that does not emit.
  Vector3 Sample(const LightTransform& transform, const Normal3& normal, const Point2& u) const;
  // What leaves in the unit direction `outgoing`: the factor, and where this guides photons their density, 0 where the
  // factor is black.
  struct Leaving {
    Color factor;
    PdfSolidAngle density;
  };
  Leaving Look(const LightTransform& transform, const Normal3& normal, const Vector3& outgoing) const;

  // Whether nothing is emitted towards +z, whatever the surface's sides are.
  bool IsBackDark() const { return isBackDark_; }
  const Shaping& Parts() const { return *shaping_; }
  // Whether directions keep their angles on the way to render space.
  bool KeepsAngles(const LightTransform& transform) const;

 private:
  // From the space whose -z is the primary axis to render space; `scratch` is where it may be made.
  struct Axes {
    const LightTransform& map;
    float scale;  // of lengths, where it is known that angles are kept; 0: it is not known

    Vector3 ToLocal(const Vector3& direction) const {
      return scale > 0 ? map.toLocal.Vector(direction) * scale : ToLocalDirection(map, direction);
    }
  };
  Axes AxesUnder(const LightTransform& transform, LightTransform& scratch) const;

  std::shared_ptr<const Shaping> shaping_;
  bool guides_;
  bool isBackDark_;
  float frontShare_ = 1;  // of the photons; the rest leaves a flat light at its back by the cosine law
  bool hasAxes_;
  LightTransform axes_, built_, builtAxes_;
  float builtScale_ = 0;
};

}  // namespace lampyr
