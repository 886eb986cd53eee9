// A material defined by a recipe: parameters, possibly textures, from which a scattering model is made at each point.
// The model of a recipe without textures is made once. A recipe has
//   BsdfModel Make(const TextureContext&) const;   bool IsConstant() const;   bool IsAnisotropic() const;
//   bool MayTransmit() const;   bool HasDelta() const;
// if it has microfacets, `void Roughen()` (Material::Roughened), if it has colours, `void TuneTo(wavelengths)`
// (Material::AtWavelengths), and if it may disperse light, `bool Disperses() const`.
#pragma once

#include "materials/material.h"
#include "materials/shading_normal.h"

namespace lampyr {

template <class Recipe>
class RecipeMaterial final : public Material {
 public:
  RecipeMaterial(Recipe recipe, ShadingNormal shadingNormal)
      : recipe_(std::move(recipe)),
        shadingNormal_(std::move(shadingNormal)),
        isConstant_(recipe_.IsConstant()),
        needsTangent_(recipe_.IsAnisotropic()) {
    if (isConstant_) model_ = recipe_.Make({});
  }
  RecipeMaterial(const RecipeMaterial&) = delete;  // the model may point into the recipe
  RecipeMaterial& operator=(const RecipeMaterial&) = delete;

  Bsdf GetBsdf(const SurfacePoint& point, const Vector3&) const override {
    const Frame frame = GetFrame(point);
    if (isConstant_) return Bsdf(frame, point.Ng, model_);
    return Bsdf(frame, point.Ng, recipe_.Make({point.uv, point.position, point.Ng}));
  }
  bool MayTransmit() const override { return recipe_.MayTransmit(); }
  bool HasDelta() const override { return recipe_.HasDelta(); }
  bool HasMappedNormal() const override { return !shadingNormal_.IsPlain(); }
  bool NeedsParametrization() const override { return !isConstant_ || needsTangent_ || !shadingNormal_.IsPlain(); }
  std::shared_ptr<const Material> Roughened(const Roughener&) const override {
    if constexpr (requires(Recipe recipe) { recipe.Roughen(); }) {
      Recipe rougher = recipe_;
      rougher.Roughen();
      return std::make_shared<RecipeMaterial>(std::move(rougher), shadingNormal_);
    } else {
      return nullptr;
    }
  }
  std::shared_ptr<const Material> AtWavelengths(const std::shared_ptr<const Wavelengths>& wavelengths,
                                                const Tuner&) const override {
    if constexpr (requires(Recipe recipe) { recipe.TuneTo(wavelengths); }) {
      Recipe tuned = recipe_;
      tuned.TuneTo(wavelengths);
      return std::make_shared<RecipeMaterial>(std::move(tuned), shadingNormal_);
    } else {
      return nullptr;
    }
  }
  bool Disperses() const override {
    if constexpr (requires { recipe_.Disperses(); }) return recipe_.Disperses();
    return false;
  }
  bool IsAlwaysDelta() const override { return isConstant_ && Bsdf(Frame(), Normal3(0, 0, 1), model_).IsDelta(); }

 private:
  Frame GetFrame(const SurfacePoint& point) const {
    if (!shadingNormal_.IsPlain()) return shadingNormal_.GetFrame(point);
    return needsTangent_ ? Frame::FromNormalAndTangent(point.Ns, point.dpdu) : Frame::FromNormal(point.Ns);
  }

  Recipe recipe_;
  ShadingNormal shadingNormal_;
  bool isConstant_, needsTangent_;
  BsdfModel model_;
};

}  // namespace lampyr
