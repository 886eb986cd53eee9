// The textures and images of a scene, by name, and the parameters of materials and lights that may use them.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/image.h"
#include "scene/nesting.h"
#include "scene/parameters.h"
#include "scene/scene_description.h"
#include "textures/texture.h"

namespace lampyr {

// Made and asked while the scene is built, by one thread. What it hands out may be used by any.
class TextureLibrary {
 public:
  // Makes all textures of the scene. `worldToRender` places those with 3-D mappings. Throws located Errors.
  TextureLibrary(const std::vector<TextureDescription>& textures, const Transform& worldToRender,
                 Diagnostics& diagnostics);
  ~TextureLibrary();

  // A parameter that is a number, a colour or the name of a texture. Throws when the texture does not exist.
  FloatParameter GetFloat(const ParameterList& parameters, const std::string& name, float defaultValue) const;
  ColorParameter GetColor(const ParameterList& parameters, const std::string& name, const Color& defaultValue,
                          SpectrumRole role) const;
  // The same, but absent when the parameter was not given.
  std::optional<FloatParameter> FindFloat(const ParameterList& parameters, const std::string& name) const;
  std::optional<ColorParameter> FindColor(const ParameterList& parameters, const std::string& name,
                                          SpectrumRole role) const;

  // An image file, read once and shared. Throws an Error at `where` when it cannot be read.
  std::shared_ptr<const Image> GetImage(const std::filesystem::path& file, ImageEncoding encoding,
                                        const FileLocation& where) const;
  // The same with a power law for integer formats: linear = encoded^gamma.
  std::shared_ptr<const Image> GetImageWithGamma(const std::filesystem::path& file, float gamma,
                                                 const FileLocation& where) const;

 private:
  // A colour texture as albedo, unbounded and illuminant: what it is used for decides how its spectra become RGB.
  using ColorVariants = std::array<ColorParameter, 3>;
  template <class Value>
  struct Named {
    Value value;
    Nesting nesting;  // of textures that vary: constants are not asked
  };

  void Add(const TextureDescription& description, const Transform& worldToRender, Diagnostics& diagnostics);
  [[noreturn]] void ThrowUnknownTexture(const ParameterList& parameters, const std::string& parameter,
                                        const std::string& texture, bool isSpectrum) const;

  std::map<std::string, Named<FloatParameter>> floatTextures_;  // textures that do not vary are constants
  std::map<std::string, Named<ColorVariants>> colorTextures_;
  Nesting* beingMade_ = nullptr;       // of the texture that is being made
  std::vector<std::string> allNames_;  // of textures that come later, too: for messages
  mutable std::map<std::string, std::shared_ptr<const Image>> images_;
};

}  // namespace lampyr
