#include "integrators/bidirectional/full_path.h"

#include <algorithm>
#include <cmath>

#include "integrators/bidirectional/subpath_weights.h"
#include "integrators/bidirectional/weights.h"

namespace lampyr {

namespace {

// Densities of scattering at a vertex, towards either end of the path.
struct DirectionDensities {
  SolidAngleDensity toLight, toCamera;
};

// Densities from the BSDF, as the subpath that the vertex is of has them. Delta events have none; their coefficients
// are in the vertex.
DirectionDensities At(const PathVertex& vertex, bool isLight, const Vector3& toLight, const Vector3& toCamera) {
  if (isLight) {
    const BsdfEvaluation f = vertex.EvaluateBetween(toLight, toCamera, TransportMode::Importance);
    return {SolidAngleDensity(f.pdfReverse), SolidAngleDensity(f.pdfForward)};
  }
  const BsdfEvaluation f = vertex.EvaluateBetween(toCamera, toLight, TransportMode::Radiance);
  return {SolidAngleDensity(f.pdfForward), SolidAngleDensity(f.pdfReverse)};
}

SolidAnglePerArea EdgeBetween(const PathVertex& from, const PathVertex& to, const Vector3& direction) {
  const Vector3d way = Vector3d(to.point.position) - Vector3d(from.point.position);
  return EdgeDensity(to, direction, glm::dot(way, way));
}

// The vertices of both subpaths in one row, 1 … n from the light on, with their edges.
class VertexRow {
 public:
  explicit VertexRow(const ConnectedPath& path)
      // In a merged path the shared vertex is the camera's; the photon's vertex has the densities of its own subpath.
      : path_(path),
        ofLight_(path.light.size() - (path.isMerged ? 1 : 0)),
        photon_(path.isMerged ? &path.light.back() : nullptr) {
    for (const PathVertex& vertex : path.light.first(ofLight_)) vertices_.push_back(&vertex);
    for (size_t i = path.camera.size(); i > 0; --i) vertices_.push_back(&path.camera[i - 1]);
  }

  const PathVertex& operator[](size_t i) const { return *vertices_[i]; }
  size_t Count() const { return vertices_.size() - 1; }
  size_t OfLight() const { return ofLight_; }
  const PathVertex* Photon() const { return photon_; }
  // Vertex i; where the paths are merged, that of the photon.
  const PathVertex& AsOfLight(size_t i) const { return photon_ && i == ofLight_ + 1 ? *photon_ : *vertices_[i]; }

  Vector3 ToLight(size_t i) const { return i == 1 ? path_.toLight : DirectionTo(i, i - 1); }
  Vector3 ToCamera(size_t i) const { return i == Count() ? path_.toLens : DirectionTo(i, i + 1); }

  // Factor of media on the density of vertex `to`, a neighbour of vertex `i`, by a walk from there.
  double FactorTo(size_t i, size_t to) const {
    const bool here = IsOfLight(i), there = IsOfLight(to);
    if (here != there) return to < i ? path_.factors.forward : path_.factors.reverse;
    const bool isAhead = here == (to > i);  // on the way of the subpath of both
    return isAhead ? vertices_[to]->factors.forward : vertices_[i]->factors.reverse;
  }

  // Factors of the edge of vertex `i` from the camera's side.
  EdgeFactors Arrival(size_t i) const {
    if (i == Count()) return path_.lensFactors;
    if (IsOfLight(i) == IsOfLight(i + 1))
      return IsOfLight(i) ? vertices_[i + 1]->factors.Reversed() : vertices_[i]->factors;
    return photon_ ? photon_->factors.Reversed() : path_.factors;
  }
  // And from the light's side.
  EdgeFactors Departure(size_t i) const {
    if (i == 1) return path_.endFactors;
    if (IsOfLight(i) == IsOfLight(i - 1))
      return IsOfLight(i) ? vertices_[i]->factors : vertices_[i - 1]->factors.Reversed();
    return photon_ ? photon_->factors : path_.factors.Reversed();
  }

  // The vertex has an event on the path. The last vertex of a subpath is connected and has none, except where the
  // camera's has hit the light.
  bool HasEvent(size_t i) const {
    const bool isLast = IsOfLight(i) ? i == ofLight_ && !photon_ : i == ofLight_ + 1 && path_.s > 0;
    return !isLast;
  }
  DirectionDensities DensitiesAt(size_t i) const {
    const PathVertex& vertex = *vertices_[i];
    const bool isLight = IsOfLight(i);
    if (!HasEvent(i) || !vertex.scatteredDelta) return At(vertex, isLight, ToLight(i), ToCamera(i));
    DirectionDensities densities;
    densities.toLight = isLight ? vertex.eventReverse : vertex.eventForward;
    densities.toCamera = isLight ? vertex.eventForward : vertex.eventReverse;
    return densities;
  }

 private:
  bool IsOfLight(size_t i) const { return i <= ofLight_; }
  // Directions of the rays that were traced; for the connecting edge, from vertex to vertex.
  Vector3 DirectionTo(size_t i, size_t other) const {
    const PathVertex& vertex = *vertices_[i];
    if (photon_ && i == ofLight_ + 1 && other == ofLight_) return photon_->toPrevious;
    if (photon_ && i == ofLight_ && other == ofLight_ + 1) return -photon_->toPrevious;
    if (IsOfLight(i) && IsOfLight(other)) return other < i ? vertex.toPrevious : -vertices_[other]->toPrevious;
    if (!IsOfLight(i) && !IsOfLight(other)) return other > i ? vertex.toPrevious : -vertices_[other]->toPrevious;
    return glm::normalize(Vector3(Vector3d(vertices_[other]->point.position) - Vector3d(vertex.point.position)));
  }

  const ConnectedPath& path_;
  size_t ofLight_;
  const PathVertex* photon_;
  std::vector<const PathVertex*> vertices_ = {nullptr};
};

// All of a path but what its vertices say.
FullPath Ends(const ConnectedPath& path, const VertexRow& vertices) {
  const size_t n = vertices.Count();
  FullPath full;
  full.end = path.end;
  full.technique = path.isMerged     ? static_cast<int>(n + 1 + vertices.OfLight() + 1)
                   : path.isOfFlight ? static_cast<int>(2 * n + 2)
                                     : path.s;
  full.merging = path.merging;
  full.connectionCount = path.connectionCount;
  full.splatCount = path.splatCount;
  full.seenDensity = path.seenDensity;
  full.fromLight.assign(n + 2, AreaDensity());
  full.fromCamera.assign(n + 2, AreaDensity());
  full.isDelta.assign(n + 2, false);
  // All techniques but t = 1 have this density as a factor: where that one does not exist, any will do.
  const bool isConnected = path.atLens.value > 0;
  full.fromCamera[n] = isConnected ? path.atLens : AreaDensity(1);
  full.lensSeesIt = isConnected;
  full.gathers.assign(n + 2, true);
  full.isInMedium.assign(n + 2, false);
  full.mergeVolume.assign(n + 2, 0);
  if (n == 0) return full;
  full.mergesAtLens = vertices[n].isSeenByIndirect;
  full.lensSeesIt = isConnected && vertices[n].isSeenByIndirect;
  return full;
}

}  // namespace

int FirstWide(const FullPath& path) {
  int i = path.SurfaceCount();
  while (i > 0 && path.isDelta[static_cast<size_t>(i)]) --i;
  return i;
}

namespace {

// FlightPoints::RatioAt of the vertex that the camera sees, from the positions of the path.
double FlightRatioOf(const ConnectedPath& path, const VertexRow& vertices) {
  const size_t n = vertices.Count();
  if (!path.flightPoints || n == 0) return 0;
  const PathVertex& seen = vertices.AsOfLight(n);
  const double distance = n == 1 ? path.endDistance : glm::distance(seen.Position(), vertices[n - 1].Position());
  return path.flightPoints->RatioAt(seen, vertices.ToLight(n), distance, vertices.Departure(n).forward);
}

}  // namespace

FullPath Unfold(const ConnectedPath& path) {
  const VertexRow vertices(path);
  FullPath full = Ends(path, vertices);
  const size_t n = vertices.Count(), ofLight = vertices.OfLight();
  const PathVertex* photon = vertices.Photon();
  full.flightRatio = FlightRatioOf(path, vertices);
  for (size_t i = 1; i <= n; ++i) {
    const PathVertex& vertex = vertices[i];
    full.gathers[i] = vertex.GathersPhotons() || vertex.IsInMedium();
    full.isInMedium[i] = vertex.IsInMedium();
    const Vector3 toLight = vertices.ToLight(i), toCamera = vertices.ToCamera(i);
    full.mergeVolume[i] = MergeVolume(vertex, {toLight, vertices.Departure(i), i > 1 && vertices[i - 1].IsInMedium()},
                                      {toCamera, vertices.Arrival(i)}, *path.volume);
    full.isDelta[i] = vertices.HasEvent(i) && vertex.scatteredDelta;
    const DirectionDensities densities = vertices.DensitiesAt(i);
    full.fromCamera[i - 1] =
        densities.toLight * (i == 1 ? path.end.solidAnglePerArea
                                    : vertices.FactorTo(i, i - 1) * EdgeBetween(vertex, vertices[i - 1], toLight));
    if (i < n) {
      full.fromLight[i + 1] =
          densities.toCamera * (vertices.FactorTo(i, i + 1) * EdgeBetween(vertex, vertices[i + 1], toCamera));
    }
    if (photon && i == ofLight + 1) full.fromCamera[i - 1] = densities.toLight * photon->previousSolidAnglePerArea;
  }
  if (photon && ofLight > 0) full.fromLight[ofLight + 1] = photon->pdfForward;
  // A camera path may end at the first vertex from the camera whose event is no delta.
  if (const int first = FirstWide(full); first > 0 && full.CanEnd(first))
    full.fromCamera[static_cast<size_t>(first - 1)] = path.continuing * full.fromCamera[static_cast<size_t>(first - 1)];
  return full;
}

double PerDensityAt(const FullPath& path, int i) {
  const auto at = static_cast<size_t>(i);
  return path.isInMedium[at] ? path.merging.perVolumeDensity * path.mergeVolume[at] : path.merging.perDensity;
}

double CorrelationAt(const FullPath& path, int i) {
  const int n = path.SurfaceCount();
  if (i == n) return 1;
  const auto isDelta = [&](int k) { return k >= 1 && k <= n && path.isDelta[static_cast<size_t>(k)]; };
  const double area = path.merging.area, degree = std::tan(3.14159265358979323846 / 180);
  const auto around = [&](int k) {
    return path.isInMedium[static_cast<size_t>(k)] ? 4. / 3 * area * path.merging.radius : area;
  };
  double again = path.end.emission.value / path.merging.lightPathsPerSample * around(1);
  if (path.end.extent == LightEnd::Extent::Surface) again *= area;
  if (path.end.extent == LightEnd::Extent::Sky) again *= 3.14159265358979323846 * degree * degree;
  double light = std::min(1.0, again), camera = 1;
  for (int k = 2; k <= i; ++k)
    light *= isDelta(k - 1) ? 1.0 : std::min(1.0, path.fromLight[static_cast<size_t>(k)].value * around(k));
  for (int k = i; k <= n; ++k) {
    const double density =
        k == n ? path.seenDensity * path.merging.filmPixels : path.fromCamera[static_cast<size_t>(k)].value;
    camera *= isDelta(k + 1) ? 1.0 : std::min(1.0, density * around(k));
  }
  const double either = camera + light - camera * light;
  return either > 0 ? std::max(camera / either, 1 / path.merging.lightPaths) : 1;
}

std::vector<long double> ExplicitDensities(const FullPath& path) {
  const int n = path.SurfaceCount();
  std::vector<long double> densities(static_cast<size_t>(path.TechniqueCount()), 0.0L);
  const auto isDelta = [&](int i) { return static_cast<bool>(path.isDelta[static_cast<size_t>(i)]); };
  const auto fromLight = [&](int i) { return path.fromLight[static_cast<size_t>(i)].value; };
  const auto fromCamera = [&](int i) { return path.fromCamera[static_cast<size_t>(i)].value; };
  for (int s = 0; s <= n + 1; ++s) {
    // The connecting edge must not end at a delta.
    if (s == 0 && !path.end.canBeHit) continue;
    if (s > 1 && isDelta(s - 1)) continue;
    if (s > 0 && s <= n && isDelta(s)) continue;
    if (s == n + 1 && !path.lensSeesIt) continue;
    long double density = 1;
    if (s == 1)
      density = n == 0 ? path.end.position.value : path.end.direct.value * NextEventCount(static_cast<size_t>(n));
    if (s > 1) density = path.end.emission.value;
    for (int i = 2; i < s; ++i) density *= fromLight(i);
    for (int i = s; i <= n; ++i) density *= fromCamera(i);
    if (s > 1 && s <= n) density *= std::sqrt(path.connectionCount);
    if (s == n + 1) density *= path.splatCount;
    densities[static_cast<size_t>(s)] = density;
    if (s == n + 1 && n > 0) densities.back() = density * path.flightRatio;
  }
  for (int i = 1; i <= n; ++i) {
    if (!path.CanMerge(i)) continue;
    long double density = path.end.emission.value * PerDensityAt(path, i) * CorrelationAt(path, i);
    for (int k = 2; k <= i; ++k) density *= fromLight(k);
    for (int k = i; k <= n; ++k) density *= fromCamera(k);
    densities[static_cast<size_t>(n + 1 + i)] = density;
  }
  return densities;
}

std::vector<double> WeightsByDensities(const FullPath& path) {
  const std::vector<long double> densities = ExplicitDensities(path);
  long double sum = 0;
  for (const long double density : densities) sum += density * density;
  std::vector<double> weights;
  for (const long double density : densities) weights.push_back(static_cast<double>(density * density / sum));
  return weights;
}

TechniqueSums SumsByDensities(const FullPath& path) {
  const int n = path.SurfaceCount();
  const std::vector<long double> densities = ExplicitDensities(path);
  long double own = densities[static_cast<size_t>(path.technique)];
  const bool isOfFlight = path.technique > 2 * n + 1;
  if (path.technique > n + 1 && !isOfFlight) own /= CorrelationAt(path, path.technique - n - 1);
  const double nextCount = n > 0 ? NextEventCount(static_cast<size_t>(n)) : 1.0;
  if (path.technique == 1) own /= nextCount;
  TechniqueSums sums;
  const int end = FirstWide(path);
  for (int i = 0; i < path.TechniqueCount(); ++i) {
    const TechniqueGroup group = i == 0                        ? TechniqueGroup::Hit
                                 : i == 1                      ? TechniqueGroup::Next
                                 : i <= n                      ? TechniqueGroup::Connect
                                 : i == n + 1 || i > 2 * n + 1 ? TechniqueGroup::Light
                                                               : TechniqueGroup::Merge;
    const double count = i == 1 ? nextCount : 1.0;
    const int last = i <= n + 1 ? i : i > 2 * n + 1 ? n + 1 : i - n - 1;  // vertex of the camera subpath
    const bool isBeyond = end > 0 && path.CanEnd(end) && last < end;
    if (i == path.technique) sums.isBeyond = isBeyond;
    sums.Of(isBeyond ? BeyondOf(group) : group)
        .Add(static_cast<double>(densities[static_cast<size_t>(i)] / own) / count, count);
  }
  return sums;
}

namespace {

// Partial weights of both subpaths of a full path: [i] is that of vertex i as the last one of its subpath.
struct Carried {
  std::vector<PartialWeight> light, camera;
};

Carried Carry(const FullPath& path) {
  const int n = path.SurfaceCount();
  const auto F = [&](int i) { return i <= n ? path.fromLight[static_cast<size_t>(i)] : AreaDensity(); };
  const auto B = [&](int i) { return path.fromCamera[static_cast<size_t>(i)]; };
  const auto isDelta = [&](int i) { return static_cast<bool>(path.isDelta[static_cast<size_t>(i)]); };
  const auto size = static_cast<size_t>(n) + 1;
  Carried carried{std::vector<PartialWeight>(size), std::vector<PartialWeight>(size)};
  carried.light[1] = PartialWeight::AtFirstHit(path.end, true);
  for (int i = 2; i <= n; ++i) {
    const auto at = static_cast<size_t>(i);
    carried.light[at] = carried.light[at - 1].Next(isDelta(i - 1), F(i), B(i - 2));
  }
  carried.camera[size - 1] = PartialWeight::AtLens(B(n), path.lensSeesIt ? path.splatCount : 0.0);
  carried.camera[size - 1] = carried.camera[size - 1].WithFlights(path.flightRatio);
  for (int i = n - 1; i >= 1; --i) {
    const auto at = static_cast<size_t>(i);
    carried.camera[at] = carried.camera[at + 1].Next(isDelta(i + 1), B(i), F(i + 2));
  }
  return carried;
}

// The densities of the whole path, as those of a camera subpath.
PathDensities DensitiesOf(const FullPath& path) {
  const int n = path.SurfaceCount();
  const auto isDelta = [&](int i) { return i >= 1 && i <= n && path.isDelta[static_cast<size_t>(i)]; };
  std::vector<SubpathDensities> camera;
  for (int i = n; i >= 1; --i) {
    const auto at = static_cast<size_t>(i);
    camera.push_back({i == n ? path.seenDensity : path.fromCamera[at].value, path.fromLight[at].value,
                      WideFloat(path.mergeVolume[at]), isDelta(i + 1), path.CanMerge(i), isDelta(i - 1),
                      static_cast<bool>(path.isInMedium[at])});
  }
  Joint joint;
  joint.camera = {path.fromLight[1], n > 1 ? path.fromLight[2] : AreaDensity()};
  joint.mergesAtCamera = path.CanMerge(1);
  joint.cameraMergeVolume = path.mergeVolume[1];
  joint.previousCameraIsDelta = isDelta(1);
  PathDensities densities;
  densities.Set({}, camera, joint, path.end.emission.value, path.end.extent, path.merging);
  return densities;
}

}  // namespace

std::vector<double> WeightsByRecursion(const FullPath& path) {
  const int n = path.SurfaceCount();
  const auto F = [&](int i) { return i <= n ? path.fromLight[static_cast<size_t>(i)] : AreaDensity(); };
  const auto B = [&](int i) { return path.fromCamera[static_cast<size_t>(i)]; };
  const auto isDelta = [&](int i) { return static_cast<bool>(path.isDelta[static_cast<size_t>(i)]); };
  const LightEnd& end = path.end;
  const double connections = path.connectionCount;
  if (n == 0 && !path.lensSeesIt) return {1, 0, 0};
  if (n == 0) {
    return {SeenLightWeight(end.position, B(0), path.splatCount), SplatLightWeight(end.position, B(0), path.splatCount),
            0};
  }
  std::vector<double> weights(static_cast<size_t>(path.TechniqueCount()), 0.0);
  const Carried carried = Carry(path);
  const auto light = [&](int i) -> const PartialWeight& { return carried.light[static_cast<size_t>(i)]; };
  const auto camera = [&](int i) -> const PartialWeight& { return carried.camera[static_cast<size_t>(i)]; };
  const PathDensities whole = DensitiesOf(path);
  const double nextCount = NextEventCount(static_cast<size_t>(n));
  const auto of = [&](double merging) { return path.merging ? merging : 0.0; };
  const auto weigh = [&](int s) {
    if (s == 0)
      return HitWeight(end, camera(1), {isDelta(1), F(2)}, B(0), connections, nextCount,
                       of(whole.ForLight(B(0).value)));
    if (s == 1) {
      return NextEventWeight(end, camera(1), end.canBeHit ? B(0) : AreaDensity(), F(2), connections, nextCount,
                             of(whole.ForLight(end.direct.value)));
    }
    const double merging = of(whole.ForConnection(static_cast<size_t>(s - 1)));
    if (s == n + 1)
      return SplatWeight(light(n), {B(n), B(n - 1)}, connections, path.splatCount, merging, path.flightRatio, false);
    return ConnectWeight(light(s - 1), {B(s - 1), B(s - 2)}, camera(s), {F(s), F(s + 1)}, connections, merging);
  };
  for (int s = 0; s <= n + 1; ++s) {
    if (s == 0 && !end.canBeHit) continue;
    if (s > 1 && s <= n && connections == 0) continue;
    if ((s > 1 && isDelta(s - 1)) || (s > 0 && s <= n && isDelta(s)) || (s == n + 1 && !path.lensSeesIt)) continue;
    weights[static_cast<size_t>(s)] = weigh(s);
  }
  if (path.flightRatio > 0 && path.lensSeesIt && !isDelta(n)) {
    weights.back() = SplatWeight(light(n), {B(n), B(n - 1)}, connections, path.splatCount,
                                 of(whole.ForConnection(static_cast<size_t>(n))), path.flightRatio, true);
  }
  for (int i = 1; i <= n; ++i) {
    if (!path.CanMerge(i)) continue;
    const auto at = static_cast<size_t>(i);
    weights[static_cast<size_t>(n + 1 + i)] =
        MergeWeight(light(i).WithNextEvents(static_cast<size_t>(n)).BeforeReverse(B(i - 1)),
                    camera(i).BeforeReverse(F(i + 1)), whole.PerDensityAt(at), connections, whole.ForMerging(at));
  }
  return weights;
}

}  // namespace lampyr
