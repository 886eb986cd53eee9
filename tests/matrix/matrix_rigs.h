// The rigs of the matrix of agreement: tiny scenes, each of which has one feature that all integrators must agree on.
// What a rig covers is named, so that a type that is registered and in no rig can be told.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace lampyr::test {

struct Rig {
  std::string name;
  std::string text;
  // Subjects of the rig: "material mix", "light spot", "filter gobo", "camera orthographic", "motion occluder", …
  std::vector<std::string> covers;
  // Light tracing connects every vertex to the camera: it is blind to what the camera sees of deltas.
  bool cameraSeesDeltas = false;
  // Light tracing refuses the camera; what is bidirectional makes do without connections to it.
  bool refusesLightPaths = false;
  std::string kind = "";  // "materials", "lights", "filters", "motion", "cameras"
  size_t turn = 0;        // among those of its kind
};

inline void PrintTo(const Rig& rig, std::ostream* stream) {
  *stream << rig.name;
}

// All of them; files that they read (suite_inputs.h) are written to `folder`, which must exist.
std::vector<Rig> MatrixRigs(const std::filesystem::path& folder);

// Rigs by what they vary; MatrixRigs joins them.
void AddMaterialRigs(std::vector<Rig>& rigs);
void AddLightRigs(std::vector<Rig>& rigs);
void AddFilterRigs(std::vector<Rig>& rigs);
void AddMotionRigs(std::vector<Rig>& rigs);
void AddCameraRigs(std::vector<Rig>& rigs);

namespace rigs {

// The inside of a sphere of radius 1. Photons are merged without bias but for what the radiance bends within the
// radius: a ball around a point of a sphere cuts a cap of exactly π r² from it, and there are no edges.
inline const std::string kCamera = "Camera \"perspective\" \"float fov\" 80\n";
std::string Room(const std::string& material, const std::string& inside, const std::string& camera = kCamera,
                 int depth = 3, double photonRadius = 0.08);

// A floor of radius 1 under the sky with a ball over it; its middle is seen. The ball does not touch the floor: photons
// on the lower side of the floor would be merged with what the ball receives from below. `photonRadius`: small against
// the width of penumbras. Blur over them moves light between what is seen and what is hidden, in proportion to its
// square.
std::string Floor(const std::string& above, const std::string& ball = "", double photonRadius = 0.04);

// A glowing ball of radius `radius`.
std::string Lamp(const std::string& place = "0.25 0.4 0.1", double radius = 0.25, const std::string& more = "");

// `statements` in a scope of their own.
inline std::string Scope(const std::string& statements) {
  return "AttributeBegin " + statements + " AttributeEnd\n";
}
// A placement that moves over the shutter.
inline std::string Moving(const std::string& start, const std::string& end) {
  return "ActiveTransform StartTime " + start + " ActiveTransform EndTime " + end + " ActiveTransform All ";
}

inline const std::string kMatte = "Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]\n";

}  // namespace rigs

}  // namespace lampyr::test
