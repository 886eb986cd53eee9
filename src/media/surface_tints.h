// Transmittance of thin surfaces and cut-outs at the wavelengths of a pass. Each tint is upsampled separately, because
// the spectrum of two panes is the product of their spectra. GeometryScene has the tints in Rec. 709.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/geometry_scene.h"
#include "spectral/wavelengths.h"

namespace lampyr {

// Converts the transmittance of each crossing to the wavelengths.
void TuneCrossings(const Wavelengths& wavelengths, std::vector<Crossing>& crossings);

// The same for crossings that GeometryScene::Transmittance returned with the result `product`, which must not be 0.
// Returns their product, times that of the cut-outs, which are gray and not listed.
Color TunedTransmittance(const Wavelengths& wavelengths, const Color& product, std::vector<Crossing>& crossings);

// GeometryScene::Transmittance and GeometryScene::Intersect at the wavelengths.
Color TransmittanceAt(const Wavelengths& wavelengths, const GeometryScene& geometry, const Ray& ray, uint32_t kinds);
bool IntersectAt(const Wavelengths& wavelengths, const GeometryScene& geometry, const Ray& ray, uint32_t kinds,
                 RayHit& hit, Color& tint);

}  // namespace lampyr
