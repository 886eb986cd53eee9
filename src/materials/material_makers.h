// The factories behind MakeMaterial, one per family of materials, and their common parameters.
#pragma once

#include <vector>

#include "base/error.h"
#include "materials/material.h"
#include "materials/metal_index.h"
#include "materials/microfacet.h"
#include "materials/shading_normal.h"
#include "scene/parameters.h"
#include "textures/texture_library.h"

namespace lampyr {

// Input of a factory.
struct MaterialInput {
  const ParameterList& parameters;
  const TextureLibrary& textures;
  const MaterialLookup& namedMaterials;
  Diagnostics& diagnostics;
};

std::shared_ptr<const Material> MakeDiffuse(const MaterialInput& input);
std::shared_ptr<const Material> MakeDiffuseTransmission(const MaterialInput& input);
std::shared_ptr<const Material> MakeGray();  // diffuse 0.5, for unsupported types
std::shared_ptr<const Material> MakeConductor(const MaterialInput& input);
std::shared_ptr<const Material> MakeDielectric(const MaterialInput& input);
std::shared_ptr<const Material> MakeThinDielectric(const MaterialInput& input);
std::shared_ptr<const Material> MakeCoatedDiffuse(const MaterialInput& input);
std::shared_ptr<const Material> MakeCoatedConductor(const MaterialInput& input);
std::shared_ptr<const Material> MakeHair(const MaterialInput& input);
std::shared_ptr<const Material> MakeMeasured(const MaterialInput& input);
std::shared_ptr<const Material> MakeMix(const MaterialInput& input);
std::shared_ptr<const Material> MakeInterface(const MaterialInput& input);

// ParameterList::CheckAllUsed, with the parameters common to all materials added.
void CheckMaterialParameters(const MaterialInput& input, std::vector<std::string> known,
                             const std::vector<std::string>& alsoInPbrt = {});

// "PREFIXroughness", "PREFIXuroughness", "PREFIXvroughness" and "remaproughness" (default true: α = sqrt(roughness), as
// in pbrt-v4; false: α = roughness). Default roughness 0.
class RoughnessParameters {
 public:
  RoughnessParameters(const MaterialInput& input, const std::string& prefix);

  TrowbridgeReitz Evaluate(const TextureContext& where) const;
  bool IsConstant() const { return u_.IsConstant() && v_.IsConstant(); }
  bool IsAnisotropic() const { return isAnisotropic_; }
  bool MayBeSmooth() const { return !isRoughened_ && (!IsConstant() || Evaluate({}).IsSmooth()); }
  // Makes Evaluate return rougher microfacets (TrowbridgeReitz::Roughened) from now on.
  void Roughen() { isRoughened_ = true; }
  // α values for a table: the constant one, or TexturedAlphas().
  std::vector<float> TableAlphas() const;

 private:
  FloatParameter u_, v_;
  bool isAnisotropic_ = false;
  bool remap_ = true;
  bool isRoughened_ = false;
};

// "PREFIXeta", "PREFIXk" and "reflectance" of a metal; copper if none is given.
class MetalParameters {
 public:
  MetalParameters(const MaterialInput& input, const std::string& prefix);

  MetalIndex Evaluate(const TextureContext& where) const;
  bool IsConstant() const;
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths);

 private:
  std::optional<ColorParameter> reflectance_;
  ColorParameter eta_, k_;
};

// Index of refraction `name`: a number, or the mean over the channels of a spectrum.
float GetEta(const MaterialInput& input, const std::string& name, float defaultValue);

// The index as a function of the wavelength, by the spectrum `name`, or by "cauchy" (a, b, c in powers of µm²) or
// "sellmeier" (b1, b2, b3, and c1, c2, c3 in µm²); null: constant.
std::shared_ptr<const SpectralCurve> FindEtaCurve(const MaterialInput& input, const std::string& name);

// Clamps a reflectance or transmittance to [0,1]; NaN counts as 0.
Color ClampToUnit(const Color& c);

}  // namespace lampyr
