// A material: turns a surface point into a Bsdf. Textures, normal and bump maps are evaluated here.
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

class Material {
 public:
  virtual ~Material() = default;

  // The scattering at `point`; `wo` decides which of mixed materials is chosen (by hash) and orients bumps.
  virtual Bsdf GetBsdf(const SurfacePoint& point, const Vector3& wo) const = 0;

  // pbrt's "interface": a boundary without scattering; rays pass straight through.
  virtual bool IsInterface() const { return false; }
  // Whether some point of it may scatter by deltas only, or may transmit: what the scene has to be modelled for.
  virtual bool MayTransmit() const { return false; }
  virtual bool HasDelta() const { return false; }
  // True if it scatters by deltas only, everywhere and in every draw: no photon can be gathered there. A mix is drawn
  // anew by each path that meets it, so that a draw of it that is a delta says nothing of the draws of other paths.
  virtual bool IsAlwaysDelta() const { return false; }
  // True if curves of it may be fibres (Bsdf::IsFibre).
  virtual bool IsFibrous() const { return false; }
  // False if it gathers photons in no draw (Bsdf::GathersPhotons).
  virtual bool MayGatherPhotons() const { return true; }
  // Of a sheet without thickness: what of the light goes straight on without meeting it. Null: not one. Whoever traces
  // rays must see to it where SurfacePoint::isThin says so.
  virtual const ThinSurface* Thin() const { return nullptr; }
  // Mirrors and clear glass: what shows light sharply.
  bool IsSmooth() const { return HasDelta() && !IsInterface(); }
};

// Finds materials by name while a "mix" is being made; throws an Error when there is none.
using MaterialLookup = std::function<std::shared_ptr<const Material>(const std::string& name)>;

// Makes the material `type` ("diffuse", "conductor", …) from its parameters. Throws an Error that names the parameter
// at fault and warns about the ones it does not know. `textures` resolves "texture" parameters and images.
std::shared_ptr<const Material> MakeMaterial(const std::string& type, const ParameterList& parameters,
                                             const TextureLibrary& textures, const MaterialLookup& namedMaterials,
                                             Diagnostics& diagnostics);

// The types that are supported, as scenes name them.
std::vector<std::string> MaterialTypeNames();

}  // namespace lampyr
