#include "agreement/media_scenes.h"

namespace lampyr::test {

namespace {

const std::string kFog =
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0.4 0.4 0.4] \"rgb sigma_a\" "
    "[0.1 0.1 0.1] \"float g\" 0.3\n";
const std::string kInRoom = "LookAt 0 0 0.9  0 -0.2 -1  0 1 0\n";
const std::string kView = "Camera \"perspective\" \"float fov\" 80\n";
const std::string kBulb =
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 5 4] Translate 0.3 0.6 -0.3 Shape \"sphere\" \"float "
    "radius\" 0.15 AttributeEnd\n";
const std::string kWall = "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-2 -2 1  2 -2 1  -2 2 1  2 2 1]\n";
const std::string kPoint = "LightSource \"point\" \"rgb I\" [0.7 0.8 1] \"point3 from\" [-0.4 0.5 0.2]\n";

// A box of half side 0.5 in front of the camera, without a surface of its own.
std::string BoxOf(const std::string& inside, const std::string& outside = "") {
  return "AttributeBegin Material \"interface\" MediumInterface \"" + inside + "\" \"" + outside +
         "\" Translate 0 -0.3 -0.4 Scale 0.5 0.5 0.5\nShape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  "
         "-1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n\"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 "
         "3 7 6  0 7 3 0 4 7  1 2 6 1 6 5]\nAttributeEnd\n";
}
std::string BallOf(const std::string& inside, const std::string& outside = "",
                   const std::string& material = "\"interface\"") {
  return "AttributeBegin Material " + material + " MediumInterface \"" + inside + "\" \"" + outside +
         "\" Translate -0.1 -0.3 -0.3 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n";
}

std::string Homogeneous(const std::string& name, const std::string& scattering, const std::string& absorption,
                        double g) {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [" + scattering +
         "] \"rgb sigma_a\" [" + absorption + "] \"float g\" " + std::to_string(g) + "\n";
}

std::string Room(const std::string& film, int depth) {
  return FilmWith(film) + kInRoom + kView + World(depth) + kRoom;
}

// 4 × 4 × 4 values that differ from cell to cell, some of them 0.
std::string Densities(int channels) {
  std::string values;
  for (int i = 0; i < 64 * channels; ++i)
    values += std::to_string((i * 37 % 11) * 0.1 - (i % 5 == 0 ? 0 : 0.02) > 0.1 ? (i * 37 % 11) * 0.1 : 0.0) + " ";
  return values;
}
const std::string kExtent =
    "\"integer nx\" 4 \"integer ny\" 4 \"integer nz\" 4 \"point3 p0\" [-0.5 -0.8 -0.9] \"point3 p1\" [0.5 0.2 0.1]";

}  // namespace

std::vector<MediaScene> MediaScenes() {
  std::vector<MediaScene> scenes;
  const auto add = [&](const char* name, std::string text) -> MediaScene& {
    MediaScene scene;
    scene.name = name;
    scene.text = std::move(text);
    return scenes.emplace_back(scene);
  };
  add("fog", FilmWith("gaussian") + kInRoom + kFog + "MediumInterface \"\" \"fog\"\n" + kView + World(4) + kRoom +
                 kBulb + kPoint)
      .isCameraInMedium = true;
  add("ball_of_colours",
      Room("box", 4) + Homogeneous("jelly", "3 1 0.4", "0.1 0.6 1.5", -0.4) + BallOf("jelly") + kBulb + kPoint);
  add("absorbing", Room("gaussian", 3) + Homogeneous("ink", "0 0 0", "0.4 1 2.5", 0) + BallOf("ink") + kBulb);
  add("smoke", Room("gaussian", 4) + "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" " + kExtent +
                   " \"rgb sigma_s\" [6 6 6] \"rgb sigma_a\" [1 1 1] \"float g\" 0.4 \"float density\" [" +
                   Densities(1) + "]\n" + BoxOf("smoke") + kBulb + kPoint);
  add("coloured_grid", Room("box", 4) + "MakeNamedMedium \"smoke\" \"string type\" \"rgbgrid\" " + kExtent +
                           " \"float scale\" 4 \"rgb sigma_s\" [" + Densities(3) + "] \"rgb sigma_a\" [" +
                           Densities(3) + "]\n" + BoxOf("smoke") + kBulb);
  add("ball_in_fog", FilmWith("box") + kInRoom + kFog + Homogeneous("milk", "5 5 5", "0 0.1 0.3", 0.6) +
                         "MediumInterface \"\" \"fog\"\n" + kView + World(4) + kRoom + BallOf("milk", "fog") + kBulb)
      .isCameraInMedium = true;
  // A scene by wavelength: the coefficients of the medium and the lamp are spectra, the rough glass disperses.
  add("dispersion_in_haze",
      Room("box", 4) +
          "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"spectrum sigma_s\" [400 2 550 1.2 700 0.8] "
          "\"rgb sigma_a\" [0.1 0.3 0.6] \"float g\" 0.3\n" +
          BallOf("haze", "", "\"dielectric\" \"float cauchy\" [1.3 0.1] \"float roughness\" 0.3") +
          "AttributeBegin AreaLightSource \"diffuse\" \"blackbody L\" 4000 \"float scale\" 40 Translate 0.5 0.6 0.3 "
          "Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n");
  add("rough_glass_of_juice", Room("gaussian", 5) + Homogeneous("juice", "0.5 0.5 0.5", "0.2 1 2", 0.2) +
                                  BallOf("juice", "", "\"dielectric\" \"float eta\" 1.33 \"float roughness\" 0.3") +
                                  kBulb);
  add("lamp_in_haze", Room("box", 4) + Homogeneous("haze", "2 2 2", "0.2 0.2 0.2", 0.5) + BallOf("haze") +
                          "MediumInterface \"\" \"haze\"\nAttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [30 20 "
                          "10] Translate 0 -0.2 -0.3 Shape \"sphere\" \"float radius\" 0.08 AttributeEnd\n");
  MediaScene& spot =
      add("spot_in_fog",
          FilmWith("gaussian") + kInRoom + kFog + "MediumInterface \"\" \"fog\"\n" + kView + World(3) + kRoom +
              "LightSource \"spot\" \"rgb I\" [4 4 4] \"point3 from\" [0.6 0.8 -0.2] \"point3 to\" [-0.2 -0.8 -0.4] "
              "\"float coneangle\" 30 \"float conedeltaangle\" 10\n");
  spot.isCameraInMedium = true;
  spot.pathFactor = 8;
  add("sun_on_cloud", FilmWith("box") + kDown + World(4) + Homogeneous("cloud", "3 3 3", "0.05 0.05 0.05", 0.7) +
                          kThings +
                          "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [1 2 0.5]\n"
                          "LightSource \"infinite\" \"rgb L\" [0.2 0.3 0.5]\n"
                          "AttributeBegin Material \"interface\" MediumInterface \"cloud\" \"\" Translate 0 "
                          "0.9 0 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n");
  // All that the sampling of distances for a light meets: a lamp of several patches that shines
  // to both sides, a moving one, a filtered one, lights at infinity, a second medium and empty space on the ray.
  add("lights_in_haze",
      FilmWith("gaussian") + Homogeneous("haze", "0.12 0.15 0.2", "0.02 0.02 0.01", 0.2) +
          Homogeneous("jelly", "2 1 0.5", "0.1 0.4 1", -0.3) + "MediumInterface \"\" \"haze\"\n" + kDown + World(4) +
          kThings +
          "LightSource \"distant\" \"rgb L\" [0.6 0.5 0.4] \"point3 from\" [1 2 0.5]\n"
          "LightSource \"infinite\" \"rgb L\" [0.1 0.15 0.2]\n"
          "AttributeBegin Translate 0.9 1 0.2 ActiveTransform EndTime Translate 0 0.3 0.3 ActiveTransform All "
          "LightSource \"point\" \"rgb I\" [0.5 0.5 0.3] AttributeEnd\n"
          "AttributeBegin LightFilter \"intmult\" \"float intensity\" 2 LightSource \"spot\" \"rgb I\" [2 1 1] "
          "\"point3 from\" [-1 1.6 0.6] \"point3 to\" [0 0.2 0] \"float coneangle\" 35 AttributeEnd\n"
          "AttributeBegin MediumInterface \"haze\" AreaLightSource \"diffuse\" \"rgb L\" [6 5 4] \"bool twosided\" "
          "true\n"
          "Shape \"trianglemesh\" \"point3 P\" [-1 1 -0.6  -0.6 1.3 -0.6  -0.8 1.2 -0.2  0.2 1 -0.9] \"integer "
          "indices\" [0 1 2 1 3 2 0 2 3] AttributeEnd\n"
          "AttributeBegin Material \"interface\" MediumInterface \"jelly\" \"haze\" Translate 0.5 0.9 -0.5 Shape "
          "\"sphere\" \"float radius\" 0.3 AttributeEnd\n"
          "AttributeBegin Material \"interface\" MediumInterface \"\" \"haze\" Translate -0.2 1.1 0.4 Shape "
          "\"sphere\" \"float radius\" 0.3 AttributeEnd\n")
      .isCameraInMedium = true;
  // Light through a ball of glass, in haze: vcm finds it by beams of photons.
  MediaScene& glass = add("glass_in_haze", FilmWith("gaussian") + kInRoom +
                                               Homogeneous("haze", "0.15 0.2 0.25", "0.02 0.02 0.02", 0.3) +
                                               "MediumInterface \"\" \"haze\"\n" + kView + World(5) + kRoom +
                                               BallOf("", "haze", "\"dielectric\" \"float eta\" 1.5") + kBulb);
  glass.isCameraInMedium = true;
  glass.lightTracerSeesAll = false;
  add("orthographic_fog",
      FilmWith("gaussian") + "LookAt 0 0 0.9  0 -0.2 -1  0 1 0\n" + kFog +
          "MediumInterface \"\" \"fog\"\nCamera \"orthographic\" \"float screenwindow\" [-0.8 0.8 -0.8 0.8]\n" +
          World(3) + kRoom + kBulb)
      .isCameraInMedium = true;
  add("glow", Room("box", 4) +
                  "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1] \"rgb sigma_a\" "
                  "[2 2 2] \"rgb Le\" [1 0.6 0.3]\n" +
                  BallOf("fire"))
      .hasLights = false;
  // A lamp behind a cut-out and a coloured pane, through which the camera sees it.
  add("lamp_behind_panes",
      Room("box", 3) + Homogeneous("jelly", "3 1 0.4", "0.1 0.6 1.5", -0.4) + BallOf("jelly") + kBulb +
          "AttributeBegin Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-0.1 0.1 0.2  0.4 0.1 0.2  -0.1 "
          "0.8 "
          "0.2  0.4 0.8 0.2] \"float alpha\" 0.5\nMaterial \"thindielectric\" \"rgb transmittance\" [0.8 0.3 0.5] "
          "Shape "
          "\"bilinearmesh\" \"point3 P\" [0.1 0 0.1  0.6 0 0.1  0.1 0.5 0.1  0.6 0.5 0.1] AttributeEnd\n");
  // Light comes through a cut-out, by wavelength.
  add("cut_out_by_wavelength",
      Room("box", 3) +
          "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"spectrum sigma_s\" [400 2 550 1.2 700 0.8] "
          "\"rgb sigma_a\" [0.1 0.3 0.6] \"float g\" 0.3\n" +
          BallOf("haze") + kPoint +
          "AttributeBegin Material \"dielectric\" \"float cauchy\" [1.3 0.1] \"float roughness\" 0.3 Translate 0.6 "
          "-0.8 0 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n"
          "AttributeBegin Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-0.9 0.35 -0.9  0.9 0.35 -0.9  "
          "-0.9 "
          "0.35 0.5  0.9 0.35 0.5] \"float alpha\" 0.75 AttributeEnd\n");
  // Fog on both sides of a portal: nothing scatters the sky's light before it has come through.
  add("sky_through_portal",
      FilmWith("box") + "LookAt 0 1 -2.4  0 0 0  0 1 0\n" + kView + World(3) +
          Homogeneous("haze", "0.6 0.6 0.6", "0.05 0.05 0.05", 0.2) +
          "LightSource \"infinite\" \"rgb L\" [1 1 1] \"bool cameraVisible\" false \"point3 portal\" [-0.5 0.9 -0.5  "
          "0.5 "
          "0.9 -0.5  0.5 0.9 0.5  -0.5 0.9 0.5]\n"
          "AttributeBegin Material \"interface\" MediumInterface \"haze\" \"\" Translate 0 0.7 0 Shape \"sphere\" "
          "\"float "
          "radius\" 0.8 AttributeEnd\n"
          "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-2 -0.5 2  2 -0.5 2  -2 -0.5 -2  2 -0.5 -2]\n");
  // The media in which paths start, of lights and of the camera, change while the shutter is open.
  const std::string moves =
      "ActiveTransform StartTime Translate -2 0 0 ActiveTransform EndTime Translate 2 0 0 "
      "ActiveTransform All ";
  const std::string floor =
      "AttributeBegin Translate 0 -1.3 0 Rotate 90 1 0 0 Material \"diffuse\" Shape \"disk\" \"float radius\" 3 "
      "AttributeEnd\n";
  const std::string aside = FilmWith("box") + "LookAt 0 0.5 -4  0 -0.6 0  0 1 0\n" + kView + World(3);
  add("lamps_move_through_fog",
      aside + Homogeneous("ink", "0 0 0", "0.3 0.5 0.7", 0) + floor +
          "AttributeBegin Material \"interface\" MediumInterface \"ink\" \"\" Shape \"sphere\" \"float radius\" 1 "
          "AttributeEnd\n"
          "AttributeBegin " +
          moves +
          "LightSource \"point\" \"rgb I\" [2 2 2] Translate 0 0.3 0.2 AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] "
          "Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n")
      .samples = 128;
  add("fog_moves_over_lamp_and_camera", FilmWith("box") + "LookAt 0 0 -2.4  0 -0.6 0  0 1 0\n" + kView + World(2) +
                                            Homogeneous("ink", "0 0 0", "1 1.5 2", 0) + floor +
                                            "LightSource \"point\" \"rgb I\" [1 1 1]\nAttributeBegin " + moves +
                                            "Material \"interface\" MediumInterface \"ink\" \"\" Shape \"sphere\" "
                                            "\"float radius\" 0.8 Translate 0 0 -2.4 "
                                            "Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n");
  // The boundary of a medium cuts the lens, and the plane from which parallel rays start.
  add("lens_in_ink",
      FilmWith("box") +
          "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.5 "
          "\"float focaldistance\" 3\n" +
          World(2) + Homogeneous("ink", "0 0 0", "1 1.5 2", 0) + kWall + kPoint +
          "AttributeBegin Material \"interface\" MediumInterface \"ink\" \"\" Translate 0 -10.1 -3 Shape \"sphere\" "
          "\"float radius\" 10 AttributeEnd\n");
  add("ink_before_parallel_rays",
      FilmWith("box") + "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n" +
          World(2) + Homogeneous("ink", "0 0 0", "10 15 20", 0) + kWall + kPoint +
          "AttributeBegin Material \"interface\" MediumInterface \"ink\" \"\" Translate 0.2 0.22 -3 Shape \"sphere\" "
          "\"float radius\" 0.12 AttributeEnd\n")
      .blockSize = 4;
  add("smooth_glass_of_juice", Room("box", 5) + Homogeneous("juice", "0.5 0.5 0.5", "0.2 1 2", 0.2) +
                                   BallOf("juice", "", "\"dielectric\" \"float eta\" 1.33") + kBulb)
      .lightTracerSeesAll = false;
  return scenes;
}

}  // namespace lampyr::test
