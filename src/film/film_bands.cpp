// Bands of the spectrum, which a film keeps in layers of three bands.
#include <algorithm>
#include <cstdio>

#include "film/film.h"

namespace lampyr {

int SpectralBands::Of(double wavelength) const {
  if (count == 0 || !(wavelength >= from && wavelength <= to)) return -1;
  return std::min(static_cast<int>((wavelength - from) / Width()), count - 1);
}

namespace {

constexpr const char* kBandPrefix = "S0.";  // of unpolarised, emitted light

std::string ChannelOfBand(const SpectralBands& bands, int band) {
  char text[32];
  std::snprintf(text, sizeof text, "%s%.3fnm", kBandPrefix, bands.from + (band + 0.5) * bands.Width());
  std::string name = text;
  std::replace(name.begin() + 3, name.end(), '.', ',');
  return name;
}

}  // namespace

std::vector<std::string> LayersOfBands(const SpectralBands& bands) {
  std::vector<std::string> layers;
  for (int band = 0; band < bands.count; ++band) {
    if (band % 3 == 0) {
      layers.push_back(ChannelOfBand(bands, band));
    } else {
      layers.back() += " " + ChannelOfBand(bands, band);
    }
  }
  return layers;
}

bool IsBandLayer(const std::string& layer) {
  return layer.starts_with(kBandPrefix);
}

void Film::AddToBands(int x, int y, const Color& value, float filterWeight) {
  LayerSum* sums = layerSums_.data() + Index(x, y) * layers_.size() + SplitLayers();
  const float lanes[3] = {value.r, value.g, value.b};
  for (int i = 0; i < 3; ++i) {
    if (lanes_.band[i] < 0) continue;
    const auto band = static_cast<size_t>(lanes_.band[i]);
    sums[band / 3][band % 3].Add(static_cast<double>(filterWeight) * static_cast<double>(lanes_.radiance[i]) *
                                 static_cast<double>(lanes[i]));
  }
}

SplatList::Lanes Film::LanesOfSplats() const {
  SplatList::Lanes lanes;
  for (int i = 0; i < 3; ++i) {
    if (lanes_.band[i] < 0) continue;
    lanes.layers[i] = static_cast<uint32_t>(SplitLayers()) + static_cast<uint32_t>(lanes_.band[i]) / 3;
    lanes.channels[i] = lanes_.band[i] % 3;
    lanes.factors[i] = lanes_.radiance[i];
  }
  return lanes;
}

// 0 for a band in which no pass had a wavelength.
double Film::BandScale(size_t band) const {
  return bandWeights_[band] > 0 ? static_cast<double>(whitePasses_) / bandWeights_[band] : 0.0;
}

}  // namespace lampyr
