#include "geometry/medium_at.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lampyr {

namespace {

// Unit vectors far from each other, and from the axes and diagonals to which scenes are usually aligned.
constexpr std::array<Vector3, 3> kDirections = {Vector3(0.57735f, 0.31127f, 0.75483f),
                                                Vector3(-0.43021f, 0.82114f, -0.37496f),
                                                Vector3(0.23904f, -0.61237f, -0.75358f)};

// The first change of a ray whose medium in front is known; null: there is none.
const MediumChange* FirstToSay(const std::vector<MediumChange>& changes) {
  const auto said =
      std::find_if(changes.begin(), changes.end(), [](const auto& one) { return one.before != kSameMedium; });
  return said == changes.end() ? nullptr : &*said;
}

// The medium in front of the first change of a ray. With `ofBoundaries`, surfaces that stop light are ignored: an open
// surface is hit from both sides, whatever medium it declares on the other one.
std::optional<int32_t> FirstMedium(const std::vector<MediumChange>& changes, bool ofBoundaries) {
  for (const MediumChange& change : changes) {
    if (ofBoundaries && !change.isBoundary) return std::nullopt;
    if (change.before != kSameMedium) return change.before;
  }
  return std::nullopt;
}

// The medium that a ray ends in.
std::optional<int32_t> LastMedium(const std::vector<MediumChange>& changes) {
  for (auto change = changes.rbegin(); change != changes.rend(); ++change) {
    if (change->behind != kSameMedium) return change->behind;
  }
  return std::nullopt;
}

// The medium in which rays from `medium` end. Rays that are stopped do not count, unless all are: behind the floor of
// an open scene there is no sky.
std::optional<int32_t> ExteriorOf(std::span<const std::vector<MediumChange>> rays, int32_t medium) {
  const auto isFree = [](const std::vector<MediumChange>& changes) {
    return std::all_of(changes.begin(), changes.end(), [](const MediumChange& change) { return change.isBoundary; });
  };
  const bool anyIsFree = std::any_of(rays.begin(), rays.end(), isFree);
  std::optional<int32_t> exterior;
  for (const std::vector<MediumChange>& changes : rays) {
    if (anyIsFree && !isFree(changes)) continue;
    const int32_t last = LastMedium(changes).value_or(medium);
    if (exterior && *exterior != last) return std::nullopt;
    exterior = last;
  }
  return exterior;
}

}  // namespace

uint32_t BrokenLink(const std::vector<MediumChange>& changes, int32_t start) {
  int32_t behind = start;
  bool wasBoundary = false;
  for (const MediumChange& change : changes) {
    // A wall declared to be in water may extend into the air.
    if (change.isOpaque && !wasBoundary) break;
    if (behind != kSameMedium && change.before != kSameMedium && behind != change.before) return change.primitive;
    if (change.isOpaque) break;
    behind = change.behind;
    wasBoundary = change.isBoundary;
  }
  return kNoIndex;
}

std::vector<MediumChange> MediumChanges(const GeometryScene& geometry, const Ray& ray) {
  std::vector<MediumChange> changes;
  if (!geometry.HasBoundaries()) return changes;
  std::vector<Crossing> crossings;
  RayHit hit;
  geometry.Trace(ray, visibility::kMedia, hit, crossings);
  for (const Crossing& crossing : crossings) {
    const GeometryAttributes& attributes = geometry.Attributes(crossing.primitive);
    const int32_t before = crossing.entering ? attributes.outsideMedium : attributes.insideMedium;
    // A shared edge may be reported twice.
    if (!changes.empty() && changes.back().primitive == crossing.primitive && changes.back().before == before) continue;
    changes.push_back({crossing.primitive, before, crossing.medium, attributes.isBoundary, attributes.isOpaque});
  }
  return changes;
}

namespace {

// The changes on the first ray with a boundary, of rays to points all over the scene; empty if there is none.
std::vector<MediumChange> ChangesTowardsScene(const GeometryScene& geometry, const Point3& position, float time,
                                              const Normal3& normal) {
  if (!geometry.HasBoundaries()) return {};
  constexpr int kMost = 256;
  constexpr double kSteps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};  // [Roberts18] R3
  const Bounds3& bounds = geometry.GetBounds();
  for (int i = 0; i < kMost; ++i) {
    Point3 target;
    for (int axis = 0; axis < 3; ++axis) {
      const double u = 0.5 + i * kSteps[axis];
      target[axis] = glm::mix(bounds.min[axis], bounds.max[axis], static_cast<float>(u - std::floor(u)));
    }
    if (target == position || glm::dot(target - position, normal) < 0) continue;
    std::vector<MediumChange> changes =
        MediumChanges(geometry, {position, glm::normalize(target - position), kInfinity, time});
    if (FirstMedium(changes, true)) return changes;
  }
  return {};
}

using Changes = std::array<std::vector<MediumChange>, kDirections.size()>;

Changes ChangesAround(const GeometryScene& geometry, const Point3& position, float time, const Normal3& normal) {
  Changes changes;
  for (size_t i = 0; i < kDirections.size(); ++i) {
    const Vector3 direction = glm::dot(kDirections[i], normal) < 0 ? -kDirections[i] : kDirections[i];
    changes[i] = MediumChanges(geometry, {position, direction, kInfinity, time});
  }
  return changes;
}

// Result of the rays' votes. `ofBoundaries`: as for FirstMedium.
FoundMedium MediumSaidBy(const Changes& changes, bool ofBoundaries) {
  FoundMedium found;
  std::array<std::optional<int32_t>, kDirections.size()> said;
  for (size_t i = 0; i < said.size(); ++i) {
    said[i] = FirstMedium(changes[i], ofBoundaries);
    if (found.disputed == kNoIndex) found.disputed = BrokenLink(changes[i]);
  }
  if (said[1] && said[1] == said[2]) {
    found.medium = said[1];
  } else {
    for (size_t i = 0; i < said.size() && !found.medium; ++i) found.medium = said[i];
  }
  if (!found.medium) return found;
  found.isOfBoundary = ofBoundaries;
  for (size_t i = 0; i < said.size(); ++i) {
    if (said[i] && said[i] != found.medium) found.disputed = changes[i].front().primitive;
  }
  found.exterior = ExteriorOf(changes, *found.medium);
  return found;
}

FoundMedium Find(const GeometryScene& geometry, const Point3& position, float time, const Normal3& normal,
                 bool looksAround) {
  const Changes changes = ChangesAround(geometry, position, time, normal);
  FoundMedium found = MediumSaidBy(changes, true);
  if (!found.medium && looksAround) {
    const std::vector<MediumChange> towards = ChangesTowardsScene(geometry, position, time, normal);
    found.medium = FirstMedium(towards, true);
    found.isOfBoundary = found.medium.has_value();
    // The other rays are more informative about the surroundings of the scene: some of them leave it.
    const std::array all = {changes[0], changes[1], changes[2], towards};
    if (found.medium) found.exterior = ExteriorOf(all, *found.medium);
  }
  if (!found.medium) {
    found = MediumSaidBy(changes, false);
    found.isOfOpaque = found.medium && std::all_of(changes.begin(), changes.end(), [](const auto& ray) {
                         const MediumChange* said = FirstToSay(ray);
                         return !said || said->isOpaque;
                       });
  }
  found.isUnanimous = found.medium && std::all_of(changes.begin(), changes.end(), [&](const auto& ray) {
                        return FirstMedium(ray, false) == found.medium;
                      });
  return found;
}

}  // namespace

FoundMedium FindMedium(const GeometryScene& geometry, const Point3& position, float time, const Normal3& normal) {
  return Find(geometry, position, time, normal, false);
}

FoundMedium FindMediumAround(const GeometryScene& geometry, const Point3& position, float time, const Normal3& normal) {
  return Find(geometry, position, time, normal, true);
}

int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise) {
  return FirstMedium(MediumChanges(geometry, ray), false).value_or(otherwise);
}

int32_t MediumAlong(const GeometryScene& geometry, const Ray& ray, int32_t otherwise, int32_t stopped) {
  const std::vector<MediumChange> changes = MediumChanges(geometry, ray);
  const MediumChange* said = FirstToSay(changes);
  if (!said) return otherwise;
  if (!said->isOpaque) return said->before;
  const FoundMedium around = FindMedium(geometry, ray.origin, ray.time);
  return around.isOfOpaque ? stopped : around.medium.value_or(stopped);
}

int32_t MediumAt(const GeometryScene& geometry, const Point3& position, float time, int32_t otherwise) {
  return MediumAlong(geometry, {position, kDirections[0], kInfinity, time}, otherwise);
}

}  // namespace lampyr
