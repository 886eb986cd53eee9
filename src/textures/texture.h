// Textures: values that vary over a surface. A parameter of a material is either a constant or a texture; constants
// cost nothing (FloatParameter, ColorParameter).
#pragma once

#include <memory>

#include "math/vec.h"
#include "spectral/wavelengths.h"

namespace lampyr {

// The point at which a texture is evaluated. `position` and the geometric `normal` are in render space; textures that
// depend on them hold their own transform.
struct TextureContext {
  Point2 uv{0.0f};
  Point3 position{0.0f};
  Normal3 normal{0.0f};  // unit, on either side
};

template <class Value>
class Texture {
 public:
  virtual ~Texture() = default;
  virtual Value Evaluate(const TextureContext& where) const = 0;
  // The texture times a factor, if that differs from its values times the factor: values of images are scaled before
  // they are clamped. Null: it does not differ.
  virtual std::shared_ptr<const Texture> Scaled(float /*factor*/) const { return nullptr; }
};
using FloatTexture = Texture<float>;
using ColorTexture = Texture<Color>;

// A constant or a texture.
template <class Value>
class ParameterOf {
 public:
  ParameterOf(Value constant = Value{}) : constant_(constant) {}
  explicit ParameterOf(std::shared_ptr<const Texture<Value>> texture) : texture_(std::move(texture)) {}

  bool IsConstant() const { return !texture_; }
  Value Evaluate(const TextureContext& where) const { return texture_ ? texture_->Evaluate(where) : constant_; }
  // Texture::Scaled; null for a constant, too.
  std::shared_ptr<const Texture<Value>> Scaled(float factor) const {
    return texture_ ? texture_->Scaled(factor) : nullptr;
  }

 private:
  Value constant_{};
  std::shared_ptr<const Texture<Value>> texture_;
};

// A colour parameter. A constant may have a curve, which replaces it in transport by wavelength. Textures are colours
// in Rec. 709, upsampled to the wavelengths of the pass when they are evaluated.
template <>
class ParameterOf<Color> {
 public:
  ParameterOf(Color constant = Color{}) : constant_(constant) {}
  ParameterOf(const Color& constant, std::shared_ptr<const SpectralCurve> curve)
      : constant_(constant), curve_(std::move(curve)) {}
  explicit ParameterOf(std::shared_ptr<const Texture<Color>> texture) : texture_(std::move(texture)) {}

  bool IsConstant() const { return !texture_; }
  const std::shared_ptr<const SpectralCurve>& Curve() const { return curve_; }  // null: none
  Color Evaluate(const TextureContext& where) const {
    if (!texture_) return constant_;
    const Color color = texture_->Evaluate(where);
    return wavelengths_ ? wavelengths_->FromRgb(color) : color;
  }
  // Texture::Scaled; null for a constant, too.
  std::shared_ptr<const Texture<Color>> Scaled(float factor) const {
    return texture_ ? texture_->Scaled(factor) : nullptr;
  }
  // The parameter at the wavelengths of a pass.
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) {
    if (texture_) {
      wavelengths_ = wavelengths;
    } else {
      constant_ = curve_ ? wavelengths->At(*curve_) : wavelengths->FromRgb(constant_);
    }
  }

 private:
  Color constant_{};
  std::shared_ptr<const SpectralCurve> curve_;
  std::shared_ptr<const Texture<Color>> texture_;
  std::shared_ptr<const Wavelengths> wavelengths_;
};

using FloatParameter = ParameterOf<float>;
using ColorParameter = ParameterOf<Color>;

}  // namespace lampyr
