// Where a texture is looked up: from the surface to the texture's own coordinates, with pbrt-v4's meanings
// ([Pharr23 §10.3]): uv, spherical (s = θ/π, t = φ/2π), cylindrical (s = (π+φ)/2π, t = z), planar, and the 3-D mapping by
// the texture's transform. Passed by value and without virtual calls.
#pragma once

#include "math/transform.h"
#include "textures/texture.h"

namespace lampyr {

struct TextureMapping2D {
  enum class Kind { Uv, Spherical, Cylindrical, Planar };
  Kind kind = Kind::Uv;
  Vector2 scale{1.0f}, delta{0.0f};  // uv: scale and delta; planar: delta
  Affine renderToTexture;            // all but uv
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
