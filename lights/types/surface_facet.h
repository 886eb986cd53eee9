// Intersection of rays with the surfaces of lights that are their own geometry, in double and in the light's local
// space. The surfaces are those that quadric_surface.h and rect_surface.h sample.
#pragma once

#include "geometry/quadric.h"
#include "lights/types/quadric_surface.h"
#include "lights/types/rect_surface.h"
#include "lights/types/surface_light.h"

namespace lampyr {

class QuadricFacet final : public IntersectableLight {
 public:
  explicit QuadricFacet(const QuadricSurface& surface);
  std::vector<Point3> GetBounds() const override;
  std::optional<LocalHit> Intersect(const LocalRay& ray) const override;

 private:
  QuadricSurface surface_;
  PreparedQuadric prepared_;
};

class RectFacet final : public IntersectableLight {
 public:
  explicit RectFacet(const RectSurface& surface) : surface_(surface) {}
  std::vector<Point3> GetBounds() const override;
  std::optional<LocalHit> Intersect(const LocalRay& ray) const override;

 private:
  RectSurface surface_;
};

// LightSource "rect", "disk", "sphere", "cylinder": a surface that is the light itself.
template <class Geometry, class Facet>
class AnalyticLight final : public SurfaceLight<Geometry> {
 public:
  AnalyticLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
                Geometry surface, Shaping::Emitter emitter)
      : SurfaceLight<Geometry>(type, parameters, build, std::move(surface), Reader(emitter)),
        facet_(this->GetGeometry()) {}

  const IntersectableLight* Surface() const override { return &facet_; }

 private:
  static EmissionReader Reader(Shaping::Emitter emitter) {
    return
        [emitter](const ParameterList& parameters, const LightBuildContext& build, const SurfaceEmission::Area& area) {
          return SurfaceEmission::ReadUsdLux(parameters, build, area, emitter);
        };
  }

  Facet facet_;
};

// The parameter table of such a light: its own rows, then the sides, the texture, shaping and the rows of all lights.
std::vector<ParameterInfo> UsdLuxSurfaceParameters(std::vector<ParameterInfo> own);
// Parameter blocks for the suite, common to all such lights; each starts with `size`.
std::vector<std::string> UsdLuxSurfaceSamples(const std::string& size);

}  // namespace lampyr
