// Textures that combine others: scale, mix, directionmix.
#include "textures/texture_families.h"

namespace lampyr {

namespace {

// (1-t)·a + t·b; a texture of weight 0 is not evaluated.
template <class Value>
Value Blend(const ParameterOf<Value>& a, const ParameterOf<Value>& b, float t, const TextureContext& where) {
  if (t == 0) return a.Evaluate(where);
  if (t == 1) return b.Evaluate(where);
  return a.Evaluate(where) * (1 - t) + b.Evaluate(where) * t;
}

template <class Value>
class ScaleTexture : public Texture<Value> {
 public:
  ScaleTexture(ParameterOf<Value> texture, FloatParameter scale)
      : texture_(std::move(texture)), scale_(std::move(scale)) {}
  Value Evaluate(const TextureContext& where) const override {
    return texture_.Evaluate(where) * scale_.Evaluate(where);
  }

 private:
  ParameterOf<Value> texture_;
  FloatParameter scale_;
};

template <class Value>
class MixTexture : public Texture<Value> {
 public:
  MixTexture(ParameterOf<Value> first, ParameterOf<Value> second, FloatParameter amount)
      : first_(std::move(first)), second_(std::move(second)), amount_(std::move(amount)) {}
  Value Evaluate(const TextureContext& where) const override {
    return Blend(first_, second_, amount_.Evaluate(where), where);
  }

 private:
  ParameterOf<Value> first_, second_;
  FloatParameter amount_;
};

template <class Value>
ParameterOf<Value> Mixed(ParameterOf<Value> first, ParameterOf<Value> second, FloatParameter amount) {
  if (amount.IsConstant()) {
    const float t = amount.Evaluate({});
    if (t == 0) return first;
    if (t == 1) return second;
    if (first.IsConstant() && second.IsConstant()) return Blend(first, second, t, {});
  }
  return ParameterOf<Value>(
      std::make_shared<MixTexture<Value>>(std::move(first), std::move(second), std::move(amount)));
}

// Interpolates by |cosθ| between the surface normal and a direction: `along` where they are parallel, `across` where
// they are perpendicular.
template <class Value>
class DirectionMixTexture : public Texture<Value> {
 public:
  DirectionMixTexture(ParameterOf<Value> along, ParameterOf<Value> across, const Vector3& direction)
      : along_(std::move(along)), across_(std::move(across)), direction_(direction) {}
  Value Evaluate(const TextureContext& where) const override {
    return Blend(across_, along_, std::min(std::abs(glm::dot(where.normal, direction_)), 1.0f), where);
  }

 private:
  ParameterOf<Value> along_, across_;
  Vector3 direction_;
};

}  // namespace

template <class Value>
ParameterOf<Value> MakeScale(const TextureRequest& request) {
  ParameterOf<Value> texture = GetValue<Value>(request, "tex", 1);
  FloatParameter scale = request.library.GetFloat(request.Parameters(), "scale", 1);
  if (scale.IsConstant()) {
    const float factor = scale.Evaluate({});
    if (factor == 1) return texture;
    if (texture.IsConstant()) return texture.Evaluate({}) * factor;
    if (auto scaled = texture.Scaled(factor)) return ParameterOf<Value>(std::move(scaled));
  }
  if constexpr (std::is_same_v<Value, float>) {
    // The two parameters may be swapped, as in pbrt-v4.
    if (texture.IsConstant())
      if (auto scaled = scale.Scaled(texture.Evaluate({}))) return FloatParameter(std::move(scaled));
  }
  return ParameterOf<Value>(std::make_shared<ScaleTexture<Value>>(std::move(texture), std::move(scale)));
}

template <class Value>
ParameterOf<Value> MakeMix(const TextureRequest& request) {
  return Mixed<Value>(GetValue<Value>(request, "tex1", 0), GetValue<Value>(request, "tex2", 1),
                      request.library.GetFloat(request.Parameters(), "amount", 0.5f));
}

template <class Value>
ParameterOf<Value> MakeDirectionMix(const TextureRequest& request) {
  const Vector3 given(request.Parameters().GetVector3("dir", {0, 1, 0}));
  const Vector3 direction = request.renderToTexture.Inverse().Vector(given);
  if (!(LengthSquared(direction) > 0) || !(LengthSquared(direction) < kInfinity))
    throw Error(request.Parameters().WhereOf("dir"), "\"dir\" is no direction");
  ParameterOf<Value> along = GetValue<Value>(request, "tex1", 0), across = GetValue<Value>(request, "tex2", 1);
  return ParameterOf<Value>(
      std::make_shared<DirectionMixTexture<Value>>(std::move(along), std::move(across), glm::normalize(direction)));
}

template FloatParameter MakeScale<float>(const TextureRequest&);
template ColorParameter MakeScale<Color>(const TextureRequest&);
template FloatParameter MakeMix<float>(const TextureRequest&);
template ColorParameter MakeMix<Color>(const TextureRequest&);
template FloatParameter MakeDirectionMix<float>(const TextureRequest&);
template ColorParameter MakeDirectionMix<Color>(const TextureRequest&);

}  // namespace lampyr
