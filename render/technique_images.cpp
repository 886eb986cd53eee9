#include "render/technique_images.h"

#include <algorithm>

namespace lampyr {

namespace {

bool HasSplats(int t) {
  return t <= 1;
}

}  // namespace

TechniqueImages::TechniqueImages(int width, int height, const PixelRect& crop, int maxDepth)
    : width_(width), height_(height), crop_(crop), mostEvents_(std::min(maxDepth, kMostEvents)) {
  for (int events = 0; events <= mostEvents_; ++events) {
    for (int s = 0; s <= events + 1; ++s) techniques_.push_back(MakeTechnique(s, events + 2 - s));
  }
  techniques_.push_back(MakeTechnique(-1, 0));
}

TechniqueImages TechniqueImages::EmptyCopy() const {
  return {width_, height_, crop_, mostEvents_};
}

TechniqueImages::Technique TechniqueImages::MakeTechnique(int s, int t) const {
  Technique technique;
  technique.s = s;
  technique.t = t;
  const auto values = 3 * static_cast<size_t>(crop_.Width()) * static_cast<size_t>(crop_.Height());
  technique.weighted.assign(values, 0.0);
  technique.unweighted.assign(values, 0.0);
  if (HasSplats(t)) {
    technique.weightedSplats = Film(width_, height_, crop_);
    technique.unweightedSplats = Film(width_, height_, crop_);
  }
  return technique;
}

uint64_t TechniqueImages::BytesPerPixel(int maxDepth) {
  const auto events = static_cast<uint64_t>(std::min(maxDepth, kMostEvents));
  const uint64_t techniques = (events + 1) * (events + 4) / 2 + 1, withSplats = events + 2;
  return techniques * 6 * sizeof(double) + withSplats * 2 * (sizeof(PixelSums) + sizeof(SplatSums));
}

// Techniques of paths with n events come after the 2 + 3 + … + (n + 1) techniques of shorter paths.
size_t TechniqueImages::IndexOf(int s, int t) const {
  const int events = s + t - 2;
  if (events > mostEvents_) return techniques_.size() - 1;
  return static_cast<size_t>(events * (events + 3) / 2 + s);
}

TechniqueImages::Recorder::Recorder(TechniqueImages& images, const PixelFilter& filter, const SensorResponse& sensor)
    : images_(&images), sensor_(sensor) {
  for (const Technique& technique : images.techniques_) {
    const SplatList none({0, 0}, {0, 0}, 1);
    const bool has = technique.weightedSplats.has_value();
    weighted_.push_back(has ? technique.weightedSplats->MakeSplatList(filter, sensor_) : none);
    unweighted_.push_back(weighted_.back());
  }
}

void TechniqueImages::Recorder::StartSample(int x, int y, float scale) {
  x_ = x;
  y_ = y;
  scale_ = scale;
  for (auto* lists : {&weighted_, &unweighted_}) {
    for (SplatList& list : *lists) list.StartPath();
  }
}

void TechniqueImages::Recorder::Observe(const ConnectedPath& path) {
  const size_t index = images_->IndexOf(path.s, path.t);
  const Color weighted = path.value * static_cast<float>(path.weight);
  if (path.connection) {
    lampyr::AddSplats(*path.connection, weighted, weighted_[index]);
    lampyr::AddSplats(*path.connection, path.value, unweighted_[index]);
    return;
  }
  Technique& technique = images_->techniques_[index];
  const PixelRect& crop = images_->crop_;
  const auto pixel =
      3 * (static_cast<size_t>(y_ - crop.y0) * static_cast<size_t>(crop.Width()) + static_cast<size_t>(x_ - crop.x0));
  const auto add = [&](std::vector<double>& sums, const Color& value) {
    const Color balanced = sensor_.Balance(value);
    sums[pixel] += static_cast<double>(scale_ * balanced.r);
    sums[pixel + 1] += static_cast<double>(scale_ * balanced.g);
    sums[pixel + 2] += static_cast<double>(scale_ * balanced.b);
  };
  add(technique.weighted, weighted);
  add(technique.unweighted, path.value);
}

void TechniqueImages::AddSplats(const PixelFilter& filter, std::vector<Recorder>& recorders, int threads) {
  std::vector<SplatList> lists;
  for (size_t i = 0; i < techniques_.size(); ++i) {
    if (!techniques_[i].weightedSplats) continue;
    for (const bool isWeighted : {true, false}) {
      lists.clear();
      for (Recorder& recorder : recorders) {
        SplatList& list = (isWeighted ? recorder.weighted_ : recorder.unweighted_)[i];
        lists.push_back(list);
        list.Clear();
      }
      (isWeighted ? techniques_[i].weightedSplats : techniques_[i].unweightedSplats)->AddSplats(filter, lists, threads);
    }
  }
}

std::vector<TechniqueImages::Picture> TechniqueImages::Develop(const Film& film) const {
  std::vector<Picture> pictures;
  for (const Technique& technique : techniques_) {
    Picture picture;
    picture.name = technique.s < 0 ? "longer" : "s" + std::to_string(technique.s) + "-t" + std::to_string(technique.t);
    const auto develop = [&](const std::vector<double>& sums, const std::optional<Film>& splats) {
      Image image(crop_.Width(), crop_.Height(), {"R", "G", "B"});
      const Image splatted = splats ? splats->Develop() : Image();
      for (int y = 0; y < crop_.Height(); ++y) {
        for (int x = 0; x < crop_.Width(); ++x) {
          const double weight = film.Pixel(crop_.x0 + x, crop_.y0 + y).weight.Value();
          for (size_t c = 0; c < 3; ++c) {
            const size_t i =
                3 * (static_cast<size_t>(y) * static_cast<size_t>(crop_.Width()) + static_cast<size_t>(x)) + c;
            const double value = weight != 0 ? sums[i] / weight : 0.0;
            image.data[i] = static_cast<float>(value) + (splats ? splatted.At(x, y, c) : 0.0f);
          }
        }
      }
      return image;
    };
    picture.weighted = develop(technique.weighted, technique.weightedSplats);
    picture.unweighted = develop(technique.unweighted, technique.unweightedSplats);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace lampyr
