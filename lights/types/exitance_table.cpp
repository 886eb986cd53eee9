#include "lights/types/exitance_table.h"

namespace lampyr {

ExitanceTable::ExitanceTable(const SurfaceEmission& emission, const LightTransform& transform) {
  if (!emission.Shaped()) {
    values_.assign(1, emission.Exitance(transform, {0, 0, 1}));
    return;
  }
  for (int ring = 0; ring <= kRings; ++ring) {
    const float theta = kPi * static_cast<float>(ring) / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const Vector2 phi = CosSinTurns(static_cast<float>(sector) / kSectors);
      const float r = std::sin(theta);
      values_.push_back(emission.Exitance(transform, {r * phi.x, r * phi.y, std::cos(theta)}));
    }
  }
}

Color ExitanceTable::Interpolate(const Normal3& normal) const {
  const float ring = std::acos(std::clamp(normal.z, -1.0f, 1.0f)) * (kRings * kInvPi);
  float sector = std::atan2(normal.y, normal.x) * (0.5f * kSectors * kInvPi);
  if (sector < 0) sector += kSectors;
  const int i = std::clamp(static_cast<int>(ring), 0, kRings - 1), j = static_cast<int>(sector);
  const float s = ring - static_cast<float>(i), t = sector - static_cast<float>(j);
  const auto at = [&](int r, int c) { return values_[static_cast<size_t>(r * kSectors + c % kSectors)]; };
  return Lerp(Lerp(at(i, j), at(i, j + 1), t), Lerp(at(i + 1, j), at(i + 1, j + 1), t), s);
}

}  // namespace lampyr
