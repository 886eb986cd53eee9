// Lights that are their own surface: rect, disk, sphere, cylinder. Several to a scene where each still stands out.
#include "agreement/agreement_scenes.h"

namespace lampyr::test {

namespace {

std::string Cone(double angle, double softness) {
  return " \"float shaping:cone:angle\" " + std::to_string(angle) + " \"float shaping:cone:softness\" " +
         std::to_string(softness) + " ";
}

// The camera sees lamps from inside of their cones, from the soft edge, and from outside where they are dark. Most
// photons of the points that it sees may be dark: those points are seen all the same.
AgreementScene ShapedLamps() {
  AgreementScene scene{"shaped_lamps", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings};
  scene.text += Placed("Translate -0.5 1.2 -0.9 " + kFacesCamera, "rect",
                       "\"float width\" 0.5 \"float height\" 0.4 \"float intensity\" 9 \"string texture:file\" "
                       "\"data/screen.png\" \"float shaping:focus\" 2" +
                           Cone(50, 0.5));
  // The camera is 55° from its axis, outside of the cone.
  scene.text += Placed("Translate -0.45 0.75 0.3 Rotate 55 0 1 0 " + kFacesCamera, "rect",
                       "\"float width\" 0.3 \"float height\" 0.3 \"float intensity\" 12" + Cone(40, 0.2));
  // The light shines past the camera: on the side turned away from its axis, most photons go inwards.
  scene.text += Placed("Translate 0.35 1.2 -0.2 Rotate 60 0 1 0 " + kFacesCamera, "sphere",
                       "\"float radius\" 0.25 \"float intensity\" 6 \"rgb color\" [0.5 0.8 1]" + Cone(75, 0.3));
  scene.text += Placed("Translate 0.75 1.0 -0.4 " + kFacesDown, "sphere",
                       "\"float radius\" 0.15 \"float intensity\" 9" + Cone(60, 0.3));
  return scene;
}

// No surface receives anything from the first two, and yet the camera sees them; the others show lobes more or less.
AgreementScene Multipliers() {
  AgreementScene scene{"multipliers", FilmWith("box") + kSeesLamp + World(3) + kBackdrop + kThings};
  const std::string none = " \"float diffuse\" 0 \"float specular\" 0";
  scene.text += Placed("Translate -0.5 1.2 -0.6 " + kFacesCamera, "rect",
                       "\"float width\" 0.5 \"float height\" 0.4 \"float intensity\" 0.6" + none);
  scene.text += Placed("Translate 0.5 1.2 -0.3 " + kFacesCamera, "sphere",
                       "\"float radius\" 0.2 \"float intensity\" 0.8" + none + Cone(30, 0.5));
  scene.text += Placed("Translate 0 1.5 0 " + kFacesDown, "rect",
                       "\"float width\" 0.6 \"float height\" 0.4 \"float intensity\" 6 \"float diffuse\" 0.3 \"float "
                       "specular\" 2.5");
  scene.text +=
      "AttributeBegin AreaLightSource \"mesh\" \"float intensity\" 3 \"float specular\" 0 Translate 0 0.9 -0.7 "
      "Shape \"sphere\" \"float radius\" 0.12 AttributeEnd\n";
  return scene;
}

AgreementScene Cylinders() {
  AgreementScene scene{"cylinder_and_disk", FilmWith("triangle") + kSeesLamp + World(3) + kBackdrop + kThings};
  scene.text += Placed("Translate -0.3 1.2 -0.2 Rotate 20 0 1 0.5", "cylinder",
                       "\"float length\" 0.6 \"float radius\" 0.1 \"float intensity\" 5");
  scene.text += Placed("Translate 0.6 1.1 -0.4 " + kFacesCamera, "disk",
                       "\"float radius\" 0.25 \"float exposure\" 2 \"rgb color\" [1 0.7 0.4] \"bool twoSided\" true");
  scene.samples = 128;
  return scene;
}

// Under shear, mirrors and uneven scales, and what `normalize` makes of their areas.
AgreementScene BentAndNormalized() {
  AgreementScene scene{"bent_and_normalized", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings};
  const std::string normal = " \"bool normalize\" true ";
  const std::string shear = " ConcatTransform [1 0 0 0  0.6 1 0 0  0.2 0 1 0  0 0 0 1] ";
  scene.text += Placed("Translate -0.6 1.25 -0.5 " + kFacesCamera + shear + "Scale -0.5 0.4 1", "rect",
                       normal + "\"float intensity\" 1.2 \"string texture:file\" \"data/screen.png\"");
  scene.text += Placed("Translate 0 1.2 -0.3 Rotate 40 1 1 0 Scale 0.3 0.5 0.2", "sphere", normal);
  scene.text +=
      Placed("Translate 0.6 1.25 -0.5 " + shear + "Scale 0.5 0.2 -0.3", "cylinder", normal + "\"bool twoSided\" true");
  scene.text += Placed("Translate 0.5 0.75 0.3 " + kFacesCamera + "Scale 0.4 -0.2 0.3" + shear, "disk",
                       normal + "\"float intensity\" 0.5" + Cone(75, 0.3));
  scene.samples = 128;
  return scene;
}

// Over the shutter; one of them changes its size, and with it its radiance.
AgreementScene MovingRect() {
  AgreementScene scene{"moving_rect", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings};
  const auto moving = [](const std::string& motion) {
    return "ActiveTransform EndTime " + motion + " ActiveTransform All ";
  };
  scene.text += Placed("Translate -0.5 1.2 -0.3 " + moving("Translate 0.4 -0.3 0.2 Rotate 30 0 0 1") + kFacesCamera,
                       "rect", "\"float width\" 0.4 \"float height\" 0.3 \"float intensity\" 7" + Cone(60, 0.5));
  scene.text += Placed("Translate 0.5 1.1 -0.3 " + moving("Translate 0 0.2 0 Scale 2 1.5 1") + kFacesCamera, "rect",
                       "\"float width\" 0.25 \"float height\" 0.25 \"bool normalize\" true \"float intensity\" 0.5");
  scene.samples = 128;
  return scene;
}

AgreementScene IesDisk() {
  AgreementScene scene{"ies_disk", FilmWith("gaussian") + kDown + World(3)};
  scene.text += Placed("Translate -0.5 1.1 0 Rotate 15 0 0 1 " + kFacesDown, "disk",
                       "\"float radius\" 0.2 \"float intensity\" 0.02 \"string shaping:ies:file\" "
                       "\"profiles/downlight.ies\"");
  scene.text += Placed("Translate 0.6 0.9 0.2 " + kFacesDown, "point",
                       "\"rgb I\" [3 4 5] \"string shaping:ies:file\" \"profiles/batwing.ies\" \"bool "
                       "shaping:ies:normalize\" true \"float specular\" 0.5");
  return {scene.name, scene.text + kThings};
}

}  // namespace

std::vector<AgreementScene> OwnSurfaceScenes() {
  return {ShapedLamps(), Multipliers(), Cylinders(), BentAndNormalized(), MovingRect(), IesDisk()};
}

}  // namespace lampyr::test
