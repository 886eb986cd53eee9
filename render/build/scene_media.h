// Where the participating media of a scene are: on the sides of its shapes, around its camera and its lights.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "geometry/geometry_scene.h"
#include "geometry/medium_at.h"
#include "integrators/walk/render_scene.h"
#include "scene/scene_description.h"

namespace lampyr {

// Indices of media are those of SceneDescription::media; the name "" is vacuum.
class SceneMedia {
 public:
  // Both have to outlive it.
  SceneMedia(const SceneDescription& description, Diagnostics& diagnostics);

  // Throws an Error at `where` if there is no medium of this name.
  int32_t IndexOf(const std::string& name, const FileLocation& where) const;

  // Sets the media of both sides by the shape's MediumInterface. Where the names of both sides are equal, it is
  // ignored, as in pbrt-v4: the surface separates nothing.
  void SetSides(const ShapeDescription& shape, GeometryAttributes& attributes) const;

  // Records the place in the file of a shape that separates media, for warnings: entry `entry` of object `object`, or
  // of the scene where that is -1.
  void AddPlace(int object, size_t entry, const FileLocation& where) { places_.push_back({object, entry, where}); }
  // Finds the primitives of these places. To be called when `geometry` is complete.
  void NumberPlaces(const GeometryDescription& geometry);
  // Records the media on both sides of the surface that area light `light` is, or the one that it is said to be in.
  void AddAreaLight(size_t light, const GeometryAttributes& attributes, const ShapeDescription& shape);

  // Sets the media around the camera, and in front of and behind the lights. `middle`: of the film, in pixels.
  // `lightPlaces`: places in the file, by light.
  //
  // - Camera and lights are in the medium that the file names. Where it names none, they are in the one that they are
  //   found in by rays to the surfaces around them (FindMedium) at shutter open; and if there are none, the camera is
  //   in vacuum, and lights are where lights at infinity are.
  // - A camera on a boundary is in the medium that it looks into. If its rays start in several, each starts in the one
  //   that it goes through (RenderScene::cameraExterior). So it is for camera and lights where something moves.
  // - If all rays say another medium than the file, theirs holds, with a warning: that is where paths will find it.
  // - Area lights have the media of their shape's sides, if it separates any. If they reach from one medium into
  //   another, each ray starts in the one that it goes through.
  // - Lights at infinity are in the medium that all rays from the camera end in, or else in vacuum.
  // - Where no surface separates media, all of the scene is in that of the camera, and lights that the file puts into
  //   another one get a warning.
  // - Where rays disagree, what most of them say holds, and one warning is given with the place of the surface.
  void Locate(const Point2& middle, const std::vector<FileLocation>& lightPlaces, RenderScene& scene);
  // Finds the medium around the camera; before Locate. `eye`: the start of the ray through the middle of the film.
  void LookAround(const GeometryScene& geometry, const Ray& eye);
  // The medium in which rays leave the scene, as far as the boundaries say it.
  int32_t Exterior() const { return around_.exterior.value_or(kVacuum); }
  // The media that no boundary keeps from the scene's end.
  std::vector<int32_t> Unbounded() const;

 private:
  struct Place {
    int object;
    size_t entry;
    FileLocation where;
  };
  struct Sides {
    int32_t front = kVacuum, behind = kVacuum;
    bool startsVary = false;  // RenderScene::lightStartsVary
  };

  std::string NameOf(int32_t medium) const;
  int32_t Choose(const std::string& what, const FileLocation& where, const std::string& name, const FoundMedium& found,
                 int32_t otherwise);
  void WarnOfDispute(uint32_t primitive, const FileLocation& where, const std::string& what, int32_t medium);
  // `points`: of a surface, at which the medium is looked for.
  Sides MediaOfLight(const RenderScene& scene, size_t light, const FileLocation& where, int32_t exterior, int points);

  const SceneDescription& description_;
  Diagnostics& diagnostics_;
  std::unordered_map<std::string, int32_t> indices_;
  std::vector<Place> places_;
  std::unordered_map<uint32_t, FileLocation> primitivePlaces_;
  std::unordered_map<size_t, Sides> areaLights_;            // those that separate media
  std::unordered_map<size_t, std::string> areaLightNames_;  // of the others, where they are said to be in one
  FoundMedium around_;                                      // the camera
  bool hasWarnedOfDispute_ = false;
};

}  // namespace lampyr
