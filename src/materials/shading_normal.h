// Normal and bump maps: a shading normal other than that of the surface.
//
// Normal map: RGB in tangent space, linear encoding, n = 2·rgb - 1, x along dpdu, z along Ns; v = 0 is the bottom row;
// the image repeats and is interpolated bilinearly ([Pharr23 §10.5.3]).
//
// Displacement: a height d above the surface, in scene units, by finite differences of the texture along dpdu and dpdv
// ([Blinn78]; the derivatives of Ns are neglected).
//
// The result is on the side of Ng, as Ns is.
#pragma once

#include <optional>

#include "geometry/ray.h"
#include "math/frame.h"
#include "textures/texel_lookup.h"
#include "textures/texture.h"

namespace lampyr {

class Diagnostics;
class ParameterList;
class TextureLibrary;

class ShadingNormal {
 public:
  ShadingNormal() = default;
  // Reads "normalmap" and "displacement"; the first takes precedence, with a warning. Throws an Error if the image
  // cannot be read.
  ShadingNormal(const ParameterList& parameters, const TextureLibrary& textures, Diagnostics& diagnostics);

  bool IsPlain() const { return !normalMap_ && !displacement_; }
  // Shading frame at a point; x along dpdu. Requires !IsPlain().
  Frame GetFrame(const SurfacePoint& point) const;

 private:
  Frame FromNormalMap(const SurfacePoint& point) const;
  Frame FromDisplacement(const SurfacePoint& point) const;

  std::optional<TexelLookup> normalMap_;
  std::optional<FloatParameter> displacement_;
};

}  // namespace lampyr
