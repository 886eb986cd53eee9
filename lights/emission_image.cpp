#include "lights/emission_image.h"

#include "textures/texture_library.h"

namespace lampyr {

EmissionImage::EmissionImage(const ParameterList& parameters, const std::string& name, const LightBuildContext& build) {
  const std::string file = parameters.GetFile(name);
  if (file.empty()) return;
  const FileLocation where = parameters.WhereOf(name);
  if (!build.textures) throw Error(where, "no images can be read here: \"" + file + "\"");
  const auto read = build.textures->GetImage(file, ImageEncoding::Automatic, where);
  *this = EmissionImage(read, file, where, build.diagnostics);
  const auto converted = build.textures->InRec709(read, WhiteHandling::Keep);
  if (converted != read) *this = EmissionImage(converted, file, where, nullptr);
}

EmissionImage::EmissionImage(std::shared_ptr<const Image> image, const std::string& name, const FileLocation& where,
                             Diagnostics* diagnostics)
    : image_(std::move(image)) {
  const size_t channels = image_->channels.size();
  if (image_->width <= 0 || image_->height <= 0 || channels == 0)
    throw Error(where, "\"" + name + "\" is an empty image");
  data_ = image_->data.data();
  width_ = image_->width;
  height_ = image_->height;
  stride_ = channels;
  const int r = image_->ChannelIndex("R"), g = image_->ChannelIndex("G"), b = image_->ChannelIndex("B");
  if (r >= 0 && g >= 0 && b >= 0) {
    r_ = static_cast<size_t>(r);
    g_ = static_cast<size_t>(g);
    b_ = static_cast<size_t>(b);
  } else if (image_->HasRgb()) {  // gray
    r_ = g_ = b_ = static_cast<size_t>(std::max(0, image_->ChannelIndex("Y")));
  } else {
    throw Error(where, "\"" + name + "\" has neither R, G and B channels nor is it gray");
  }
  double sum[3] = {0, 0, 0};
  size_t unclean = 0;
  const size_t texels = static_cast<size_t>(width_) * image_->height;
  for (size_t i = 0; i < texels; ++i) {
    const float* texel = data_ + i * stride_;
    const float rgb[3] = {texel[r_], texel[g_], texel[b_]};
    bool clean = true;
    for (int c = 0; c < 3; ++c) {
      clean = clean && Clean(rgb[c]) == rgb[c];
      sum[c] += static_cast<double>(Clean(rgb[c]));
    }
    unclean += clean ? 0 : 1;
  }
  const double count = static_cast<double>(texels);
  mean_ = {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count), static_cast<float>(sum[2] / count)};
  if (unclean > 0 && diagnostics) {
    diagnostics->Warn(where, "\"" + name + "\": " + std::to_string(unclean) +
                                 " texels are negative, not a number, or 1e37 and more, and emit nothing");
  }
}

Color EmissionImage::OnSurface(const Point2& uv) const {
  const int height = image_->height;
  const float x = std::clamp(uv.x, 0.0f, 1.0f) * static_cast<float>(width_) - 0.5f;
  const float y = std::clamp(1 - uv.y, 0.0f, 1.0f) * static_cast<float>(height) - 0.5f;
  const float floorX = std::floor(x), floorY = std::floor(y);
  const int x0 = std::max(static_cast<int>(floorX), 0), x1 = std::min(static_cast<int>(floorX) + 1, width_ - 1);
  const int y0 = std::max(static_cast<int>(floorY), 0), y1 = std::min(static_cast<int>(floorY) + 1, height - 1);
  const float dx = x - floorX, dy = y - floorY;
  return Lerp(Lerp(Texel(x0, y0), Texel(x1, y0), dx), Lerp(Texel(x0, y1), Texel(x1, y1), dx), dy);
}

}  // namespace lampyr
