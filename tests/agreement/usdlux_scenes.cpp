// Several lights to a scene where each still stands out in blocks of its own.
#include "agreement/agreement_scenes.h"

namespace lampyr::test {

namespace {

// The second is dark in most directions, and the third lights nothing: the camera sees them all the same.
AgreementScene MeshTwoSided() {
  AgreementScene scene{"mesh_two_sided", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings};
  scene.text += R"(AttributeBegin
AreaLightSource "mesh" "float intensity" 7 "float diffuse" 0.5 "bool twoSided" true "string texture:file" "data/screen.png" "float shaping:focus" 1
Translate -0.3 1.2 -0.3 Rotate 35 1 0.2 0
Shape "trianglemesh" "point3 P" [-0.3 -0.25 0  0.3 -0.25 0  0.3 0.25 0.1  -0.3 0.25 0.1] "integer indices" [0 1 2 0 2 3]
  "point2 uv" [0 0 1 0 1 1 0 1]
AttributeEnd
AttributeBegin
AreaLightSource "mesh" "float intensity" 3 "float shaping:cone:angle" 70
Translate 0.6 1.0 0.1 Rotate 130 1 0.3 0 Scale 1 0.6 1
Shape "sphere" "float radius" 0.2
AttributeEnd
AttributeBegin
AreaLightSource "mesh" "float intensity" 0.7 "float diffuse" 0 "float specular" 0
Translate -0.7 0.8 0.1 Shape "sphere" "float radius" 0.15
AttributeEnd
)";
  scene.samples = 128;
  return scene;
}

// Windows of an even sky and of an image, the second one sheared.
AgreementScene Portals() {
  AgreementScene scene{"portals", FilmWith("box") + kDown + World(3) + kThings};
  scene.text += Placed("Translate -0.9 1.2 0 Rotate 25 0 0 1 " + kFacesDown, "portal",
                       "\"float width\" 0.8 \"float height\" 0.6 \"rgb color\" [0.6 0.8 1]");
  scene.text +=
      Placed("Translate 0.8 1.1 -0.3 ConcatTransform [1 0 0 0  0.3 1 0 0  0 0 1 0  0 0 0 1] " + kFacesDown, "portal",
             "\"float width\" 0.7 \"float height\" 0.9 \"string texture:file\" \"data/sky-noon.hdr\"");
  return scene;
}

AgreementScene IesPoint() {
  AgreementScene scene{"ies_point", FilmWith("gaussian") + kDown + World(3) + kThings};
  scene.text += Placed("Translate 0.6 0.9 0.2 " + kFacesDown, "point",
                       "\"rgb I\" [3 4 5] \"string shaping:ies:file\" \"profiles/batwing.ies\" \"bool "
                       "shaping:ies:normalize\" true \"float specular\" 0.5");
  return scene;
}

}  // namespace

std::vector<AgreementScene> UsdLuxScenes() {
  return {MeshTwoSided(), Portals(), IesPoint()};
}

}  // namespace lampyr::test
