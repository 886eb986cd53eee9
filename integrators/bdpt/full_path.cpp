#include "integrators/bdpt/full_path.h"

namespace lampyr {

namespace {

struct DirectionDensities {
  double toLight = 0, toCamera = 0;  // 1/sr
};

// Of the event at a vertex, by asking the BSDF; deltas cannot be asked.
DirectionDensities At(const PathVertex& vertex, const Vector3& toLight, const Vector3& toCamera) {
  const BsdfEvaluation f = vertex.bsdf.Evaluate(toCamera, toLight, TransportMode::Radiance);
  return {static_cast<double>(f.pdfForward.value), static_cast<double>(f.pdfReverse.value)};
}

double AreaAt(const PathVertex& to, const PathVertex& from, const Vector3& direction) {
  const Vector3d way = Vector3d(to.point.position) - Vector3d(from.point.position);
  return AreaPerSolidAngle(glm::dot(direction, to.bsdf.Ng()), glm::dot(way, way));
}

}  // namespace

FullPath Unfold(const ConnectedPath& path) {
  std::vector<const PathVertex*> vertices = {nullptr};
  // Where the subpaths merge, the vertex is the camera's; the photon's says how its own path came there.
  const size_t ofLight = path.light.size() - (path.isMerged ? 1 : 0);
  const PathVertex* photon = path.isMerged ? &path.light.back() : nullptr;
  for (const PathVertex& vertex : path.light.first(ofLight)) vertices.push_back(&vertex);
  for (size_t i = path.camera.size(); i > 0; --i) vertices.push_back(&path.camera[i - 1]);
  const size_t n = vertices.size() - 1;

  FullPath full;
  full.end = path.end;
  full.technique = path.isMerged ? static_cast<int>(n + 1 + ofLight + 1) : path.s;
  full.mergesPerDensity = path.mergesPerDensity;
  full.fromLight.assign(n + 2, 0.0);
  full.fromCamera.assign(n + 2, 0.0);
  full.isDelta.assign(n + 2, false);
  full.fromCamera[n] = path.cameraPerArea;
  if (n == 0) return full;
  full.lensSeesIt = vertices[n]->isSeenByIndirect && path.cameraPerArea > 0;
  for (size_t i = 1; i <= n; ++i) {
    const PathVertex& vertex = *vertices[i];
    // Along the rays that were traced; the edge that joins the subpaths goes from vertex to vertex.
    const auto directionTo = [&](size_t other) {
      if (photon && i == ofLight + 1 && other == ofLight) return photon->toPrevious;
      if (photon && i == ofLight && other == ofLight + 1) return -photon->toPrevious;
      if (i <= ofLight && other <= ofLight) return other < i ? vertex.toPrevious : -vertices[other]->toPrevious;
      if (i > ofLight && other > ofLight) return other > i ? vertex.toPrevious : -vertices[other]->toPrevious;
      return glm::normalize(Vector3(Vector3d(vertices[other]->point.position) - Vector3d(vertex.point.position)));
    };
    const Vector3 toLight = i == 1 ? path.toLight : directionTo(i - 1);
    const Vector3 toCamera = i == n ? path.toLens : directionTo(i + 1);
    // The last vertex of either subpath is joined to something else, but where the camera's has found the light.
    const bool isLight = i <= ofLight;
    const bool isLast = isLight ? i == ofLight && !photon : i == ofLight + 1 && path.s > 0;
    DirectionDensities densities;
    if (!isLast && vertex.scatteredDelta) {
      full.isDelta[i] = true;
      densities.toLight = isLight ? vertex.eventReverse : vertex.eventForward;
      densities.toCamera = isLight ? vertex.eventForward : vertex.eventReverse;
    } else {
      densities = At(vertex, toLight, toCamera);
    }
    full.fromCamera[i - 1] =
        densities.toLight * (i == 1 ? path.end.perSolidAngle : AreaAt(*vertices[i - 1], vertex, toLight));
    if (i < n) full.fromLight[i + 1] = densities.toCamera * AreaAt(*vertices[i + 1], vertex, toCamera);
    if (photon && i == ofLight + 1) full.fromCamera[i - 1] = densities.toLight * photon->previousPerSolidAngle;
  }
  if (photon && ofLight > 0) full.fromLight[ofLight + 1] = photon->pdfForward;
  return full;
}

std::vector<double> WeightsByDensities(const FullPath& path) {
  const int n = path.SurfaceCount();
  std::vector<long double> densities(static_cast<size_t>(path.TechniqueCount()), 0.0L);
  const auto isDelta = [&](int i) { return static_cast<bool>(path.isDelta[static_cast<size_t>(i)]); };
  for (int s = 0; s <= n + 1; ++s) {
    // The edge that joins the subpaths must not end in a delta.
    if (s == 0 && !path.end.canBeHit) continue;
    if (s > 1 && isDelta(s - 1)) continue;
    if (s > 0 && s <= n && isDelta(s)) continue;
    if (s == n + 1 && !path.lensSeesIt) continue;
    long double density = 1;
    if (s == 1) density = n == 0 ? path.end.position : path.end.direct;
    if (s > 1) density = path.end.emission;
    for (int i = 2; i < s; ++i) density *= path.fromLight[static_cast<size_t>(i)];
    for (int i = s; i <= n; ++i) density *= path.fromCamera[static_cast<size_t>(i)];
    densities[static_cast<size_t>(s)] = density;
  }
  for (int i = 1; i <= n; ++i) {
    if (!path.CanMerge(i)) continue;
    long double density = path.end.emission * path.mergesPerDensity;
    for (int k = 2; k <= i; ++k) density *= path.fromLight[static_cast<size_t>(k)];
    for (int k = i; k <= n; ++k) density *= path.fromCamera[static_cast<size_t>(k)];
    densities[static_cast<size_t>(n + 1 + i)] = density;
  }
  long double sum = 0;
  for (const long double density : densities) sum += density * density;
  std::vector<double> weights;
  for (const long double density : densities) weights.push_back(static_cast<double>(density * density / sum));
  return weights;
}

std::vector<double> WeightsByRecursion(const FullPath& path) {
  const int n = path.SurfaceCount();
  const auto F = [&](int i) { return path.fromLight[static_cast<size_t>(i)]; };
  const auto B = [&](int i) { return path.fromCamera[static_cast<size_t>(i)]; };
  const auto isDelta = [&](int i) { return static_cast<bool>(path.isDelta[static_cast<size_t>(i)]); };
  const LightEnd& end = path.end;
  const double merge = Mis(path.mergesPerDensity);
  const auto mergeAt = [&](int i) { return path.CanMerge(i) ? merge : 0.0; };
  std::vector<double> weights(static_cast<size_t>(path.TechniqueCount()), 0.0);
  if (n == 0) {
    const double ratio = Mis(end.position / B(0));
    weights[0] = 1 / (1 + ratio);
    weights[1] = ratio / (1 + ratio);
    return weights;
  }
  // Of vertex i as the end of either subpath.
  std::vector<PartialWeight> light(static_cast<size_t>(n) + 1), camera(static_cast<size_t>(n) + 1);
  const double perEmission = 1 / Mis(end.emission);
  light[1] = {Mis(end.direct) * perEmission, end.canBeHit ? perEmission : 0.0, 0.0};
  for (int i = 2; i <= n; ++i)
    light[static_cast<size_t>(i)] =
        light[static_cast<size_t>(i - 1)].Next(isDelta(i - 1), path.CanMerge(i - 1), F(i), B(i - 2));
  camera[static_cast<size_t>(n)] = {path.lensSeesIt ? 1 / Mis(B(n)) : 0.0, 0.0, 0.0};
  for (int i = n - 1; i >= 1; --i) {
    const double reverse = i + 2 <= n ? F(i + 2) : 0.0;
    camera[static_cast<size_t>(i)] =
        camera[static_cast<size_t>(i + 1)].Next(isDelta(i + 1), path.CanMerge(i + 1), B(i), reverse);
  }
  for (int s = 0; s <= n + 1; ++s) {
    if (s == 0 && !end.canBeHit) continue;
    if ((s > 1 && isDelta(s - 1)) || (s > 0 && s <= n && isDelta(s)) || (s == n + 1 && !path.lensSeesIt)) continue;
    double others;
    if (s == 0) {
      const PartialWeight atLight = camera[1].Next(isDelta(1), path.CanMerge(1), B(0), n > 1 ? F(2) : 0.0);
      others =
          (isDelta(1) ? 0.0 : Mis(end.direct / B(0))) + Mis(end.emission) * (atLight.earlier + merge * atLight.merging);
    } else if (s == 1) {
      const double hit = end.canBeHit ? Mis(B(0)) : 0.0;
      others = (hit + camera[1].Sum(end.emission, n > 1 ? F(2) : 0.0, mergeAt(1))) / Mis(end.direct);
    } else {
      others = light[static_cast<size_t>(s - 1)].Sum(B(s - 1), B(s - 2), mergeAt(s - 1));
      if (s <= n) others += camera[static_cast<size_t>(s)].Sum(F(s), s < n ? F(s + 1) : 0.0, mergeAt(s));
    }
    weights[static_cast<size_t>(s)] = 1 / (1 + others);
  }
  for (int i = 1; i <= n; ++i) {
    if (!path.CanMerge(i)) continue;
    const double before = light[static_cast<size_t>(i)].BeforeReverse(B(i - 1), merge) +
                          camera[static_cast<size_t>(i)].BeforeReverse(i < n ? F(i + 1) : 0.0, merge);
    weights[static_cast<size_t>(n + 1 + i)] = 1 / (1 + before / merge);
  }
  return weights;
}

}  // namespace lampyr
