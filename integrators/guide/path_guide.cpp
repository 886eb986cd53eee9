#include "integrators/guide/path_guide.h"

#include "base/byte_stream.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lampyr {

namespace {

// Events of either walk that a region has before it is divided.
constexpr size_t kMostInRegion = 1200;

MixtureFit FitTo(std::span<const GuideEvent> events) {
  if (events.empty()) return {};
  Vector3d sum(0.0);
  for (const GuideEvent& event : events) sum += Vector3d(event.position);
  return FitMixture(events, Point3(sum / static_cast<double>(events.size())));
}

}  // namespace

PathGuide::PathGuide(std::span<const PlacedEvent> ofCamera, std::span<const PlacedEvent> ofLight, int threads) {
  std::vector<RegionPoint> points;
  points.reserve(ofCamera.size() + ofLight.size());
  const auto add = [&points](std::span<const PlacedEvent> events, bool isOfLight) {
    for (size_t i = 0; i < events.size(); ++i)
      points.push_back({events[i].position, static_cast<uint32_t>(i), events[i].side, isOfLight});
  };
  add(ofCamera, false);
  add(ofLight, true);
  std::vector<std::span<const RegionPoint>> parts;  // by region
  tree_ = RegionTree(points, kMostInRegion, [&](std::span<const RegionPoint> part) { parts.push_back(part); });
  regions_.resize(parts.size());
  ParallelFor(static_cast<int>(parts.size()), threads, [&](int i) {
    std::vector<GuideEvent> camera, light;
    for (const RegionPoint& point : parts[static_cast<size_t>(i)]) {
      if (point.isOfSecond) {
        light.push_back(ofLight[point.index]);
      } else {
        camera.push_back(ofCamera[point.index]);
      }
    }
    regions_[static_cast<size_t>(i)] = {FitTo(camera), FitTo(light)};
  });
}

void PathGuide::Save(ByteWriter& bytes) const {
  tree_.Save(bytes);
  bytes.List(std::span(regions_));
}

void PathGuide::Load(ByteReader& bytes) {
  const auto refuse = [] { throw Error("it holds a guide that cannot be"); };
  if (!tree_.Load(bytes)) refuse();
  regions_ = bytes.List<GuideRegion>(RegionTree::kMostRegions);
  if (!tree_.IsOf(regions_.size())) refuse();
  for (const GuideRegion& region : regions_) {
    for (const MixtureFit* fit : {&region.radiance, &region.importance}) {
      if (!(fit->share >= 0 && fit->share <= kMostShare) || (fit->share > 0 && !fit->mixture.IsValid())) refuse();
    }
  }
}

}  // namespace lampyr
