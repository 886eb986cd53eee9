#include "render/build/scene_media.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

SceneMedia::SceneMedia(const SceneDescription& description, Diagnostics& diagnostics)
    : description_(description), diagnostics_(diagnostics) {
  for (const MediumDescription& medium : description.media)
    indices_.emplace(medium.name, static_cast<int32_t>(indices_.size()));
}

int32_t SceneMedia::IndexOf(const std::string& name, const FileLocation& where) const {
  if (name.empty()) return kVacuum;
  const auto found = indices_.find(name);
  if (found != indices_.end()) return found->second;
  std::vector<std::string> names;
  for (const MediumDescription& medium : description_.media) names.push_back(medium.name);
  throw Error(where, "there is no medium \"" + name + "\"" + DidYouMean(name, names));
}

void SceneMedia::SetSides(const ShapeDescription& shape, GeometryAttributes& attributes) const {
  if (shape.insideMedium == shape.outsideMedium) return;
  attributes.insideMedium = IndexOf(shape.insideMedium, shape.shape.where);
  attributes.outsideMedium = IndexOf(shape.outsideMedium, shape.shape.where);
}

void SceneMedia::NumberPlaces(const GeometryDescription& geometry) {
  std::vector<size_t> first = {geometry.entries.size()};
  for (const GeometryObject& object : geometry.objects) first.push_back(first.back() + object.entries.size());
  for (const Place& place : places_) {
    const size_t primitive = place.object < 0 ? place.entry : first[static_cast<size_t>(place.object)] + place.entry;
    primitivePlaces_.emplace(static_cast<uint32_t>(primitive), place.where);
  }
  places_.clear();
}

void SceneMedia::AddAreaLight(size_t light, const GeometryAttributes& attributes, const ShapeDescription& shape) {
  if (SeparatesMedia(attributes)) {
    areaLights_[light] = {attributes.outsideMedium, attributes.insideMedium};
  } else if (!shape.outsideMedium.empty()) {
    areaLightNames_[light] = shape.outsideMedium;
  }
}

std::string SceneMedia::NameOf(int32_t medium) const {
  return medium < 0 ? "vacuum" : "the medium \"" + description_.media[static_cast<size_t>(medium)].name + "\"";
}

// The medium of something that the file says to be in `name`, in messages "the camera" or "the light".
int32_t SceneMedia::Choose(const std::string& what, const FileLocation& where, const std::string& name,
                           const FoundMedium& found, int32_t otherwise) {
  const int32_t said = name.empty() ? kVacuum : IndexOf(name, where);
  const bool isContradicted = !name.empty() && found.isUnanimous && found.isOfBoundary && *found.medium != said;
  const int32_t medium = name.empty() || isContradicted ? found.medium.value_or(otherwise) : said;
  if (isContradicted) {
    diagnostics_.Warn(where, what + " is in " + NameOf(medium) + " by the surfaces around it, not in " + NameOf(said) +
                                 " as the MediumInterface before it says: it is taken to be where it is");
  }
  WarnOfDispute(found.disputed, where, what, medium);
  return medium;
}

// Once. `primitive`: FoundMedium::disputed.
void SceneMedia::WarnOfDispute(uint32_t primitive, const FileLocation& where, const std::string& what, int32_t medium) {
  if (primitive == kNoIndex || hasWarnedOfDispute_) return;
  hasWarnedOfDispute_ = true;
  const auto place = primitivePlaces_.find(primitive);
  diagnostics_.Warn(place == primitivePlaces_.end() ? where : place->second,
                    "the media on the sides of this shape and of others contradict each other: they overlap, are "
                    "open, or a MediumInterface is missing. Seen from " +
                        what + ", which is taken to be in " + NameOf(medium));
}

namespace {

// A point of the light, or on it, from where it shines.
struct LightPoint {
  Point3 position;
  Normal3 normal{0.0f};  // of a surface, to the side that is lit; otherwise 0
};

std::optional<LightPoint> PointOf(const PlacedLight& placed, const BoundingSphere& scene, const Point2& u) {
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  context.u = u;
  context.uDirection = u;
  const std::optional<EmissionSample> emission = placed.light->GenerateEmission(context);
  if (!emission) return std::nullopt;
  LightPoint point{emission->position};
  if (placed.light->Kind() == LightKind::Area)
    point.normal = glm::dot(emission->direction, emission->normal) < 0 ? -emission->normal : emission->normal;
  return point;
}

// Points of a surface that shines, at which the medium is looked for. Where the box of a boundary meets that of the
// light, they are as many as kPointsOfAll allows for all such lights together: it may cut a small part of a long lamp.
constexpr int kFewestPoints = 6, kMostPoints = 1 << 10, kPointsOfAll = 1 << 15;

Point2 LightPointAt(int i) {
  constexpr double kSteps[2] = {0.7548776662466927, 0.5698402909980532};  // [Roberts18] R2
  const auto at = [&](int axis) { return 0.47 + i * kSteps[axis]; };
  return Point2(static_cast<float>(at(0) - std::floor(at(0))), static_cast<float>(at(1) - std::floor(at(1))));
}

bool MeetsBoundary(const PlacedLight& placed, const BoundingSphere& scene, const std::vector<Bounds3>& boundaries) {
  if (placed.light->Kind() != LightKind::Area) return false;
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  const std::optional<EmissionBounds> emission = placed.light->GetEmissionBounds(context);
  return std::any_of(boundaries.begin(), boundaries.end(), [&](const Bounds3& boundary) {
    if (!emission) return true;
    for (int axis = 0; axis < 3; ++axis)
      if (boundary.min[axis] > emission->box.max[axis] || emission->box.min[axis] > boundary.max[axis]) return false;
    return true;
  });
}

}  // namespace

SceneMedia::Sides SceneMedia::MediaOfLight(const RenderScene& scene, size_t light, const FileLocation& where,
                                           int32_t exterior, int points) {
  const auto separates = areaLights_.find(light);
  if (separates != areaLights_.end()) return separates->second;
  const PlacedLight& placed = scene.lighting->Lights()[light];
  if (IsAtInfinity(placed.light->Kind())) return {exterior, exterior};
  const auto said = areaLightNames_.find(light);
  const std::string name = said != areaLightNames_.end()        ? said->second
                           : light < description_.lights.size() ? description_.lights[light].mediumName
                                                                : "";
  const int32_t otherwise = name.empty() ? exterior : IndexOf(name, where);
  if (!scene.geometry->HasBoundaries()) {  // all of the scene is in one medium
    if (otherwise != exterior && !hasWarnedOfDispute_) {
      hasWarnedOfDispute_ = true;
      diagnostics_.Warn(where, "the light is said to be in " + NameOf(otherwise) + " and the camera in " +
                                   NameOf(exterior) +
                                   ", but no surface separates the two: all of the scene is taken to be in " +
                                   NameOf(exterior) + ". A MediumInterface before the Camera says what it is in");
    }
    return {exterior, exterior};
  }
  std::optional<int32_t> medium;
  bool startsVary = false;
  for (int i = 0; i < points && !startsVary; ++i) {
    const auto point = PointOf(placed, scene.lighting->SceneSphere(), LightPointAt(i));
    if (!point) continue;
    // Around the first one only: a boundary that the light meets is near the others, too.
    const FoundMedium found =
        (medium ? FindMedium : FindMediumAround)(*scene.geometry, point->position, 0, point->normal);
    if (!medium) {
      medium = Choose("the light", where, name, found, exterior);
      startsVary = scene.hasMotion && found.disputed == kNoIndex;
      if (placed.light->Kind() != LightKind::Area) break;
    } else {
      startsVary = found.disputed == kNoIndex && found.medium.value_or(otherwise) != *medium;
    }
  }
  const int32_t chosen = medium.value_or(otherwise);
  return {chosen, chosen, startsVary};
}

namespace {

struct CameraStarts {
  bool vary = false;  // some start in another medium than RenderScene::cameraMedium, or may while something moves
  uint32_t disputed = kNoIndex;  // as of FoundMedium, of the surfaces that the camera sees
};

CameraStarts LookFrom(const RenderScene& scene, const Point2& middle, int32_t exterior) {
  CameraStarts starts;
  if (!scene.geometry->HasBoundaries()) return starts;
  starts.vary = scene.hasMotion;
  // Boundaries may cut a small part of a lens, or of the plane of parallel rays.
  const bool isPoint = scene.camera->HasPinhole() && !scene.camera->ConnectsByDirection();
  const int rays = isPoint ? 1 << 6 : 1 << 14;
  constexpr double kSteps[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                0.5385972572236101};  // [Roberts18] R4
  for (int i = 0; i < rays && !(starts.vary && starts.disputed != kNoIndex); ++i) {
    float u[4];
    for (int k = 0; k < 4; ++k) {
      const double value = 0.5 + i * kSteps[k];
      u[k] = static_cast<float>(value - std::floor(value));
    }
    const CameraRay seen = scene.camera->GenerateRay(2.0f * middle * Point2(u[0], u[1]), Point2(u[2], u[3]), 0);
    if (seen.weight == 0) continue;
    const std::vector<MediumChange> changes = MediumChanges(*scene.geometry, seen.ray);
    const bool meetsSheet = !changes.empty() && !changes.front().isBoundary;
    if (starts.disputed == kNoIndex && !scene.hasMotion)
      starts.disputed = BrokenLink(changes, meetsSheet && !starts.vary ? scene.cameraMedium : kSameMedium);
    // A sheet that is no boundary says nothing of the medium between it and the camera.
    if (!meetsSheet && MediumAlong(*scene.geometry, seen.ray, exterior) != scene.cameraMedium) starts.vary = true;
  }
  return starts;
}

}  // namespace

void SceneMedia::LookAround(const GeometryScene& geometry, const Ray& eye) {
  if (!description_.media.empty()) around_ = FindMediumAround(geometry, eye.origin, 0, eye.direction);
}

std::vector<int32_t> SceneMedia::Unbounded() const {
  std::vector<int32_t> media;
  if (Exterior() != kVacuum) media.push_back(Exterior());
  const bool isBounded = around_.medium && !around_.isOfOpaque;
  if (!description_.cameraMedium.empty() && !isBounded)
    media.push_back(IndexOf(description_.cameraMedium, description_.camera.where));
  return media;
}

void SceneMedia::Locate(const Point2& middle, const std::vector<FileLocation>& lightPlaces, RenderScene& scene) {
  if (description_.media.empty()) return;
  const FileLocation& where = description_.camera.where;
  scene.cameraMedium = Choose("the camera", where, description_.cameraMedium, around_, kVacuum);
  if (description_.cameraMedium.empty() && scene.cameraMedium != kVacuum) {
    diagnostics_.Warn(where,
                      "the camera is in " + NameOf(scene.cameraMedium) +
                          ", and its rays start there. pbrt-v4 starts them in vacuum, because no MediumInterface "
                          "before the camera names it");
  }
  if (!around_.medium || around_.isOfOpaque) scene.unbounded = scene.cameraMedium;
  const bool isKnown = around_.medium && (around_.isOfBoundary || description_.cameraMedium.empty());
  scene.exterior = isKnown ? Exterior() : scene.cameraMedium;
  if (around_.disputed == kNoIndex) {
    const CameraStarts starts = LookFrom(scene, middle, scene.exterior);
    if (starts.vary) scene.cameraExterior = scene.exterior;
    WarnOfDispute(starts.disputed, where, "the camera", scene.cameraMedium);
  }
  const std::vector<Bounds3> boundaries = scene.geometry->BoundaryBoxes();
  const auto meetsBoundary = [&](size_t light) {
    return MeetsBoundary(scene.lighting->Lights()[light], scene.lighting->SceneSphere(), boundaries);
  };
  int meeting = 0;
  for (size_t light = 0; light < lightPlaces.size(); ++light) meeting += meetsBoundary(light) ? 1 : 0;
  const int points = std::clamp(kPointsOfAll / std::max(meeting, 1), kFewestPoints, kMostPoints);
  for (size_t light = 0; light < lightPlaces.size(); ++light) {
    const Sides sides =
        MediaOfLight(scene, light, lightPlaces[light], scene.exterior, meetsBoundary(light) ? points : kFewestPoints);
    scene.lightMedia.push_back(sides.front);
    scene.lightBackMedia.push_back(sides.behind);
    scene.lightStartsVary.push_back(sides.startsVary);
  }
}

}  // namespace lampyr
