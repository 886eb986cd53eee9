#include "integrators/bidirectional/path_densities.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;
const double kReach = std::tan(kPiDouble / 180);  // ρ over the distance

}  // namespace

Merging Merging::At(double radius, double distance, double lightPaths, double lightPathsPerSample, double filmPixels,
                    double probability, double radiusScale) {
  const double paths = probability * lightPaths / lightPathsPerSample;
  return {paths * kPiDouble * radius * radius,
          paths * radiusScale * radiusScale,
          kPiDouble * kReach * kReach * distance * distance,
          kReach * distance,
          lightPaths,
          lightPathsPerSample,
          filmPixels};
}

void PathDensities::Set(std::span<const SubpathDensities> light, std::span<const SubpathDensities> camera,
                        const Joint& joint, double emission, LightEnd::Extent extent, const Merging& merging) {
  const size_t n = light.size() + camera.size();
  if (vertices_.size() <= n) vertices_.resize(2 * n + 1);
  count_ = n;
  Vertex* const vertices = vertices_.data();
  for (size_t i = 0; i < light.size(); ++i) {
    const SubpathDensities& v = light[i];
    const auto volume = static_cast<double>(v.mergeVolume);
    vertices[i + 1] = {v.forward, v.reverse, 1, v.forwardIsDelta, v.reverseIsDelta, v.canMerge, v.isInMedium, volume};
  }
  for (size_t i = 0; i < camera.size(); ++i) {
    const SubpathDensities& v = camera[i];
    const auto volume = static_cast<double>(v.mergeVolume);
    vertices[n - i] = {v.reverse, v.forward, 1, v.reverseIsDelta, v.forwardIsDelta, v.canMerge, v.isInMedium, volume};
  }
  if (const size_t j = light.size(); j > 0) {
    Vertex& last = vertices[j];
    last.fromCamera = joint.light.last.value;
    last.cameraIsDelta = false;
    if (!joint.isMerged) {
      last.canMerge = joint.mergesAtLight;
      last.mergeVolume = joint.lightMergeVolume;
    }
    if (!joint.isMerged && j > 1) {
      vertices[j - 1].fromCamera = joint.light.previous.value;
      vertices[j - 1].cameraIsDelta = false;
    }
  }
  if (const size_t j = light.size() + 1; j <= n) {
    Vertex& last = vertices[j];
    last.fromLight = joint.camera.last.value;
    last.lightIsDelta = joint.lastCameraIsDelta;
    last.canMerge = joint.mergesAtCamera;
    last.mergeVolume = joint.cameraMergeVolume;
    if (j < n) {
      vertices[j + 1].fromLight = joint.camera.previous.value;
      vertices[j + 1].lightIsDelta = joint.previousCameraIsDelta;
    }
  }
  emission_ = emission;
  extent_ = extent;
  merging_ = merging;
  Correlate();
}

void PathDensities::Correlate() {
  const size_t n = count_;
  Vertex* const vertices = vertices_.data();
  if (n < 2) return;
  const double area = merging_.area, least = 1 / merging_.lightPaths;
  const double ball = 4. / 3 * area * merging_.radius;
  const double measures[2] = {area, ball};  // on a surface, in a medium
  const auto probability = [&measures](bool isDelta, bool isInMedium, double density) {
    return isDelta ? 1.0 : std::min(1.0, density * measures[isInMedium]);
  };
  // The direction of a light at infinity is found again within a degree.
  const double ofLight = extent_ == LightEnd::Extent::Surface ? area
                         : extent_ == LightEnd::Extent::Sky   ? kPiDouble * kReach * kReach
                                                              : 1.0;
  // P_L first, in the place of c.
  double light = probability(false, vertices[1].isInMedium, emission_ / merging_.lightPathsPerSample * ofLight);
  vertices[1].correlation = light;
  for (size_t i = 2; i < n; ++i) {
    light *= probability(vertices[i].lightIsDelta, vertices[i].isInMedium, vertices[i].fromLight);
    vertices[i].correlation = light;
  }
  double camera =
      probability(vertices[n].cameraIsDelta, vertices[n].isInMedium, vertices[n].fromCamera * merging_.filmPixels);
  for (size_t i = n - 1; i >= 1; --i) {
    camera *= probability(vertices[i].cameraIsDelta, vertices[i].isInMedium, vertices[i].fromCamera);
    light = vertices[i].correlation;
    const double either = camera + light - camera * light;
    vertices[i].correlation = either > 0 ? std::max(camera / either, least) : 1.0;
  }
}

double PathDensities::TowardsCamera(size_t i, double ratio) const {
  double sum = 0;
  for (;; ++i) {
    if (vertices_[i].canMerge) sum += Mis(ratio * PerDensityAt(i));
    if (i == count_) return sum;
    ratio *= vertices_[i + 1].fromLight / vertices_[i].fromCamera;
  }
}

double PathDensities::TowardsLight(size_t i, double ratio) const {
  double sum = 0;
  for (;; --i) {
    if (vertices_[i].canMerge) sum += Mis(ratio * PerDensityAt(i));
    if (i == 1) return sum;
    ratio *= vertices_[i - 1].fromCamera / vertices_[i].fromLight;
  }
}

size_t PathDensities::EndOfCamera(const PathEnds& ends) const {
  size_t i = count_;
  while (i > 0 && IsDelta(ends, i)) --i;
  return i > 0 && vertices_[i].canMerge ? i : 0;
}

// All densities over Π_(i≥1) B_i: those of s = 0 and s = 1 are the ends', that of s > 1 is emission · F_2 … F_(s-1) /
// (B_1 … B_(s-1)), and that of merging at vertex i the one of s = i + 1 times B_i N π r² c.
TechniqueSums PathDensities::Sums(const PathEnds& ends, size_t s, size_t mergedAt) const {
  const size_t n = count_;
  const auto isDelta = [&](size_t i) { return IsDelta(ends, i); };
  // First the density of the path's own technique, then the ratios of all others to it.
  double own = s == 0 ? ends.hit : s == 1 ? ends.direct : 0.0;
  double density = emission_ / vertices_[1].fromCamera;  // of s = 2
  for (size_t k = 2; k <= n + 1; ++k) {
    if (mergedAt > 0 ? k == mergedAt + 1 : k == s) {
      own = density * (mergedAt > 0 ? vertices_[mergedAt].fromCamera * WithoutCorrelation(vertices_[mergedAt])
                       : k == n + 1 ? ends.splatCount * (ends.isOfFlight ? ends.flightRatio : 1.0)
                                    : 1.0);
      break;
    }
    if (k <= n) density *= vertices_[k].fromLight / vertices_[k].fromCamera;
  }
  if (!(own > 0) || !std::isfinite(own)) return {};
  TechniqueSums sums;
  const size_t end = EndOfCamera(ends);
  // `last`: the last vertex of the camera subpath; 0: the light's point.
  const auto of = [&](TechniqueGroup group, size_t last) -> TechniqueSums::Group& {
    return sums.Of(last < end ? BeyondOf(group) : group);
  };
  sums.isBeyond = (mergedAt > 0 ? mergedAt : s) < end;
  of(TechniqueGroup::Hit, 0).Add(ends.hit / own);
  if (!isDelta(1)) of(TechniqueGroup::Next, 1).Add(ends.direct / own, NextEventCount(n));
  double ratio = emission_ / vertices_[1].fromCamera / own;
  for (size_t k = 2; k <= n + 1; ++k) {
    const Vertex& last = vertices_[k - 1];
    if (!isDelta(k - 1) && k <= n && !isDelta(k)) of(TechniqueGroup::Connect, k).Add(ratio);
    if (!isDelta(k - 1) && k == n + 1) {
      sums.Of(TechniqueGroup::Light).Add(ratio * ends.splatCount);
      sums.Of(TechniqueGroup::Light).Add(ratio * ends.splatCount * ends.flightRatio);
    }
    if (last.canMerge)
      of(TechniqueGroup::Merge, k - 1).Add(ratio * last.fromCamera * WithoutCorrelation(last) * last.correlation);
    if (k <= n) ratio *= vertices_[k].fromLight / vertices_[k].fromCamera;
  }
  return sums;
}

double PathDensities::ForLight(double technique) const {
  return TowardsCamera(1, emission_ / technique);
}

double PathDensities::ForConnection(size_t lightCount) const {
  double sum = TowardsLight(lightCount, vertices_[lightCount].fromCamera);
  if (lightCount < count_) sum += TowardsCamera(lightCount + 1, vertices_[lightCount + 1].fromLight);
  return sum;
}

double PathDensities::ForMerging(size_t i) const {
  double sum = 0;
  if (i > 1) sum += TowardsLight(i - 1, vertices_[i - 1].fromCamera / vertices_[i].fromLight);
  if (i < count_) sum += TowardsCamera(i + 1, vertices_[i + 1].fromLight / vertices_[i].fromCamera);
  return sum / Mis(PerDensityAt(i));
}

}  // namespace lampyr
