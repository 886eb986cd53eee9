// The textures and images of a scene by name, and the parameters of materials and lights that may refer to them.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/image.h"
#include "geometry/geometry_scene.h"
#include "scene/nesting.h"
#include "scene/parameters.h"
#include "scene/scene_description.h"
#include "spectral/color_space.h"
#include "textures/texture.h"

namespace lampyr {

// Used by one thread while the scene is built. Its results may be used by any thread.
class TextureLibrary {
 public:
  // Makes all textures of the scene. `worldToRender` places textures with 3-D mappings. Throws located Errors.
  TextureLibrary(const std::vector<TextureDescription>& textures, const Transform& worldToRender,
                 Diagnostics& diagnostics);
  ~TextureLibrary();

  // A parameter that is a number, a colour or the name of a texture. Throws an Error if the texture does not exist.
  FloatParameter GetFloat(const ParameterList& parameters, const std::string& name, float defaultValue) const;
  ColorParameter GetColor(const ParameterList& parameters, const std::string& name, const Color& defaultValue,
                          SpectrumRole role) const;
  // The same; absent if the parameter is not given.
  std::optional<FloatParameter> FindFloat(const ParameterList& parameters, const std::string& name) const;
  std::optional<ColorParameter> FindColor(const ParameterList& parameters, const std::string& name,
                                          SpectrumRole role) const;

  // An image of colours (R, G, B) in Rec. 709, whatever primaries and white it was written for (Image::chromaticities).
  std::shared_ptr<const Image> InRec709(const std::shared_ptr<const Image>& image, WhiteHandling white) const;

  // The image with its alpha decoded like its colours, for float textures: pbrt-v4 reads alpha as an amount.
  std::shared_ptr<const Image> WithDecodedAlpha(const std::shared_ptr<const Image>& image) const;

  // An image file, read once and shared. Throws an Error at `where` if it cannot be read.
  std::shared_ptr<const Image> GetImage(const std::filesystem::path& file, ImageEncoding encoding,
                                        const FileLocation& where) const;
  // Variant of GetImage with a power law for integer formats: linear = encoded^gamma.
  std::shared_ptr<const Image> GetImageWithGamma(const std::filesystem::path& file, float gamma,
                                                 const FileLocation& where) const;

 private:
  // A colour texture for each SpectrumRole, which determines how its spectra become RGB.
  struct ColorVariants {
    std::array<ColorParameter, 4> of;
    std::optional<Error> noAlbedo;  // set if it cannot be a reflectance: thrown when it is used as one
  };
  template <class Value>
  struct Named {
    Value value;
    Nesting nesting;  // of textures that vary: constants need no evaluation
  };

  void Add(const TextureDescription& description, const Transform& worldToRender, Diagnostics& diagnostics);
  [[noreturn]] void ThrowUnknownTexture(const ParameterList& parameters, const std::string& parameter,
                                        const std::string& texture, bool isSpectrum) const;

  std::map<std::string, Named<FloatParameter>> floatTextures_;  // textures that do not vary are constants
  std::map<std::string, Named<ColorVariants>> colorTextures_;
  mutable std::map<std::pair<std::shared_ptr<const Image>, WhiteHandling>, std::shared_ptr<const Image>> converted_;
  mutable std::map<std::shared_ptr<const Image>, std::shared_ptr<const Image>> decoded_;  // WithDecodedAlpha
  Nesting* beingMade_ = nullptr;                                                          // of the texture being made
  std::vector<std::string> allNames_;  // of all textures of the scene, for messages
  mutable std::map<std::string, std::shared_ptr<const Image>> images_;
};

// Null if the parameter is a constant of at least 1: opaque surfaces cost nothing.
std::shared_ptr<const AlphaSource> MakeAlphaSource(const FloatParameter& parameter);

}  // namespace lampyr
