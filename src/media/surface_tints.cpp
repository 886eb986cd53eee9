#include "media/surface_tints.h"

namespace lampyr {

namespace {

std::vector<Crossing>& CrossingsOfThread() {
  thread_local std::vector<Crossing> crossings;
  return crossings;
}

}  // namespace

void TuneCrossings(const Wavelengths& wavelengths, std::vector<Crossing>& crossings) {
  for (Crossing& crossing : crossings) crossing.transmittance = wavelengths.FromRgb(crossing.transmittance);
}

Color TunedTransmittance(const Wavelengths& wavelengths, const Color& product, std::vector<Crossing>& crossings) {
  const float cutOuts = product.Max() / Transmittance(crossings).Max();
  TuneCrossings(wavelengths, crossings);
  return cutOuts * Transmittance(crossings);
}

Color TransmittanceAt(const Wavelengths& wavelengths, const GeometryScene& geometry, const Ray& ray, uint32_t kinds) {
  std::vector<Crossing>& crossings = CrossingsOfThread();
  const Color product = geometry.Transmittance(ray, kinds, crossings);
  return product.IsBlack() ? product : TunedTransmittance(wavelengths, product, crossings);
}

bool IntersectAt(const Wavelengths& wavelengths, const GeometryScene& geometry, const Ray& ray, uint32_t kinds,
                 RayHit& hit, Color& tint) {
  std::vector<Crossing>& crossings = CrossingsOfThread();
  const bool isHit = geometry.Intersect(ray, kinds, hit, tint, crossings);
  if (!crossings.empty()) {
    TuneCrossings(wavelengths, crossings);
    tint = Transmittance(crossings);
  }
  return isHit;
}

}  // namespace lampyr
