// Image maps are made first, and all other textures in the order of the file. A texture may refer only to those made
// before it, so that there are no cycles.
#include "textures/texture_library.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "film/image_colors.h"
#include "film/srgb.h"
#include "textures/texture_families.h"

namespace lampyr {

namespace {

constexpr std::array<SpectrumRole, 4> kRoles = {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Extinction,
                                                SpectrumRole::Illuminant};

size_t IndexOf(SpectrumRole role) {
  return static_cast<size_t>(std::find(kRoles.begin(), kRoles.end(), role) - kRoles.begin());
}

const TextureType& FindType(const TextureDescription& description) {
  std::vector<std::string> names;
  for (const TextureType& type : TextureTypes()) {
    if (description.texture.type == type.name) {
      if (description.isSpectrum ? type.makeColor != nullptr : type.makeFloat != nullptr) return type;
      throw Error(description.texture.where, "texture type \"" + description.texture.type + "\" makes a " +
                                                 (description.isSpectrum ? "float" : "spectrum") + ", not a " +
                                                 (description.isSpectrum ? "spectrum" : "float"));
    }
    names.emplace_back(type.name);
  }
  throw Error(description.texture.where,
              "\"" + description.texture.type + "\" is no texture type" + DidYouMean(description.texture.type, names));
}

Affine RenderToTexture(const TextureDescription& description, const Transform& worldToRender) {
  const Transform textureToRender = worldToRender * description.placement.start;
  if (textureToRender.IsSingular()) throw Error(description.texture.where, "the texture's transform is singular");
  const Transform inverse = textureToRender.Inverse();
  if (!textureToRender.IsAffine()) throw Error(description.texture.where, "the texture's transform is a projection");
  return inverse.ToAffine();
}

}  // namespace

TextureLibrary::TextureLibrary(const std::vector<TextureDescription>& textures, const Transform& worldToRender,
                               Diagnostics& diagnostics) {
  for (const TextureDescription& description : textures) allNames_.push_back(description.name);
  const auto isImage = [](const TextureDescription& description) { return description.texture.type == "imagemap"; };
  for (const bool areImages : {true, false}) {
    for (const TextureDescription& description : textures)
      if (isImage(description) == areImages) Add(description, worldToRender, diagnostics);
  }
}

TextureLibrary::~TextureLibrary() = default;

void TextureLibrary::Add(const TextureDescription& description, const Transform& worldToRender,
                         Diagnostics& diagnostics) {
  const bool exists =
      description.isSpectrum ? colorTextures_.count(description.name) > 0 : floatTextures_.count(description.name) > 0;
  const std::string kind = description.isSpectrum ? "spectrum" : "float";
  if (exists) {
    throw Error(description.texture.where, "there is a " + kind + " texture \"" + description.name + "\" already");
  }
  const TextureType& type = FindType(description);
  TextureRequest request{description, *this, RenderToTexture(description, worldToRender),
                         SpectrumRole::Albedo, diagnostics};
  Nesting nesting;
  beingMade_ = &nesting;
  if (description.isSpectrum) {
    ColorVariants variants;
    for (size_t i = 0; i < kRoles.size(); ++i) {
      nesting = {};
      request.role = kRoles[i];
      try {
        variants.of[i] = type.makeColor(request);
      } catch (const Error& error) {
        if (request.role != SpectrumRole::Albedo) throw;
        variants.noAlbedo = error;
      }
    }
    nesting.Check("textures", allNames_.size(), description.texture.where);
    colorTextures_.emplace(description.name, Named<ColorVariants>{std::move(variants), nesting});
  } else {
    FloatParameter value = type.makeFloat(request);
    nesting.Check("textures", allNames_.size(), description.texture.where);
    floatTextures_.emplace(description.name, Named<FloatParameter>{std::move(value), nesting});
  }
  beingMade_ = nullptr;
  description.texture.parameters.CheckAllUsed(type.alsoInPbrt, type.parameters, diagnostics);
}

void TextureLibrary::ThrowUnknownTexture(const ParameterList& parameters, const std::string& parameter,
                                         const std::string& texture, bool isSpectrum) const {
  const FileLocation where = parameters.WhereOf(parameter);
  const std::string kind = isSpectrum ? "spectrum" : "float";
  const bool isOtherKind = isSpectrum ? floatTextures_.count(texture) > 0 : colorTextures_.count(texture) > 0;
  if (isOtherKind) {
    throw Error(where, "texture \"" + texture + "\" is a " + (isSpectrum ? "float" : "spectrum") + " texture; \"" +
                           parameter + "\" needs a " + kind + " texture");
  }
  if (std::find(allNames_.begin(), allNames_.end(), texture) != allNames_.end()) {
    throw Error(where, "texture \"" + texture + "\" is defined after its use, or as another kind than " + kind);
  }
  std::vector<std::string> names;
  for (const auto& [name, value] : floatTextures_) {
    if (!isSpectrum) names.push_back(name);
  }
  for (const auto& [name, value] : colorTextures_) {
    if (isSpectrum) names.push_back(name);
  }
  throw Error(where, "there is no " + kind + " texture \"" + texture + "\"" + DidYouMean(texture, names));
}

std::optional<FloatParameter> TextureLibrary::FindFloat(const ParameterList& parameters,
                                                        const std::string& name) const {
  if (const auto texture = parameters.GetTextureName(name)) {
    const auto found = floatTextures_.find(*texture);
    if (found == floatTextures_.end()) ThrowUnknownTexture(parameters, name, *texture, false);
    const auto& [value, nesting] = found->second;
    if (beingMade_ && !value.IsConstant()) beingMade_->Add(nesting);
    return value;
  }
  if (!parameters.Find(name)) return std::nullopt;
  return FloatParameter(static_cast<float>(parameters.GetFloat(name, 0)));
}

std::optional<ColorParameter> TextureLibrary::FindColor(const ParameterList& parameters, const std::string& name,
                                                        SpectrumRole role) const {
  if (const auto texture = parameters.GetTextureName(name)) {
    const auto found = colorTextures_.find(*texture);
    if (found == colorTextures_.end()) ThrowUnknownTexture(parameters, name, *texture, true);
    const auto& [variants, nesting] = found->second;
    if (role == SpectrumRole::Albedo && variants.noAlbedo) throw *variants.noAlbedo;
    const ColorParameter& value = variants.of[IndexOf(role)];
    if (beingMade_ && !value.IsConstant()) beingMade_->Add(nesting);
    return value;
  }
  if (const auto color = parameters.FindColor(name, role))
    return ColorParameter(*color, parameters.FindCurve(name, role));
  return std::nullopt;
}

FloatParameter TextureLibrary::GetFloat(const ParameterList& parameters, const std::string& name,
                                        float defaultValue) const {
  return FindFloat(parameters, name).value_or(FloatParameter(defaultValue));
}

ColorParameter TextureLibrary::GetColor(const ParameterList& parameters, const std::string& name,
                                        const Color& defaultValue, SpectrumRole role) const {
  return FindColor(parameters, name, role).value_or(ColorParameter(defaultValue));
}

namespace {

// The image cached under `key`; calls read() at the first use. Errors of read() get the location in the scene file.
template <class Read>
std::shared_ptr<const Image> GetCached(std::map<std::string, std::shared_ptr<const Image>>& images,
                                       const std::string& key, const FileLocation& where, Read read) {
  const auto found = images.find(key);
  if (found != images.end()) return found->second;
  try {
    return images[key] = std::make_shared<const Image>(read());
  } catch (const Error& e) {
    throw Error(where, e.Text());
  }
}

}  // namespace

std::shared_ptr<const Image> TextureLibrary::GetImage(const std::filesystem::path& file, ImageEncoding encoding,
                                                      const FileLocation& where) const {
  const std::string key = file.string() + '\n' + std::to_string(static_cast<int>(encoding));
  return GetCached(images_, key, where, [&] { return ReadImage(file, encoding); });
}

std::shared_ptr<const Image> TextureLibrary::InRec709(const std::shared_ptr<const Image>& image,
                                                      WhiteHandling white) const {
  if (!NeedsConversion(*image, white)) return image;
  std::shared_ptr<const Image>& converted = converted_[{image, white}];
  if (!converted) converted = std::make_shared<const Image>(lampyr::InRec709(*image, white, GamutHandling::Limit));
  return converted;
}

std::shared_ptr<const Image> TextureLibrary::WithDecodedAlpha(const std::shared_ptr<const Image>& image) const {
  const int alpha = image->ChannelIndex("A");
  if (alpha < 0 || image->colorGamma == 1) return image;
  std::shared_ptr<const Image>& decoded = decoded_[image];
  if (decoded) return decoded;
  auto copy = std::make_shared<Image>(*image);
  for (auto at = static_cast<size_t>(alpha); at < copy->data.size(); at += copy->channels.size()) {
    float& value = copy->data[at];
    value = image->colorGamma == 0 ? SrgbToLinear(value) : std::pow(std::max(value, 0.0f), image->colorGamma);
  }
  decoded = copy;
  return decoded;
}

std::shared_ptr<const Image> TextureLibrary::GetImageWithGamma(const std::filesystem::path& file, float gamma,
                                                               const FileLocation& where) const {
  const std::string key = file.string() + "\ngamma " + std::to_string(gamma);
  return GetCached(images_, key, where, [&] { return ReadImageWithGamma(file, gamma); });
}

namespace {

class ParameterAlpha : public AlphaSource {
 public:
  explicit ParameterAlpha(FloatParameter parameter) : parameter_(std::move(parameter)) {}

  float Alpha(const Point2& uv, const Point3& position, const Normal3& Ng) const override {
    return std::clamp(parameter_.Evaluate({uv, position, Ng}), 0.0f, 1.0f);
  }

 private:
  FloatParameter parameter_;
};

}  // namespace

std::shared_ptr<const AlphaSource> MakeAlphaSource(const FloatParameter& parameter) {
  if (parameter.IsConstant() && parameter.Evaluate({}) >= 1) return nullptr;
  return std::make_shared<ParameterAlpha>(parameter);
}

}  // namespace lampyr
