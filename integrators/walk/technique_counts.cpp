#include "integrators/walk/technique_counts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "scene/text_file.h"

namespace lampyr {

namespace {

UsedCounts Used(const TechniqueCounts& counts, const CountedTechniques& techniques, double connecting, double merging,
                double continuing) {
  return {techniques.lightPaths ? counts.LightPaths() : 0.0, techniques.connections ? connecting : 0.0,
          techniques.merging ? merging : 0.0, techniques.lightPaths ? continuing : 1.0, counts.lightSamples};
}

}  // namespace

FilmMask::FilmMask(int width, int height, const Point2& film, std::vector<float> values)
    : width_(width),
      height_(height),
      cellsPerPixel_(static_cast<float>(width) / film.x, static_cast<float>(height) / film.y),
      values_(std::move(values)) {}

double FilmMask::Mean() const {
  if (values_.empty()) return 1;
  return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
}

std::string TechniqueCounts::Describe(const std::string& integrator) const {
  std::string text = integrator;
  if (log2LightPaths > 0) text += ", " + std::to_string(1 << log2LightPaths) + " light paths for each camera path";
  if (log2LightPaths < 0) text += ", a light path for " + std::to_string(1 << -log2LightPaths) + " camera paths";
  if (startsWide) text += ", merging in wide discs at first";
  const double part = merging.Mean();
  if (part < 1) text += ", merging in " + std::to_string(std::lround(100 * part)) + " % of the picture";
  if (const double on = continuing.Mean(); on < 1)
    text += ", " + std::to_string(std::lround(100 * on)) +
            " % of camera paths continuing beyond their first vertex that is not smooth";
  if (lightSamples > 1) text += ", up to " + std::to_string(lightSamples) + " lights chosen at a vertex";
  return text;
}

UsedCounts TechniqueCounts::At(const Point2& film, const CountedTechniques& techniques) const {
  return Used(*this, techniques, static_cast<double>(connecting.At(film)), static_cast<double>(merging.At(film)),
              static_cast<double>(continuing.At(film)));
}

UsedCounts TechniqueCounts::Mean(const CountedTechniques& techniques) const {
  return Used(*this, techniques, connecting.Mean(), merging.Mean(), continuing.Mean());
}

std::string TechniqueCounts::Fingerprint() const {
  ContentHash hash;
  hash.Add(std::to_string(log2LightPaths));
  for (const FilmMask* mask : {&connecting, &merging, &continuing}) {
    // Without it the fingerprint is that of the two others.
    if (mask == &continuing && mask->Values().empty()) break;
    std::string bytes;  // of the values, little-endian
    for (const float value : mask->Values()) {
      const auto bits = std::bit_cast<uint32_t>(value);
      for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(bits >> (8 * byte) & 0xff);
    }
    hash.Add(bytes);
  }
  if (startsWide) hash.Add("wide");
  if (lightSamples != 1) hash.Add("lights " + std::to_string(lightSamples));
  return hash.Hex();
}

float FilmMask::Interpolate(const Point2& film) const {
  const float x = std::clamp(film.x * cellsPerPixel_.x - 0.5f, 0.0f, static_cast<float>(width_ - 1));
  const float y = std::clamp(film.y * cellsPerPixel_.y - 0.5f, 0.0f, static_cast<float>(height_ - 1));
  const int x0 = std::min(static_cast<int>(x), std::max(width_ - 2, 0)),
            y0 = std::min(static_cast<int>(y), std::max(height_ - 2, 0));
  const int x1 = std::min(x0 + 1, width_ - 1), y1 = std::min(y0 + 1, height_ - 1);
  const auto at = [this](int i, int j) { return values_[static_cast<size_t>(j) * static_cast<size_t>(width_) + i]; };
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  return std::clamp(std::lerp(std::lerp(at(x0, y0), at(x1, y0), u), std::lerp(at(x0, y1), at(x1, y1), u), v), 0.0f,
                    1.0f);
}

}  // namespace lampyr
