// Motion while the shutter is open, over distances that are large compared with the photon radius; and the cameras.
#include "matrix/matrix_rigs.h"

namespace lampyr::test {

using namespace rigs;

void AddMotionRigs(std::vector<Rig>& rigs) {
  const auto add = [&](const std::string& name, const std::string& scene) {
    rigs.push_back({"motion_of_" + name, scene, {"motion " + name}});
  };
  const std::string left = "Translate -0.6 0 0 ", right = "Translate 0.6 0 0 ";
  // Balls: photons near the rim of something flat would be missed.
  const std::string ball =
      "Material \"diffuse\" \"rgb reflectance\" [0.8 0.3 0.3] Translate -0.25 0.25 0.2 Shape \"sphere\" \"float "
      "radius\" 0.2";
  const std::string shade =
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Translate -0.1 0.65 0.2 Shape \"sphere\" \"float "
      "radius\" 0.2";
  const std::string lamp =
      "Translate -0.1 1.05 0.2 Material \"diffuse\" AreaLightSource \"diffuse\" \"rgb L\" [6 5 4] ";
  const std::string bulb = "Shape \"sphere\" \"float radius\" 0.15 ";
  add("what_is_seen", Floor(Lamp("-0.2 1 0.2", 0.2) + Scope(Moving(left, right) + ball)));
  add("receiver", Room(kMatte, Lamp() + Scope(Moving("Translate 0.4 0 0", "Translate -0.5 -0.3 0.4") +
                                              "Material \"diffuse\" \"rgb reflectance\" [0.9 0.9 0.9] Shape \"sphere\" "
                                              "\"float radius\" 0.2")));
  add("occluder", Floor(Scope(lamp + bulb) + Scope(Moving(left, right) + shade)));
  add("area_light", Floor(Scope(Moving(left, right) + lamp + bulb)));
  add("light_and_occluder", Floor(Scope(Moving(left, right) + Scope(lamp + bulb) + Scope(shade)), "", 0.02));
  add("point_light", Floor(Scope(Moving(left, right) + "Translate -0.1 1 0.2 LightSource \"point\" \"rgb I\" [2 2 2]") +
                           Scope(shade)));
  add("own_surface_light", Floor(Scope(Moving("Rotate -50 0 0 1 ", "Rotate 50 0 0 1 ") +
                                       "Translate -0.1 1 0.2 Rotate -90 1 0 0 LightSource \"rect\" \"float width\" 0.4 "
                                       "\"float height\" 0.2 \"float intensity\" 14")));
  add("distant_light", Floor(Scope(Moving("Rotate -40 0 0 1 ", "Rotate 40 0 0 1 ") +
                                   "Rotate -90 1 0 0 LightSource \"distant\" \"float angle\" 5 \"float illuminance\" 3 "
                                   "\"point3 from\" [0 0 1] \"point3 to\" [0 0 0]")));
  add("instance", Floor(Lamp("-0.2 1 0.2", 0.2) + "ObjectBegin \"ball\" " + Scope(ball) + "ObjectEnd\n" +
                        Scope(Moving(left, right) + "ObjectInstance \"ball\"")));
  add("glass", Floor(Scope(lamp + "Shape \"sphere\" \"float radius\" 0.25") +
                     Scope(Moving("Translate -0.8 0 0 ", "Translate 0.1 0 0 ") +
                           "Material \"thindielectric\" \"rgb transmittance\" [0.9 0.3 0.3] Translate 0.2 0.7 0.2 "
                           "Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 0.4")));
  rigs.back().cameraSeesDeltas = true;  // the lamp in the pane
  add("filter", Floor(Scope("Translate -0.1 1 0.2 Rotate -90 1 0 0 AttributeBegin " +
                            Moving("Translate -0.6 0 0 ", "Translate 0.6 0 0 ") +
                            "LightFilter \"barn\" \"string name\" \"doors\" \"float width\" 0.4 \"float height\" 1 "
                            "\"float edge\" 0.2 AttributeEnd LightFilter \"combiner\" \"string filters\" \"doors\" "
                            "LightSource \"point\" \"rgb I\" [3 3 3]")));
}

void AddCameraRigs(std::vector<Rig>& rigs) {
  // A strong lens in a small room: out of focus beside the axis, and dark towards the corners.
  const std::string lens = "\"string lensfile\" \"" LAMPYR_SOURCE_DIR "/scenes/data/singlet.dat\" ";
  const auto add = [&](const std::string& name, const std::string& type, const std::string& parameters) {
    rigs.push_back(
        {"camera_" + name, Room(kMatte, Lamp(), "Camera \"" + type + "\" " + parameters + "\n"), {"camera " + type}});
  };
  add("perspective", "perspective", "\"float fov\" 60");
  add("with_a_lens", "perspective", "\"float fov\" 60 \"float lensradius\" 0.1 \"float focaldistance\" 0.5");
  add("orthographic", "orthographic", "\"float screenwindow\" [ -0.4 0.4 -0.4 0.4 ]");
  add("orthographic_with_a_lens", "orthographic",
      "\"float screenwindow\" [ -0.4 0.4 -0.4 0.4 ] \"float lensradius\" 0.1 \"float focaldistance\" 0.5");
  add("spherical", "spherical", "");
  add("spherical_by_angles", "spherical", "\"string mapping\" \"equirectangular\"");
  const auto addLens = [&](const std::string& name, const std::string& parameters) {
    add(name, "realistic", lens + parameters);
    rigs.back().refusesLightPaths = true;
  };
  addLens("with_a_lens_of_glass", "\"float aperturediameter\" 10 \"float focusdistance\" 0.8");
  addLens("with_a_star", "\"float aperturediameter\" 14 \"float focusdistance\" 0.5 \"string aperture\" \"star\"");
}

}  // namespace lampyr::test
