// The imagemap texture: an image file, looked up by a 2-D mapping. value = scale · texel; 1 - value if inverted.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "textures/texel_lookup.h"
#include "textures/texture_families.h"

namespace lampyr {

namespace {

class FloatImageTexture : public FloatTexture {
 public:
  FloatImageTexture(const TextureMapping2D& mapping, TexelLookup texels, float scale, bool invert)
      : mapping_(mapping), texels_(std::move(texels)), scale_(scale), invert_(invert) {}
  float Evaluate(const TextureContext& where) const override {
    const float value = scale_ * texels_.LookupFloat(mapping_.Map(where));
    return invert_ ? std::max(0.0f, 1 - value) : value;
  }
  std::shared_ptr<const FloatTexture> Scaled(float factor) const override {
    auto scaled = std::make_shared<FloatImageTexture>(*this);
    scaled->scale_ *= factor;
    return scaled;
  }

 private:
  TextureMapping2D mapping_;
  TexelLookup texels_;
  float scale_;
  bool invert_;
};

// Values are never negative, and never above 1 for an albedo: whatever the image contains, a surface must not create
// energy.
class ColorImageTexture : public ColorTexture {
 public:
  ColorImageTexture(const TextureMapping2D& mapping, TexelLookup texels, float scale, bool invert, bool isAlbedo)
      : mapping_(mapping),
        texels_(std::move(texels)),
        scale_(scale),
        invert_(invert),
        largest_(isAlbedo ? 1.0f : std::numeric_limits<float>::max()) {}
  Color Evaluate(const TextureContext& where) const override {
    Color value = scale_ * texels_.LookupColor(mapping_.Map(where));
    if (invert_) value = Color(1.0f) - value;
    return {Bounded(value.r), Bounded(value.g), Bounded(value.b)};
  }
  std::shared_ptr<const ColorTexture> Scaled(float factor) const override {
    auto scaled = std::make_shared<ColorImageTexture>(*this);
    scaled->scale_ *= factor;
    return scaled;
  }

 private:
  float Bounded(float x) const { return x > 0 ? std::min(x, largest_) : 0.0f; }

  TextureMapping2D mapping_;
  TexelLookup texels_;
  float scale_;
  bool invert_;
  float largest_;
};

// Index in `names` of the value of a string parameter; throws an Error that suggests the nearest entry for any other
// value.
size_t ReadChoice(const ParameterList& parameters, const std::string& name, const std::vector<std::string>& names) {
  const std::string value = parameters.GetString(name, names[0]);
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) {
    throw Error(parameters.WhereOf(name), "\"" + value + "\" is no " + name + DidYouMean(value, names));
  }
  return static_cast<size_t>(found - names.begin());
}

// The exponent of "gamma 2.2"; 0 for any other text.
float ReadGamma(const std::string& encoding) {
  const std::string prefix = "gamma ";
  if (encoding.rfind(prefix, 0) != 0) return 0;
  const std::string number = encoding.substr(prefix.size());
  char* end = nullptr;
  const float gamma = std::strtof(number.c_str(), &end);
  return *end == '\0' && gamma > 0 && std::isfinite(gamma) ? gamma : 0;
}

// The image with 0 in place of values that are not finite, which filtering would spread.
std::shared_ptr<const Image> Finite(const std::shared_ptr<const Image>& image, const TextureRequest& request) {
  const auto isFinite = [](float x) { return std::isfinite(x); };
  const auto count =
      image->data.size() - static_cast<size_t>(std::count_if(image->data.begin(), image->data.end(), isFinite));
  if (count == 0) return image;
  const ParameterList& parameters = request.Parameters();
  request.diagnostics.Warn(parameters.WhereOf("filename"), "\"" + parameters.GetFile("filename") +
                                                               "\": " + std::to_string(count) +
                                                               " values are not finite, and are taken for 0");
  auto finite = std::make_shared<Image>(*image);
  std::replace_if(
      finite->data.begin(), finite->data.end(), [&](float x) { return !isFinite(x); }, 0.0f);
  return finite;
}

std::shared_ptr<const Image> ReadTextureImage(const TextureRequest& request) {
  const ParameterList& parameters = request.Parameters();
  const std::string file = parameters.GetFile("filename");
  if (file.empty()) throw Error(parameters.Where(), "an imagemap needs a \"string filename\"");
  const std::string encoding = parameters.GetString("encoding", "");
  const FileLocation where = parameters.WhereOf("filename");
  if (encoding.empty()) return request.library.GetImage(file, ImageEncoding::Automatic, where);
  if (encoding == "sRGB") return request.library.GetImage(file, ImageEncoding::Srgb, where);
  if (encoding == "linear") return request.library.GetImage(file, ImageEncoding::Linear, where);
  const float gamma = ReadGamma(encoding);
  if (gamma == 0) {
    throw Error(parameters.WhereOf("encoding"),
                "\"" + encoding + "\" is no encoding: \"sRGB\", \"linear\" and \"gamma 2.2\" are");
  }
  return request.library.GetImageWithGamma(file, gamma, where);
}

}  // namespace

template <class Value>
ParameterOf<Value> MakeImageMap(const TextureRequest& request) {
  const ParameterList& parameters = request.Parameters();
  const size_t wrap = ReadChoice(parameters, "wrap", {"repeat", "black", "clamp", "octahedralsphere"});
  const size_t filter = ReadChoice(parameters, "filter", {"bilinear", "point", "trilinear", "EWA", "ewa"});
  const float scale = static_cast<float>(parameters.GetFloat("scale", 1));
  const bool invert = parameters.GetBool("invert", false);
  const TextureMapping2D mapping = ReadMapping2D(request);
  std::shared_ptr<const Image> image = ReadTextureImage(request);
  if (!image->HasRgb()) {
    std::string channels;
    for (const std::string& channel : image->channels) channels += (channels.empty() ? "" : ", ") + channel;
    throw Error(parameters.WhereOf("filename"),
                "\"" + parameters.GetFile("filename") +
                    "\" has no R, G and B channels, and is not gray: its channels are " + channels);
  }
  image = Finite(image, request);
  if constexpr (std::is_same_v<Value, Color>) {
    const bool isLight = request.role == SpectrumRole::Illuminant;
    image = request.library.InRec709(image, isLight ? WhiteHandling::Keep : WhiteHandling::Adapt);
  }
  if constexpr (std::is_same_v<Value, float>) image = request.library.WithDecodedAlpha(image);
  TexelLookup texels(image, static_cast<WrapMode>(wrap), filter != 1);
  if constexpr (std::is_same_v<Value, float>) {
    return FloatParameter(std::make_shared<FloatImageTexture>(mapping, std::move(texels), scale, invert));
  } else {
    return ColorParameter(std::make_shared<ColorImageTexture>(mapping, std::move(texels), scale, invert,
                                                              request.role == SpectrumRole::Albedo));
  }
}

template FloatParameter MakeImageMap<float>(const TextureRequest&);
template ColorParameter MakeImageMap<Color>(const TextureRequest&);

}  // namespace lampyr
