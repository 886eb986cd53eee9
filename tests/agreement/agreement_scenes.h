// The parts that the scenes of the agreement of path and light tracing are made of. What only one of the two can see is
// kept out: no background, no mirrors or smooth glass in front of the camera, and no delta light behind smooth glass.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace lampyr::test {

struct AgreementScene {
  const char* name;
  std::string text;
  int samples = 64;        // per pixel of each replica
  int lightSamples = 128;  // light paths per pixel
  const char* crop = nullptr;
  int blockSize = 8;
};

inline void PrintTo(const AgreementScene& scene, std::ostream* stream) {
  *stream << scene.name;
}

inline std::string FilmWith(const std::string& filter, int width = 32, int height = 32) {
  return "Film \"rgb\" \"integer xresolution\" " + std::to_string(width) + " \"integer yresolution\" " +
         std::to_string(height) + "\nPixelFilter \"" + filter + "\"\n";
}

// A camera that looks down on the ground and sees nothing else; and one that also sees what hangs above.
inline const std::string kDown = "LookAt 0 3 2.5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 36\n";
inline std::string World(int depth) {
  return "Integrator \"path\" \"integer maxdepth\" " + std::to_string(depth) + "\nWorldBegin\n";
}

// A diffuse ground with a matte ball and a rough metal one on it: depth, shadows, both kinds of lobes.
inline const std::string kGround = R"(Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3]
)";
inline const std::string kThings = kGround + R"(AttributeBegin
Material "diffuse" "rgb reflectance" [0.3 0.6 0.8]
Translate -0.5 0.35 0 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.4
Translate 0.45 0.3 0.2 Shape "sphere" "float radius" 0.3
AttributeEnd
)";
// A closed room of 2 × 2 × 2 around the origin.
inline const std::string kRoom = R"(Material "diffuse" "rgb reflectance" [0.6 0.6 0.5]
Shape "trianglemesh" "point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]
  "integer indices" [0 1 2 0 2 3  4 6 5 4 7 6  0 5 1 0 4 5  3 2 6 3 6 7  0 3 7 0 7 4  1 5 6 1 6 2]
)";
// A square lamp at height 1.5 that shines down.
inline std::string Square(const std::string& parameters, double side = 0.4) {
  const std::string s = std::to_string(side / 2), m = std::to_string(-side / 2);
  return "AttributeBegin\nAreaLightSource \"diffuse\" " + parameters +
         "\nMaterial \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2]\nShape \"trianglemesh\" \"point3 P\" [" + m +
         " 1.5 " + m + " " + s + " 1.5 " + m + " " + s + " 1.5 " + s + " " + m + " 1.5 " + s +
         "] \"integer indices\" [0 1 2 0 2 3]\nAttributeEnd\n";
}
inline const std::string kSeesLamp = "LookAt 0 2.2 3.6  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n";
// Upright, behind all the rest.
inline const std::string kBackdrop = "AttributeBegin Translate 0 0 -1.4 Rotate 90 1 0 0\n" + kGround + "AttributeEnd\n";

// Where a light's -z points down, and where it points at the camera of kSeesLamp from the backdrop.
inline const std::string kFacesDown = "Rotate -90 1 0 0 ";
inline const std::string kFacesCamera = "Rotate 160 1 0 0 ";
inline std::string Placed(const std::string& placement, const std::string& type, const std::string& parameters) {
  return "AttributeBegin " + placement + " LightSource \"" + type + "\" " + parameters + " AttributeEnd\n";
}

// All of them.
std::vector<AgreementScene> AgreementScenes();

// UsdLux's lights: shaping, portals, multipliers, under all kinds of placements.
std::vector<AgreementScene> UsdLuxScenes();
// And its lights that are their own surface.
std::vector<AgreementScene> OwnSurfaceScenes();

}  // namespace lampyr::test
