// Images in memory, the choice of a reader by content, and display images.
#include "film/image.h"

#include "film/terminal_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/memory.h"
#include "film/atomic_file.h"
#include "film/image_formats.h"
#include "film/srgb.h"

namespace lampyr {

namespace {

constexpr std::string_view kOpenExr = "openexr", kPng = "png", kRadiance = "hdr";

// Applies `decode` to all channels except alpha. 8-bit values use a table: a texture has millions of them.
template <class Decode>
void DecodeChannels(EncodedImage& encoded, Decode decode) {
  Image& image = encoded.image;
  std::array<float, 256> table;
  for (size_t i = 0; i < table.size(); ++i) table[i] = decode(static_cast<float>(i) / 255.0f);
  const size_t stride = image.channels.size();
  for (size_t c = 0; c < stride; ++c) {
    if (image.channels[c] == "A") continue;
    for (size_t i = c; i < image.data.size(); i += stride) {
      float& value = image.data[i];
      if (encoded.integerBits == 8) {
        value = table[static_cast<size_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f))];
      } else {
        value = decode(value);
      }
    }
  }
}

void CheckReadable(const std::filesystem::path& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) throw Error("cannot read image \"" + path.string() + "\": no such file");
  if (std::filesystem::is_directory(status)) throw Error("cannot read image \"" + path.string() + "\": it is a folder");
  if (!std::filesystem::is_regular_file(status)) {
    throw Error("cannot read image \"" + path.string() + "\": it is not a regular file");
  }
}

EncodedImage ReadEncoded(const std::filesystem::path& path, const ImageKind& kind) {
  if (kind.format == kPng) return ReadPng(path);
  if (kind.format == kRadiance) {
    if (std::optional<Image> image = ReadUsualRadiance(path)) return {std::move(*image), 0, false};
  }
  return ReadThroughModule(path, kind);
}

// Identity up to s = kShoulderStart, then an exponential that continues it with the same slope and tends to 1:
//   s + (1-s)·(1 - exp(-(x-s)/(1-s)))
// Applied per channel, so that very bright colours fade to white. No toe.
float FilmicShoulder(float x) {
  constexpr float kShoulderStart = 0.6f;
  if (x <= kShoulderStart) return x;
  constexpr float room = 1.0f - kShoulderStart;
  return kShoulderStart + room * (1.0f - std::exp(-(x - kShoulderStart) / room));
}

}  // namespace

unsigned char ToDisplay(float linear, float exposure, ToneMap toneMap) {
  float x = linear * exposure;
  if (!(x > 0)) return 0;  // also for NaN
  if (toneMap == ToneMap::Filmic) x = FilmicShoulder(x);
  return static_cast<unsigned char>(std::lround(255.0f * LinearToSrgb(std::min(x, 1.0f))));
}

Image::Image(int w, int h, std::vector<std::string> channelNames)
    : width(w),
      height(h),
      channels(std::move(channelNames)),
      data(static_cast<size_t>(w) * static_cast<size_t>(h) * channels.size(), 0.0f) {}

void AppendChannels(Image& image, const Image& more) {
  if (image.width != more.width || image.height != more.height) {
    const auto size = [](const Image& of) { return std::to_string(of.width) + "×" + std::to_string(of.height); };
    throw Error("layers of " + size(more) + " pixels do not belong to an image of " + size(image));
  }
  const size_t own = image.channels.size(), added = more.channels.size();
  std::vector<float> data;
  data.reserve(image.data.size() + more.data.size());
  for (size_t a = 0, b = 0; a < image.data.size(); a += own, b += added) {
    data.insert(data.end(), &image.data[a], &image.data[a] + own);
    data.insert(data.end(), &more.data[b], &more.data[b] + added);
  }
  image.data = std::move(data);
  image.channels.insert(image.channels.end(), more.channels.begin(), more.channels.end());
}

Image ChannelsOf(const Image& image, const std::vector<std::string>& names) {
  Image found(image.width, image.height, names);
  for (size_t c = 0; c < names.size(); ++c) {
    const int from = image.ChannelIndex(names[c]);
    if (from < 0) return {};
    for (size_t to = c, at = static_cast<size_t>(from); to < found.data.size();
         to += names.size(), at += image.channels.size())
      found.data[to] = image.data[at];
  }
  found.offsetX = image.offsetX;
  found.offsetY = image.offsetY;
  found.fullWidth = image.fullWidth;
  found.fullHeight = image.fullHeight;
  return found;
}

int Image::ChannelIndex(const std::string& name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

Color Image::RgbAt(int x, int y) const {
  const float* pixel = &data[(static_cast<size_t>(y) * width + x) * channels.size()];
  if (channels.size() >= 3 && channels[0] == "R" && channels[1] == "G" && channels[2] == "B") {
    return {pixel[0], pixel[1], pixel[2]};
  }
  const int r = ChannelIndex("R"), g = ChannelIndex("G"), b = ChannelIndex("B");
  if (r >= 0 && g >= 0 && b >= 0) return {pixel[r], pixel[g], pixel[b]};
  return Color(pixel[std::max(0, ChannelIndex("Y"))]);
}

bool Image::HasRgb() const {
  if (ChannelIndex("R") >= 0 && ChannelIndex("G") >= 0 && ChannelIndex("B") >= 0) return true;
  if (channels.size() == 1) return true;
  const auto has = [this](const char* name) { return ChannelIndex(name) >= 0; };
  const bool isXyz = has("X") && has("Z");                // Z alone is depth
  return has("Y") && !isXyz && !has("RY") && !has("BY");  // otherwise Y is a part of a colour
}

std::vector<size_t> ChannelOrder(const std::vector<std::string>& names) {
  const auto layerOf = [&](size_t i) {
    const size_t dot = names[i].rfind('.');
    return dot == std::string::npos ? std::string() : names[i].substr(0, dot);
  };
  const auto rankOf = [&](size_t i) {
    const std::string suffix = names[i].substr(names[i].rfind('.') + 1);  // npos + 1 is 0: the whole name
    const size_t rank = suffix.size() == 1 ? std::string("RGBA").find(suffix) : std::string::npos;
    return std::min<size_t>(rank, 4);
  };
  std::vector<size_t> order(names.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    const std::string layerA = layerOf(a), layerB = layerOf(b);
    if (layerA != layerB) return layerA < layerB;
    return rankOf(a) < rankOf(b);
  });
  return order;
}

void CheckImageSize(const std::filesystem::path& path, int64_t width, int64_t height, int64_t channels,
                    int64_t bytesPerPixel) {
  constexpr int64_t maxSide = int64_t{1} << 24, maxValues = int64_t{1} << 30, maxChannels = int64_t{1} << 18;
  constexpr int64_t alwaysFine = int64_t{1} << 27, largestCompression = 2000;
  const std::string claim =
      std::to_string(width) + " x " + std::to_string(height) + " pixels with " + std::to_string(channels) + " channels";
  if (width <= 0 || height <= 0 || channels <= 0) {
    throw Error("cannot read image \"" + path.string() + "\": it has no pixels (" + claim + ")");
  }
  if (width > maxSide || height > maxSide || channels > maxChannels || width * height > maxValues / channels) {
    throw Error("cannot read image \"" + path.string() + "\": too large (" + claim + ")");
  }
  const double needed = 4.0 * static_cast<double>(width * height * channels);
  const double available = static_cast<double>(AvailableMemory());
  if (needed > available) {
    throw Error("cannot read image \"" + path.string() + "\": its " + claim + " take " + FormatBytes(needed) +
                " of memory, and there are " + FormatBytes(available));
  }
  std::error_code code;
  const auto fileBytes = std::filesystem::file_size(path, code);
  const int64_t bytes = width * height * bytesPerPixel;
  const bool isLarge = width * height * channels > alwaysFine;
  if (!code && isLarge && bytes / largestCompression > static_cast<int64_t>(fileBytes)) {
    throw Error("cannot read image \"" + path.string() + "\": it claims " + claim + ", more than " +
                std::to_string(fileBytes) + " bytes can hold");
  }
}

Image ReadImage(const std::filesystem::path& path, ImageEncoding encoding) {
  CheckReadable(path);
  const ImageKind kind = FindImageKind(path);
  if (kind.format == kOpenExr) return ReadExr(path);
  EncodedImage encoded = ReadEncoded(path, kind);
  const bool automatic = encoded.integerBits == 8 || (encoded.integerBits > 0 && encoded.saysSrgb);
  const bool decode = encoding == ImageEncoding::Automatic ? automatic : encoding == ImageEncoding::Srgb;
  if (decode && encoded.integerBits > 0) {
    DecodeChannels(encoded, SrgbToLinear);
    encoded.image.colorGamma = 0;
  }
  return std::move(encoded.image);
}

Image ReadImageWithGamma(const std::filesystem::path& path, float gamma) {
  CheckReadable(path);
  const ImageKind kind = FindImageKind(path);
  if (kind.format == kOpenExr) return ReadExr(path);
  EncodedImage encoded = ReadEncoded(path, kind);
  if (encoded.integerBits > 0) {
    DecodeChannels(encoded, [gamma](float value) { return std::pow(std::max(value, 0.0f), gamma); });
    encoded.image.colorGamma = gamma;
  }
  return std::move(encoded.image);
}

std::vector<unsigned char> DisplayPixels(const Image& image, float exposureStops, ToneMap toneMap) {
  if (!image.HasRgb() || image.width <= 0 || image.height <= 0) throw Error("the image has no R, G and B channels");
  const float exposure = std::exp2(exposureStops);
  std::vector<unsigned char> rgb;
  rgb.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Color color = image.RgbAt(x, y);
      for (const float value : {color.r, color.g, color.b}) rgb.push_back(ToDisplay(value, exposure, toneMap));
    }
  }
  return rgb;
}

std::vector<unsigned char> EncodeForDisplay(const Image& image, float exposureStops, ToneMap toneMap) {
  return EncodePng(image.width, image.height, DisplayPixels(image, exposureStops, toneMap));
}

void WritePng(const std::filesystem::path& path, const Image& image, float exposureStops, ToneMap toneMap) {
  if (!image.HasRgb()) throw Error("cannot write \"" + path.string() + "\": the image has no R, G and B channels");
  const std::vector<unsigned char> bytes = EncodeForDisplay(image, exposureStops, toneMap);
  AtomicFile file(path);
  file.Write(bytes.data(), bytes.size());
  file.Commit();
}

}  // namespace lampyr
