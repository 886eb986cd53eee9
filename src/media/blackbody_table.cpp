#include "media/blackbody_table.h"

#include <cmath>

#include "scene/spectrum.h"

namespace lampyr {

namespace {

constexpr int kEntries = 768;

float LogRange() {
  return std::log(kHottestGas / kColdestGlow);
}

}  // namespace

const BlackbodyTable& BlackbodyTable::Get() {
  static const BlackbodyTable table;
  return table;
}

BlackbodyTable::BlackbodyTable() : entries_(kEntries) {
  for (int i = 0; i < kEntries; ++i) {
    const double part = static_cast<double>(i) / (kEntries - 1);
    const double kelvin = static_cast<double>(kColdestGlow) * std::exp(part * static_cast<double>(LogRange()));
    const Color light = NormalizedBlackbody(kelvin);
    // Below 200 K, the light is less than the smallest float.
    const float luminance = std::max(light.Luminance(), 1e-37f);
    entries_[static_cast<size_t>(i)] = {std::log(luminance), light / luminance};
  }
}

Color BlackbodyTable::At(float kelvin) const {
  if (!(kelvin > kColdestGlow)) return Color(0.0f);
  const float position = std::log(std::min(kelvin, kHottestGas) / kColdestGlow) / LogRange() * (kEntries - 1);
  const size_t low = std::min(static_cast<size_t>(position), static_cast<size_t>(kEntries - 2));
  const float part = position - static_cast<float>(low);
  const Entry &a = entries_[low], &b = entries_[low + 1];
  return Lerp(a.color, b.color, part) * std::exp(a.logLuminance + part * (b.logLuminance - a.logLuminance));
}

}  // namespace lampyr
