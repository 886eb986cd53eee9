// Texture mappings: from a surface point to texture coordinates, as in pbrt-v4 ([Pharr23 §10.3]). Passed by value,
// without virtual calls.
// - 2-D: uv; spherical, s = θ/π, t = φ/2π; cylindrical, s = (π+φ)/2π, t = z; planar.
// - 3-D: by the transform of the texture.
#pragma once

#include "math/transform.h"
#include "textures/texture.h"

namespace lampyr {

struct TextureMapping2D {
  enum class Kind { Uv, Spherical, Cylindrical, Planar };
  Kind kind = Kind::Uv;
  Vector2 scale{1.0f}, delta{0.0f};        // uv: scale and delta; planar: delta
  Affine renderToTexture;                  // all kinds except uv
  Vector3 axisS{1, 0, 0}, axisT{0, 1, 0};  // planar

  Point2 Map(const TextureContext& where) const {
    if (kind == Kind::Uv) return where.uv * scale + delta;
    return MapPosition(renderToTexture.Point(where.position));
  }

 private:
  Point2 MapPosition(const Point3& p) const;
};

struct TextureMapping3D {
  Affine renderToTexture;
  Point3 Map(const TextureContext& where) const { return renderToTexture.Point(where.position); }
};

}  // namespace lampyr
