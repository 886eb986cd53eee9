// The shapes that AreaLightSource "diffuse" can be put on, one maker each. For diffuse.cpp.
#pragma once

#include <memory>

#include "lights/light_base.h"

namespace lampyr {

std::unique_ptr<Light> MakeMeshLight(LightTypeFunction type, const ParameterList& parameters,
                                     const LightBuildContext& build, std::shared_ptr<const TriangleMesh> mesh);
std::unique_ptr<Light> MakeBilinearLight(LightTypeFunction type, const ParameterList& parameters,
                                         const LightBuildContext& build, std::shared_ptr<const BilinearMesh> mesh);
std::unique_ptr<Light> MakeQuadricLight(LightTypeFunction type, const ParameterList& parameters,
                                        const LightBuildContext& build, const Quadric& quadric);

// Whether a light's placement is the one it was built with, so that what was computed then holds.
inline bool SamePlacement(const LightTransform& a, const LightTransform& b) {
  return a.toRender.linear == b.toRender.linear && a.toRender.translation == b.toRender.translation;
}
inline bool IsIdentity(const Affine& map) {
  return map.linear == glm::mat3(1.0f) && map.translation == Vector3(0.0f);
}

// dA_render / dA_local of a surface whose unit normal in render space is `normal`: |det M| / |Mᵀ n|.
inline float AreaStretch(const Affine& toRender, const Normal3& normal) {
  const float scale = std::max(MaxAbsComponent(toRender.linear[0]),
                               std::max(MaxAbsComponent(toRender.linear[1]), MaxAbsComponent(toRender.linear[2])));
  const glm::mat3 m = toRender.linear * (1 / scale);
  return scale * scale * std::abs(glm::determinant(m)) / glm::length(normal * m);
}

}  // namespace lampyr
