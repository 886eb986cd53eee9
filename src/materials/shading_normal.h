// Normal and bump maps: a shading normal other than the surface's own.
//
// Normal map: RGB in tangent space, linear encoding, n = 2·rgb - 1, x along dpdu, z along Ns; v = 0 at the bottom row,
// the image repeats, bilinear ([Pharr23 §10.5.3]). Displacement: a height d over the surface, in scene units, by finite
// differences of the texture along dpdu and dpdv
// ([Blinn78]; the derivatives of Ns are left out).
// The result is on Ng's side, as Ns is.
#pragma once

#include <memory>
#include <optional>

#include "film/image.h"
#include "geometry/ray.h"
#include "math/frame.h"
#include "textures/texture.h"

namespace lampyr {

class Diagnostics;
class ParameterList;
class TextureLibrary;

class ShadingNormal {
 public:
  ShadingNormal() = default;
  // Reads "normalmap" and "displacement"; the first wins, with a warning. Throws when the image cannot be read.
  ShadingNormal(const ParameterList& parameters, const TextureLibrary& textures, Diagnostics& diagnostics);

  bool IsPlain() const { return !normalMap_ && !displacement_; }
  // Shading frame at a point; x along dpdu. Only for !IsPlain().
  Frame GetFrame(const SurfacePoint& point) const;

 private:
  Frame FromNormalMap(const SurfacePoint& point) const;
  Frame FromDisplacement(const SurfacePoint& point) const;

  std::shared_ptr<const Image> normalMap_;
  std::optional<FloatParameter> displacement_;
};

}  // namespace lampyr
