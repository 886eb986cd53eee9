// The textures and images of a scene, by name, and the parameters of materials and lights that may use them.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "film/image.h"
#include "scene/parameters.h"
#include "scene/scene_description.h"
#include "textures/texture.h"

namespace lampyr {

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
  std::optional<ColorParameter> FindColor(const ParameterList& parameters, const std::string& name, SpectrumRole role) const;

  // An image file, read once and shared. Throws an Error at `where` when it cannot be read.
  std::shared_ptr<const Image> GetImage(const std::filesystem::path& file, ImageEncoding encoding,
                                        const FileLocation& where) const;

 private:
  std::map<std::string, std::shared_ptr<const FloatTexture>> floatTextures_;
  std::map<std::string, std::shared_ptr<const ColorTexture>> colorTextures_;
  mutable std::map<std::string, std::shared_ptr<const Image>> images_;
};

}  // namespace lampyr
