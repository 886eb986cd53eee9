// The scenes in which all integrators see the same.
#include "agreement/agreement_scenes.h"

namespace lampyr::test {

std::vector<AgreementScene> AgreementScenes() {
  std::vector<AgreementScene> scenes;
  const auto add = [&](const char* name, const std::string& text) -> AgreementScene& {
    scenes.push_back({name, text});
    return scenes.back();
  };
  // Each type of light.
  add("point", FilmWith("box") + kDown + World(4) +
                   "LightSource \"point\" \"rgb I\" [5 4 3] \"point3 from\" [0.8 1.5 0.4]\n" + kThings);
  add("spot", FilmWith("triangle") + kDown + World(3) +
                  "LightSource \"spot\" \"rgb I\" [9 8 7] \"point3 from\" [-1 2 1] \"point3 to\" [0 0 0] \"float "
                  "coneangle\" 40 \"float conedeltaangle\" 25\n" +
                  kThings);
  add("distant", FilmWith("gaussian") + kDown + World(4) +
                     "LightSource \"distant\" \"rgb L\" [2 2 3] \"point3 from\" [1 2 0.5] \"point3 to\" [0 0 0]\n" +
                     kThings);
  add("even_sky",
      FilmWith("gaussian") + kDown + World(3) + "LightSource \"infinite\" \"rgb L\" [0.5 0.6 0.8]\n" + kThings);
  add("image_sky", FilmWith("box") + kDown + World(3) +
                       "AttributeBegin Rotate -90 1 0 0 LightSource \"infinite\" \"string filename\" "
                       "\"data/sky-noon.hdr\" AttributeEnd\n" +
                       kThings);
  add("goniometric",
      FilmWith("gaussian") + kDown + World(3) +
          "AttributeBegin Translate 0.2 1.4 0.2 Rotate 100 1 0.2 0 LightSource \"goniometric\" \"rgb I\" "
          "[1 1 1] \"string filename\" \"data/sky-noon.hdr\" AttributeEnd\n" +
          kThings);
  add("projection",
      FilmWith("box") + kDown + World(3) +
          "AttributeBegin Translate 0 2.2 0.3 Rotate 90 1 0 0 LightSource \"projection\" \"float fov\" 70 "
          "\"float scale\" 20 \"string filename\" \"data/wood.png\" AttributeEnd\n" +
          kThings);
  add("distant_with_angle",
      FilmWith("gaussian") + kDown + World(3) +
          "LightSource \"distant\" \"rgb L\" [2 2 3] \"float angle\" 40 \"point3 from\" [1 2 0.5] "
          "\"point3 to\" [0 0 0]\n" +
          kThings);
  add("dome", FilmWith("box") + kDown + World(3) +
                  "LightSource \"dome\" \"string texture:file\" \"data/sky-evening.hdr\" "
                  "\"float intensity\" 0.4\n" +
                  kThings);
  // Lobes that are shown different lights: what matters is the first surface only.
  const std::string split = " \"float diffuse\" 0.3 \"float specular\" 2.5";
  add("split_lobes", FilmWith("gaussian") + kDown + World(4) +
                         "LightSource \"point\" \"rgb I\" [5 4 3] \"point3 from\" [0.8 1.5 0.4]" + split +
                         "\nLightSource \"distant\" \"rgb L\" [1 1 2] \"float angle\" 30 \"point3 from\" [-1 2 0] "
                         "\"point3 to\" [0 0 0]" +
                         split + "\n" + kThings);
  // Area lights are seen by the camera, too: their own vertex is connected.
  add("mesh_mitchell", FilmWith("mitchell") + kSeesLamp + World(3) +
                           Square("\"rgb L\" [8 9 7] \"bool twosided\" true", 0.8) + kBackdrop + kThings)
      .samples = 128;
  add("sphere_sinc", FilmWith("sinc") + kSeesLamp + World(3) + kBackdrop + kThings +
                         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 4 3] Translate 0.2 1.3 0 Shape "
                         "\"sphere\" \"float radius\" 0.25 AttributeEnd\n")
      .samples = 256;
  add("disk_orthographic",
      FilmWith("gaussian") +
          "LookAt 0 2.5 2.5  0 0.3 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n" + World(3) +
          kThings +
          "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 5 4] \"bool twosided\" true Translate 0.5 1.1 -0.4 "
          "Rotate 60 1 0.3 0 Scale 1 0.5 1 Shape \"disk\" \"float radius\" 0.35 AttributeEnd\n");
  add("cylinder_lens", FilmWith("gaussian") +
                           "LookAt 0 2.2 3.6  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 30 \"float "
                           "lensradius\" 0.15 \"float focaldistance\" 3.2\n" +
                           World(3) + kBackdrop + kThings +
                           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] Translate 0 1.1 0.1 Rotate 80 "
                           "0 1 0 Shape \"cylinder\" \"float radius\" 0.1 \"float zmin\" -0.4 \"float zmax\" 0.4 "
                           "AttributeEnd\n");
  add("bilinear_image",
      FilmWith("triangle") + kSeesLamp + World(3) + kBackdrop + kThings +
          "AttributeBegin AreaLightSource \"diffuse\" \"string filename\" \"data/screen.png\" \"float scale\" 9 Shape "
          "\"bilinearmesh\" \"point3 P\" [-0.5 1.5 -0.4  0.5 1.3 -0.4  -0.5 1.2 0.5  0.5 1.5 0.5] AttributeEnd\n");
  add("orthographic_lens",
      FilmWith("box") +
          "LookAt 0 2.5 2.5  0 0.3 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1] \"float "
          "lensradius\" 0.2 \"float focaldistance\" 3\n" +
          World(3) + kThings + Square("\"rgb L\" [6 5 7]"));
  // All around: the image goes on beyond its edges.
  for (const char* mapping : {"equalarea", "equirectangular"}) {
    add(mapping, FilmWith("gaussian") +
                     "Rotate 30 1 1 0\nTranslate -0.2 -0.1 0.3\nCamera \"spherical\" \"string mapping\" \"" + mapping +
                     "\"\n" + World(3) + kRoom +
                     "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 5 6] Translate 0.6 0.6 -0.4 Shape "
                     "\"sphere\" \"float radius\" 0.2 AttributeEnd\n");
  }
  // Several kinds at once; and one lamp in parts, of which some are far brighter.
  const std::string several =
      "LightSource \"point\" \"rgb I\" [1 0.5 0.2] \"point3 from\" [0.8 1.5 0.4]\nLightSource \"infinite\" \"rgb L\" "
      "[0.1 "
      "0.2 0.3]\nLightSource \"distant\" \"rgb L\" [0.6 0.3 0.3] \"point3 from\" [1 2 0.5] \"point3 to\" [0 0 0]\n" +
      Square("\"rgb L\" [3 4 2]");
  add("several_kinds", FilmWith("gaussian") + kDown + World(4) + several + kThings);
  std::string parts;
  for (int i = 0; i < 8; ++i) {
    parts += "AttributeBegin Translate " + std::to_string(-0.7 + 0.2 * i) + " " + std::to_string(0.02 * i) + " 0\n" +
             Square("\"rgb L\" [" + std::to_string(1 + i * i) + " 5 " + std::to_string(9 - i) + "]", 0.18) +
             "AttributeEnd\n";
  }
  add("eight_parts", FilmWith("box") + kDown + World(2) + parts + kThings);
  add("instanced",
      FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings + "ObjectBegin \"lamp\"\n" +
          Square("\"rgb L\" [9 7 5]", 0.3) +
          "ObjectEnd\nObjectInstance \"lamp\"\nAttributeBegin Translate 0.5 0.3 0.3 Rotate 40 0 0 1 Scale 1 -1 2 "
          "Translate 0 -1.5 0 Translate 0 -0.4 0 ObjectInstance \"lamp\" AttributeEnd\n");
  // Shading normals: a coarse closed mesh with the normals of a sphere, and bumps on the ground.
  add("smooth_normals", FilmWith("box") + kDown + World(3) + Square("\"rgb L\" [9 9 9]") + kGround + R"(AttributeBegin
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
Translate 0 0.5 0 Scale 0.5 0.5 0.5
Shape "trianglemesh" "point3 P" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] "normal N" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1]
 "integer indices" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]
AttributeEnd
)");
  add("bumps", FilmWith("gaussian") + kDown + World(3) +
                   "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0.5 1.5 0.5]\n" + R"(
Texture "waves" "float" "wrinkled" "float roughness" 0.5 "integer octaves" 3
Texture "bumps" "float" "scale" "texture tex" "waves" "float scale" 0.3
Material "coateddiffuse" "rgb reflectance" [0.5 0.6 0.7] "float roughness" 0.4 "texture displacement" "bumps"
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3] "point2 uv" [0 0 0 5 5 5 5 0]
)");
  // Refraction: radiance is scaled by η², flux is not. The glass is rough, so that both can connect through it; one
  // lamp is inside of it.
  add("rough_glass",
      FilmWith("box") + kDown + World(6) + Square("\"rgb L\" [12 12 12]", 0.6) + kGround + R"(AttributeBegin
Material "dielectric" "float eta" 1.5 "float roughness" 0.5
Translate 0 0.5 0 Shape "sphere" "float radius" 0.45
AttributeEnd
)");
  add("lamp_in_glass", FilmWith("box") + kDown + World(6) + kGround + R"(AttributeBegin
Translate 0 0.6 0
AttributeBegin Material "dielectric" "float eta" 1.5 "float roughness" 0.6 Shape "sphere" "float radius" 0.5 AttributeEnd
AreaLightSource "diffuse" "rgb L" [9 6 6] Shape "sphere" "float radius" 0.2
AttributeEnd
)");
  // Light by wavelength: glass that disperses strongly, rough where the camera sees it and smooth where it does not;
  // spectra of a lamp and of a metal, a texture, a coloured pane.
  AgreementScene& dispersion = add("dispersion", FilmWith("box") + kDown + World(5) + R"(
Texture "checks" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8 "rgb tex1" [0.7 0.2 0.1] "rgb tex2" [0.1 0.5 0.8]
AttributeBegin
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [-2.5 0 -2.5  2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5]
AttributeEnd
AttributeBegin
Material "dielectric" "float cauchy" [1.3 0.1] "float roughness" 0.4
Translate -0.5 0.45 0.1 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.4
Translate 0.45 0.3 0.2 Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Material "dielectric" "float cauchy" [1.3 0.1]
Translate 0.3 1.05 -1.35 Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Material "thindielectric" "float eta" 1 "rgb transmittance" [0.3 0.7 0.9]
Translate 1.2 1.2 -0.8 Rotate 90 1 0 0 Shape "disk" "float radius" 0.4
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "blackbody L" 3200 "float scale" 8
Translate 0.3 2.3 -1.6 Shape "sphere" "float radius" 0.4
AttributeEnd
)");
  dispersion.samples = 384;
  dispersion.lightSamples = 640;
  // A smooth pane between lamp and ground, out of the camera's sight: paths from the ground pass it and meet the lamp.
  add("thin_pane", FilmWith("box") + kDown + World(5) + kGround + "Translate 0 0 -0.9\n" +
                       Square("\"rgb L\" [9 9 9]", 1.0) +
                       "Material \"thindielectric\" \"float eta\" 1.5\nTranslate 0 1.3 0 Rotate 90 1 0 0 Shape "
                       "\"disk\" \"float radius\" 0.5\n")
      .samples = 256;
  add("diffuse_transmission",
      FilmWith("triangle") + kDown + World(4) + Square("\"rgb L\" [9 9 9]", 0.5) + kGround +
          "AttributeBegin Material \"diffusetransmission\" \"rgb reflectance\" [0.3 0.2 0.1] "
          "\"rgb transmittance\" [0.2 0.4 0.5] Translate 0 0.6 0 Rotate 70 1 0 0 Shape \"disk\" "
          "\"float radius\" 0.6 AttributeEnd\n");
  add("coats", FilmWith("gaussian") + kDown + World(3) + Square("\"rgb L\" [9 9 9]", 0.6) + kGround + R"(AttributeBegin
Material "coatedconductor" "float interface.roughness" 0.3 "float conductor.roughness" 0.4
Translate -0.5 0.35 0 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
MakeNamedMaterial "matte" "string type" "diffuse" "rgb reflectance" [0.8 0.3 0.2]
MakeNamedMaterial "coat" "string type" "coateddiffuse" "rgb reflectance" [0.3 0.3 0.9] "float roughness" 0.3
Material "mix" "string materials" ["matte" "coat"] "float amount" 0.4
Translate 0.45 0.3 0.2 Shape "sphere" "float radius" 0.3
AttributeEnd
)");
  // The camera does not see the lamp, nor what is behind it less.
  add("invisible_lamp", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings +
                            Square("\"rgb L\" [8 9 7] \"bool twosided\" true \"bool cameraVisible\" false", 0.8));
  // Lamp, ball and shadow move while the shutter is open.
  add("motion", FilmWith("gaussian") + kSeesLamp + World(3) + kBackdrop + kThings +
                    "ActiveTransform EndTime Translate 0.5 -0.2 0.2 Rotate 30 0 0 1 ActiveTransform All\n" +
                    Square("\"rgb L\" [8 9 7] \"bool twosided\" true", 0.5) +
                    "LightSource \"point\" \"rgb I\" [1 0.5 0.2] \"point3 from\" [-0.8 1.2 0.4]\nMaterial \"diffuse\" "
                    "\"rgb reflectance\" [0.7 0.2 0.3] Translate 0.1 0.9 -0.3 Shape \"sphere\" \"float radius\" 0.2\n");
  // Cut-outs, fractional ones too, in the lamp and in what shades it.
  add("cut_outs", FilmWith("box") + kSeesLamp + World(3) + kBackdrop + kGround + R"(
Texture "holes" "float" "checkerboard" "float uscale" 3 "float vscale" 3 "float tex1" 0.4 "float tex2" 1
AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 7 6] "bool twosided" true
Shape "trianglemesh" "point3 P" [-0.5 1.2 -0.4  0.5 1.2 -0.4  0.5 1.5 0.4  -0.5 1.5 0.4] "integer indices" [0 1 2 0 2 3]
  "point2 uv" [0 0 1 0 1 1 0 1] "texture alpha" "holes"
AttributeEnd
Shape "trianglemesh" "point3 P" [-0.5 0.6 -0.4  0.5 0.6 -0.4  0.5 0.6 0.4  -0.5 0.6 0.4] "integer indices" [0 1 2 0 2 3]
  "point2 uv" [0 0 1 0 1 1 0 1] "texture alpha" "holes"
)");
  // A lamp that is not there for rays: neither seen nor in the way.
  add("ghost_lamp",
      FilmWith("box") + kSeesLamp + World(3) + kBackdrop + kThings +
          "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 7 5] Translate 0 1.4 0 Shape \"sphere\" "
          "\"float radius\" 0.3 \"float alpha\" 0 AttributeEnd\n");
  add("cropped",
      FilmWith("gaussian", 64, 48) + kSeesLamp + World(3) + Square("\"rgb L\" [8 9 7]", 0.8) + kBackdrop + kThings)
      .crop = "20,46,5,33";
  for (const auto& more : {UsdLuxScenes(), OwnSurfaceScenes()}) scenes.insert(scenes.end(), more.begin(), more.end());
  return scenes;
}

}  // namespace lampyr::test
