// A material: makes the Bsdf at a surface point. Textures, normal maps and bump maps are evaluated here.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/geometry_scene.h"
#include "materials/bsdf.h"

namespace lampyr {

class Diagnostics;
class ParameterList;
class TextureLibrary;
class Wavelengths;

class Material {
 public:
  virtual ~Material() = default;

  // The scattering at `point`. `wo` enters the hash that chooses between mixed materials, and orients bumps.
  virtual Bsdf GetBsdf(const SurfacePoint& point, const Vector3& wo) const = 0;

  // True for "interface" of pbrt: a boundary without scattering, which rays pass straight through.
  virtual bool IsInterface() const { return false; }
  // True if the material may transmit at some point; true if it may scatter by deltas at some point.
  virtual bool MayTransmit() const { return false; }
  virtual bool HasDelta() const { return false; }
  // True if it scatters by deltas only, at every point and in every draw: no photons can be gathered there. A mix is
  // drawn anew for each path, so that a delta in one draw implies nothing for the draws of other paths.
  virtual bool IsAlwaysDelta() const { return false; }
  // True if a normal map or displacement changes the shading frame.
  virtual bool HasMappedNormal() const { return false; }
  // False if GetBsdf never uses uv and tangents of the point.
  virtual bool NeedsParametrization() const { return true; }
  // True if curves of this material may be fibres (Bsdf::IsFibre).
  virtual bool IsFibrous() const { return false; }
  // False if it gathers photons in no draw (Bsdf::GathersPhotons).
  virtual bool MayGatherPhotons() const { return true; }
  // The transmission of a thin surface, which ray tracing has to account for if SurfacePoint::isThin is set. Null: not
  // a thin surface.
  virtual const ThinSurface* Thin() const { return nullptr; }
  // This material with rougher microfacets (TrowbridgeReitz::Roughened), or null if it has none. A material made of
  // others gets theirs from `roughened`.
  using Roughener = std::function<std::shared_ptr<const Material>(const std::shared_ptr<const Material>&)>;
  virtual std::shared_ptr<const Material> Roughened(const Roughener& /*roughened*/) const { return nullptr; }
  // This material at the wavelengths of a pass; null if it is the same at all wavelengths. A material made of others
  // gets theirs from `tuned`.
  using Tuner = std::function<std::shared_ptr<const Material>(const std::shared_ptr<const Material>&)>;
  virtual std::shared_ptr<const Material> AtWavelengths(const std::shared_ptr<const Wavelengths>& /*wavelengths*/,
                                                        const Tuner& /*tuned*/) const {
    return nullptr;
  }
  // True if it refracts light of different wavelengths to different directions.
  virtual bool Disperses() const { return false; }
  // True if reflections or refractions may be sharp, as in mirrors and clear glass.
  bool IsSmooth() const { return HasDelta() && !IsInterface(); }
};

// The materials with rougher microfacets, in the same order; those without microfacets, and null, are shared.
std::vector<std::shared_ptr<const Material>> RoughenedMaterials(
    const std::vector<std::shared_ptr<const Material>>& materials);

// The materials at the wavelengths of a pass, in the same order; null stays null.
std::vector<std::shared_ptr<const Material>> MaterialsAt(const std::shared_ptr<const Wavelengths>& wavelengths,
                                                         const std::vector<std::shared_ptr<const Material>>& materials);

// Finds materials by name for a "mix"; throws an Error if there is none.
using MaterialLookup = std::function<std::shared_ptr<const Material>(const std::string& name)>;

// Makes the material `type` ("diffuse", "conductor", …) from its parameters. Throws an Error that names the parameter
// if one is wrong or unknown, and warns about those without effect. `textures` resolves "texture" parameters and
// images. An unsupported type of pbrt-v4 becomes gray diffuse, with a warning.
std::shared_ptr<const Material> MakeMaterial(const std::string& type, const ParameterList& parameters,
                                             const TextureLibrary& textures, const MaterialLookup& namedMaterials,
                                             Diagnostics& diagnostics);

// Names of the supported types in scene files.
std::vector<std::string> MaterialTypeNames();

}  // namespace lampyr
