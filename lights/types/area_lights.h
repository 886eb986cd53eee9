// The shapes that an AreaLightSource can be put on, one maker each, and the dispatch over them.
#pragma once

#include <memory>

#include "lights/light_base.h"
#include "lights/types/surface_emission.h"

namespace lampyr {

// The light on the shape of `build`. Throws a located Error without a shape, or if it cannot emit.
std::unique_ptr<Light> MakeShapeLight(LightTypeFunction type, const ParameterList& parameters,
                                      const LightBuildContext& build, const EmissionReader& readEmission);

std::unique_ptr<Light> MakeMeshLight(LightTypeFunction type, const ParameterList& parameters,
                                     const LightBuildContext& build, const EmissionReader& readEmission,
                                     std::shared_ptr<const TriangleMesh> mesh);
std::unique_ptr<Light> MakeBilinearLight(LightTypeFunction type, const ParameterList& parameters,
                                         const LightBuildContext& build, const EmissionReader& readEmission,
                                         std::shared_ptr<const BilinearMesh> mesh);
std::unique_ptr<Light> MakeQuadricLight(LightTypeFunction type, const ParameterList& parameters,
                                        const LightBuildContext& build, const EmissionReader& readEmission,
                                        const Quadric& quadric);

inline bool IsIdentity(const Affine& map) {
  return map.linear == glm::mat3(1.0f) && map.translation == Vector3(0.0f);
}

// dA_render / dA_local of a surface whose unit normal in render space is `normal`: |det M| / |Mᵀ n|. It may leave the
// range of float where lengths do not.
inline double ExactAreaStretch(const Affine& toRender, const Normal3& normal) {
  const float scale = std::max(MaxAbsComponent(toRender.linear[0]),
                               std::max(MaxAbsComponent(toRender.linear[1]), MaxAbsComponent(toRender.linear[2])));
  const glm::mat3 m = toRender.linear * (1 / scale);
  return static_cast<double>(scale) * static_cast<double>(scale) * static_cast<double>(std::abs(glm::determinant(m))) /
         static_cast<double>(glm::length(normal * m));
}
inline float AreaStretch(const Affine& toRender, const Normal3& normal) {
  return static_cast<float>(ExactAreaStretch(toRender, normal));
}

}  // namespace lampyr
