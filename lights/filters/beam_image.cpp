#include "lights/filters/beam_image.h"

#include <cmath>

#include "lights/emission_image.h"
#include "lights/light_base.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

// Distance, in standard deviations, at which a Gaussian is cut off.
constexpr float kBlurReach = 3;
// Texels per standard deviation of a blurred image: a finer grid adds no detail.
constexpr float kBlurTexels = 16;
// Upper bound of tints and sums, which keeps them finite.
constexpr float kLargestFactor = 1e18f;

// The means over `count` equal parts of each of the lines, which lie `next` apart and have `size` entries `step` apart;
// the results lie one after the other.
std::vector<Color> Shrunk(const std::vector<Color>& from, int lines, size_t next, int size, size_t step, int count) {
  std::vector<Color> result(static_cast<size_t>(lines) * count);
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < count; ++i) {
      const double begin = static_cast<double>(i) * size / count, end = static_cast<double>(i + 1) * size / count;
      Color sum;
      for (int j = static_cast<int>(begin); j < size && j < end; ++j) {
        const double part = std::min(end, j + 1.0) - std::max(begin, static_cast<double>(j));
        sum += from[line * next + j * step] * static_cast<float>(part / (end - begin));
      }
      result[static_cast<size_t>(line) * count + i] = sum;
    }
  }
  return result;
}

}  // namespace

BeamImage::BeamImage(const ParameterList& parameters, const FilterBuildContext& build, const char* mode)
    : window_(ReadBeamWindow(parameters, mode)),
      tiles_(parameters.GetBool("tile", false)),
      fill_(ReadEmissionColor(parameters, "fill", Color(0.0f))) {
  const std::string file = parameters.GetFile("filename");
  const FileLocation where = parameters.WhereOf("filename");
  if (file.empty()) throw Error(where, parameters.Owner() + " needs a \"string filename\"");
  if (!build.textures) throw Error(where, "no images can be read here: \"" + file + "\"");
  const auto read = build.textures->GetImage(file, ImageEncoding::Automatic, where);
  EmissionImage image(read, file, where, build.diagnostics);
  const auto converted = build.textures->InRec709(read, WhiteHandling::Adapt);
  if (converted != read) image = EmissionImage(converted, file, where, nullptr);
  const Color tint = ReadEmissionColor(parameters, "tint");
  const auto get = [&](const char* name, double value) { return static_cast<float>(parameters.GetFloat(name, value)); };
  const float blur = get("blur", 0);
  const auto enough = [&](int size) {
    return blur > 0 ? static_cast<int>(std::min(std::ceil(kBlurTexels / blur), static_cast<float>(size))) : size;
  };
  const int width = enough(image.Width()), height = enough(image.Height());
  std::vector<Color> texels;
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      const Color texel = image.Texel(x, y) * tint;
      texels.emplace_back(std::min(texel.r, kLargestFactor), std::min(texel.g, kLargestFactor),
                          std::min(texel.b, kLargestFactor));
    }
  }
  if (width < image.Width())  // columns of the result follow each other row by row
    texels = Shrunk(texels, image.Height(), image.Width(), image.Width(), 1, width);
  if (height < image.Height()) {
    const std::vector<Color> columns = Shrunk(texels, width, 1, image.Height(), width, height);
    texels.resize(static_cast<size_t>(width) * height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        texels[static_cast<size_t>(y) * width + x] = columns[static_cast<size_t>(x) * height + y];
    }
  }
  texelsPerLength_ = {static_cast<float>(width) / get("width", 1), static_cast<float>(height) / get("height", 1)};
  const Vector2 sigma = blur * Vector2(width, height);
  const int marginX = tiles_ ? 0 : static_cast<int>(std::ceil(kBlurReach * sigma.x));
  const int marginY = tiles_ ? 0 : static_cast<int>(std::ceil(kBlurReach * sigma.y));
  width_ = width + 2 * marginX;
  height_ = height + 2 * marginY;
  middle_ = 0.5f * Vector2(width_, height_);
  texels_.assign(static_cast<size_t>(width_) * height_, fill_);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      texels_[static_cast<size_t>(y + marginY) * width_ + x + marginX] = texels[static_cast<size_t>(y) * width + x];
    }
  }
  if (sigma.x > 0) Blur(sigma.x, true);
  if (sigma.y > 0) Blur(sigma.y, false);
}

void BeamImage::Blur(float sigma, bool alongX) {
  const int reach = static_cast<int>(std::ceil(kBlurReach * sigma));
  std::vector<float> kernel(static_cast<size_t>(reach) + 1);
  float sum = 0;
  for (int i = 0; i <= reach; ++i) {
    kernel[i] = std::exp(-0.5f * Sqr(static_cast<float>(i) / sigma));
    sum += i == 0 ? kernel[i] : 2 * kernel[i];
  }
  const int count = alongX ? width_ : height_, lines = alongX ? height_ : width_;
  const size_t step = alongX ? 1 : static_cast<size_t>(width_), next = alongX ? static_cast<size_t>(width_) : 1;
  std::vector<Color> line(static_cast<size_t>(count));
  const auto at = [&](int i) {
    if (tiles_) return line[static_cast<size_t>(((i % count) + count) % count)];
    return i < 0 || i >= count ? fill_ : line[static_cast<size_t>(i)];
  };
  for (int l = 0; l < lines; ++l) {
    Color* first = texels_.data() + l * next;
    for (int i = 0; i < count; ++i) line[i] = first[i * step];
    for (int i = 0; i < count; ++i) {
      Color mean = kernel[0] * line[i];
      for (int k = 1; k <= reach; ++k) mean += kernel[k] * (at(i - k) + at(i + k));
      first[i * step] = mean / sum;
    }
  }
}

// Interpolates between the centres of texels. Without tiling, points beyond the rim get the fill.
Color BeamImage::Lookup(const Point2& place) const {
  float x = middle_.x + place.x * texelsPerLength_.x, y = middle_.y - place.y * texelsPerLength_.y;
  const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
  if (tiles_) {
    x -= std::floor(x / width) * width;
    y -= std::floor(y / height) * height;
  }
  if (!(x >= 0 && x <= width && y >= 0 && y <= height)) return fill_;
  x -= 0.5f;
  y -= 0.5f;
  const float floorX = std::floor(x), floorY = std::floor(y);
  int x0 = static_cast<int>(floorX), y0 = static_cast<int>(floorY);
  int x1 = x0 + 1, y1 = y0 + 1;
  if (tiles_) {
    x0 = x0 < 0 ? width_ - 1 : x0;
    y0 = y0 < 0 ? height_ - 1 : y0;
    x1 = x1 >= width_ ? x1 - width_ : x1;
    y1 = y1 >= height_ ? y1 - height_ : y1;
  }
  x0 = std::clamp(x0, 0, width_ - 1), x1 = std::clamp(x1, 0, width_ - 1);
  y0 = std::clamp(y0, 0, height_ - 1), y1 = std::clamp(y1, 0, height_ - 1);
  const float dx = x - floorX, dy = y - floorY;
  return Lerp(Lerp(Texel(x0, y0), Texel(x1, y0), dx), Lerp(Texel(x0, y1), Texel(x1, y1), dx), dy);
}

FilterType BeamImageType(const char* name, const char* help, const char* mode) {
  FilterType type;
  type.name = name;
  type.help = help;
  type.parameters = WithBeamParameters(
      mode,
      {
          {"filename", ParameterType::String, "", "\"\"", "", "the image"},
          {"width", ParameterType::Float, "", "1", "> 0", "of the image, along x"},
          {"height", ParameterType::Float, "", "1", "> 0", "of the image, along y"},
          {"tile", ParameterType::Bool, "", "false", "", "repeat the image over the whole plane"},
          {"fill", ParameterType::Rgb, "", "0 0 0", "", "outside of the image, and where light passes the plane by"},
          {"blur", ParameterType::Float, "", "0", "[0,1]",
           "standard deviation of a Gaussian that blurs the image, in parts of its size"},
          {"tint", ParameterType::Rgb, "", "1 1 1", "", "multiplies the image"},
      });
  type.create = [mode = std::string(mode)](const ParameterList& parameters,
                                           const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<FilterWith<BeamImage>>(parameters, build, BeamImage(parameters, build, mode.c_str()));
  };
  type.samples = {
      "\"string filename\" \"suite-texture.exr\" \"float width\" 1.2 \"rgb fill\" [ 0.3 0.1 0.2 ]",
      "\"string filename\" \"suite-texture.exr\" \"bool tile\" true \"float blur\" 0.1 \"rgb tint\" [ 1 0.6 0.3 ]"};
  return type;
}

}  // namespace lampyr
