// Emission from infinity: photons start on a disk of the radius of the scene's bounding sphere, perpendicular to their
// direction and touching the sphere on the light's side ([Veach97 §8.3.2]).
#pragma once

#include "lights/light.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

// The receiver of a sky's light (LightContext::receiverNormal), in the local space of the sky. Without a normal its
// directions are sampled like those of photons.
struct SkyReceiver {
  Vector3 normal{0.0f};  // unit, or 0
  bool isTransmissive = false;

  bool HasNormal() const { return LengthSquared(normal) > 0; }
};

// Estimated mean of max(0, cosθ), or of |cosθ| where light counts from both sides, over directions that spread around a
// mean m: `cosine` is n · m, `variance` is 1 - |m|². The same estimate as in light selection (selection/importance.h).
inline float MeanCosine(float cosine, float variance, bool bothSides) {
  const float root = std::sqrt(cosine * cosine + 0.25f * variance);
  return bothSides ? root : 0.5f * (root + cosine);
}

// Radiance of a sky in a direction, and the density of sampling that direction: of a photon, and of a sample for a
// receiver.
struct SkyPoint {
  Color radiance;
  PdfSolidAngle density;
  PdfSolidAngle densityDirect;
};

// A direction sampled by a sky, in its local space. `isInside`: radiance and density are constant within the rounding
// of the direction, so that `seen` is valid and no second lookup is needed.
struct SkySample {
  Vector3 local{0.0f};
  SkyPoint seen{Color(0.0f), PdfSolidAngle(0), PdfSolidAngle(0)};
  bool isInside = false;
};

// 1/m²; uniform on the disk.
inline PdfArea EmissionDiskDensity(const BoundingSphere& scene) {
  return PdfArea(1 / (kPi * Sqr(scene.radius)));
}

inline float EmissionDiskArea(const BoundingSphere& scene) {
  return kPi * Sqr(scene.radius);
}

// A point of the disk that faces the light in the unit direction `toLight`. The frame is built from that very
// direction.
inline Point3 SampleEmissionDisk(const BoundingSphere& scene, const Vector3& toLight, const Point2& u) {
  const Point2 disk = SampleConcentricDisk(u);
  const Frame frame = Frame::FromNormal(toLight);
  return scene.center + scene.radius * (frame.x * disk.x + frame.y * disk.y + toLight);
}

inline Vector3 EmissionDiskError(const BoundingSphere& scene) {
  constexpr float kRelativeError = 8 * 0x1p-24f;
  return kRelativeError * (Abs(scene.center) + Vector3(2 * scene.radius));
}

// A photon in direction -toLight. The caller sets colours and the density of the direction.
inline EmissionSample EmitFromInfinity(const BoundingSphere& scene, const Vector3& toLight, const Point2& u) {
  EmissionSample sample;
  sample.position = SampleEmissionDisk(scene, toLight, u);
  sample.positionError = EmissionDiskError(scene);
  sample.direction = -toLight;
  sample.normal = -toLight;
  sample.pdfEmit = EmissionDiskDensity(scene);
  return sample;
}

}  // namespace lampyr
