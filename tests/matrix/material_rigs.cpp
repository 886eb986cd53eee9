// Materials, every one of them mixed with a matte one as well; maps of normals and heights, sheets, cut-outs. A closed
// room shows a material to photons and paths at every bounce. What is smooth stands in the room as an object that the
// camera does not see, too: light tracing has its part in those.
#include <cmath>

#include <fstream>

#include "matrix/matrix_rigs.h"
#include "support/measured_writer.h"
#include "support/temporary_folder.h"

namespace lampyr::test {

using namespace rigs;

namespace {

struct Sample {
  std::string type, name, parameters;
  bool isSmooth = false;  // deltas alone
  bool hasDelta = false;  // beside others
};

// A brushed metal as a file, which is there until the process ends.
std::string MeasuredFile() {
  static const TemporaryFolder folder;
  const std::filesystem::path file = folder / "brushed.bsdf";
  MeasuredMetal metal;
  metal.microfacets = TrowbridgeReitz(0.4f, 0.6f);
  metal.phiCount = 13;
  metal.thetaCount = 8;
  metal.side = 24;
  const std::string bytes = TensorFile(MeasuredFieldsOf(metal));
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file.string();
}

const std::vector<Sample>& MaterialSamples() {
  static const std::vector<Sample> samples = {
      {"diffuse", "matte", "\"rgb reflectance\" [0.7 0.6 0.5]"},
      {"diffusetransmission", "leaf", "\"rgb reflectance\" [0.5 0.4 0.3] \"rgb transmittance\" [0.2 0.3 0.4]"},
      {"conductor", "rough_metal", "\"rgb reflectance\" [0.8 0.7 0.6] \"float roughness\" 0.5"},
      {"conductor", "mirror", "\"rgb reflectance\" [0.9 0.8 0.7] \"float roughness\" 0", true},
      {"dielectric", "rough_glass", "\"float eta\" 1.5 \"float roughness\" 0.5"},
      {"dielectric", "glass", "\"float eta\" 1.5 \"float roughness\" 0", true},
      {"dielectric", "dispersive_rough_glass", "\"float cauchy\" [1.3 0.1] \"float roughness\" 0.5"},
      {"dielectric", "dispersive_glass", "\"float cauchy\" [1.3 0.1] \"float roughness\" 0", true},
      {"thindielectric", "pane", "\"float eta\" 1.5 \"rgb transmittance\" [0.9 0.7 0.8]", true},
      {"coateddiffuse", "varnish", "\"rgb reflectance\" [0.6 0.5 0.4] \"float roughness\" 0", false, true},
      {"coateddiffuse", "satin", "\"rgb reflectance\" [0.6 0.5 0.4] \"float roughness\" 0.4"},
      {"coatedconductor", "lacquer", "\"float conductor.roughness\" 0.5 \"float interface.roughness\" 0", false, true},
      {"coatedconductor", "smooth_lacquer", "\"float conductor.roughness\" 0 \"float interface.roughness\" 0", true},
      {"measured", "measured_metal", "\"string filename\" \"" + MeasuredFile() + "\""},
      {"interface", "boundary", "", true},
  };
  return samples;
}

std::string Statement(const Sample& sample) {
  return "Material \"" + sample.type + "\" " + sample.parameters + " ";
}
std::string Named(const Sample& sample) {
  return "MakeNamedMaterial \"" + sample.name + "\" \"string type\" \"" + sample.type + "\" " + sample.parameters +
         "\n";
}
std::string Mix(const std::string& name, const std::string& a, const std::string& b, double amount) {
  return "MakeNamedMaterial \"" + name + "\" \"string type\" \"mix\" \"string materials\" [ \"" + a + "\" \"" + b +
         "\" ] \"float amount\" " + std::to_string(amount) + "\n";
}

// In the room, between the lamp and what is seen, and itself not seen.
std::string Object(const std::string& material) {
  return Scope(material + " Translate -0.15 0.5 0.55 Shape \"sphere\" \"float radius\" 0.25");
}

// Strands over the floor, side by side and crossing: light that meets the floor has passed some, and they light one
// another. They are thin: a fibre scatters light from wherever it meets it. They are so high over the floor that their
// shadows run together: merging blurs a pattern of shadows as fine as its radius, and the camera, which stands near the
// lamp, sees more of the lit parts than of the shadows.
std::string Strands(const std::string& material, const std::string& type) {
  std::string curves;
  for (int i = 0; i < 40; ++i) {
    const double t = i / 40.0, x = -0.75 + 1.1 * t, bend = 0.1 * std::sin(40 * t), height = 0.32 + 0.08 * (i % 4);
    const auto at = [](double a, double b, double c) {
      return std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " ";
    };
    curves += "Shape \"curve\" \"string type\" \"" + type + "\" \"float width\" 0.014 \"point3 P\" [ " +
              at(x, height, -0.5) + at(x + bend, height + 0.1, -0.1) + at(x - bend, height, 0.3) +
              at(x + 2 * bend, height + 0.05, 0.8) + "]\n";
  }
  return Scope(material + curves);
}

const std::string kMatteNamed =
    "MakeNamedMaterial \"white\" \"string type\" \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n";

}  // namespace

void AddMaterialRigs(std::vector<Rig>& rigs) {
  for (const Sample& sample : MaterialSamples()) {
    const std::string what = "material " + sample.type;
    const bool hasDelta = sample.isSmooth || sample.hasDelta;
    // Walls that all light passes would show nothing; a mirror without end shows the lamp alone.
    if (!sample.isSmooth)
      rigs.push_back({sample.name + "_walls", Room(Statement(sample), Lamp()), {what}, sample.hasDelta});
    if (!hasDelta) continue;
    rigs.push_back({sample.name + "_object", Room(kMatte, Lamp() + Object(Statement(sample))), {what}});
    const std::string mixed = kMatteNamed + Named(sample) + Mix("both", "white", sample.name, 0.5);
    const std::vector<std::string> covers = {what + " in mix", "material mix"};
    rigs.push_back(
        {"mix_with_" + sample.name + "_walls", Room("NamedMaterial \"both\"", mixed + Lamp()), covers, true});
    rigs.push_back({"mix_with_" + sample.name + "_object",
                    Room(kMatte, mixed + Lamp() + Object("NamedMaterial \"both\"")), covers});
  }
  // Other names of materials, and mixes of rough ones.
  rigs.push_back(
      {"boundaries",
       Room(kMatte, Lamp() +
                        Scope("Material \"none\" Translate 0 0.3 0.4 Shape \"sphere\" \"float radius\" "
                              "0.2") +
                        Scope("Material \"\" Translate -0.6 -0.2 0.3 Shape \"sphere\" \"float radius\" 0.2")),
       {"material none", "material "}});
  std::string rough = kMatteNamed;
  for (const Sample& sample : MaterialSamples()) {
    if (!sample.isSmooth && !sample.hasDelta) rough += Named(sample);
  }
  rough += Mix("a", "matte", "leaf", 0.5) + Mix("b", "rough_metal", "rough_glass", 0.3) + Mix("c", "a", "b", 0.4) +
           Mix("e", "c", "satin", 0.3) + Mix("d", "e", "measured_metal", 0.2);
  rigs.push_back({"mix_of_what_is_rough",
                  Room("NamedMaterial \"d\"", rough + Lamp()),
                  {"material diffuse in mix", "material diffusetransmission in mix", "material conductor in mix",
                   "material dielectric in mix", "material coateddiffuse in mix", "material measured in mix"}});
  // Hair on walls scatters by their coordinates; strands are fibres.
  const Sample hair{"hair", "hair",
                    "\"rgb sigma_a\" [0.1 0.3 0.6] \"float beta_m\" 0.5 \"float beta_n\" 0.6 \"float alpha\" 5"};
  const std::string hairMix = kMatteNamed + Named(hair) + Mix("both", "white", "hair", 0.5);
  rigs.push_back({"hair_walls", Room(Statement(hair), Lamp()), {"material hair"}});
  rigs.push_back({"mix_with_hair_walls",
                  Room("NamedMaterial \"both\"", hairMix + Lamp()),
                  {"material hair in mix", "material mix"}});
  for (const char* type : {"cylinder", "flat"}) {
    rigs.push_back({std::string("hair_strands_") + type,
                    Floor(Lamp("-0.2 1 0.3", 0.2) + Strands(Statement(hair), type), "", 0.014),
                    {"material hair"}});
  }
  const Sample mirror = MaterialSamples()[3], glass = MaterialSamples()[5];
  const std::string nested = kMatteNamed + Named(mirror) + Named(glass) + Mix("inner", "white", "mirror", 0.4) +
                             Mix("outer", "glass", "inner", 0.7);
  Rig walls{"mix_of_mixes_walls", Room("NamedMaterial \"outer\"", nested + Lamp()), {"material mix in mix"}};
  walls.cameraSeesDeltas = true;
  rigs.push_back(walls);
  rigs.push_back({"mix_of_mixes_object",
                  Room(kMatte, nested + Lamp() + Object("NamedMaterial \"outer\"")),
                  {"material mix in mix"}});
  // A share that varies over the surface, and reaches both ends.
  const std::string spots =
      "Texture \"share\" \"float\" \"checkerboard\" \"float uscale\" 6 \"float vscale\" 6 \"float tex1\" 1 \"float "
      "tex2\" 0.3\nMakeNamedMaterial \"both\" \"string type\" \"mix\" \"string materials\" [ \"white\" \"mirror\" ] "
      "\"texture amount\" \"share\"\n";
  walls = {"mix_by_texture_walls",
           Room("NamedMaterial \"both\"", kMatteNamed + Named(mirror) + spots + Lamp()),
           {"material mix by texture"}};
  walls.cameraSeesDeltas = true;
  rigs.push_back(walls);

  const std::string source = LAMPYR_SOURCE_DIR "/scenes/data/";
  // The correction of importance for shading normals has no bound: light that grazes the surface twice is rare and
  // much.
  rigs.push_back({"normal_map",
                  Room("Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5] \"string normalmap\" \"" + source +
                           "paving-normal.png\"",
                       Lamp(), kCamera, 2),
                  {"normal map"}});
  rigs.push_back({"normal_map_on_metal",
                  Room("Material \"conductor\" \"float roughness\" 0.5 \"rgb reflectance\" [0.8 0.7 0.6] \"string "
                       "normalmap\" \"" +
                           source + "paving-normal.png\"",
                       Lamp(), kCamera, 2),
                  {"normal map"}});
  const std::string bumps =
      "Texture \"waves\" \"float\" \"wrinkled\" \"integer octaves\" 3\nTexture \"bumps\" \"float\" \"scale\" "
      "\"texture tex\" \"waves\" \"float scale\" 0.05\n";
  rigs.push_back({"bump_map",
                  Room("Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5] \"texture displacement\" \"bumps\"",
                       bumps + Lamp()),
                  {"bump map"}});
  rigs.push_back({"interpolated_normals",
                  Floor(Lamp("-0.2 1 0.3"), "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]") +
                      Scope("Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6] Translate -0.35 0.02 0.3 Shape "
                            "\"trianglemesh\" \"point3 P\" [-.3 0 -.3 .3 0 -.3 .3 0 .3 -.3 0 .3] \"normal N\" [-.6 1 "
                            "-.6 .6 1 -.6 .6 1 .6 -.6 1 .6] \"integer indices\" [0 2 1 0 3 2]"),
                  {"shading normals"}});

  const std::string sheet = "Translate 0 0.15 0.2 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 0.6 ";
  rigs.push_back({"thin_surface",
                  Room(kMatte, Lamp("0.1 0.55 0.2") +
                                   Scope("Material \"thindielectric\" \"rgb transmittance\" [0.9 0.6 0.7] " + sheet) +
                                   Scope("Material \"thindielectric\" Translate 0 -0.1 0 " + sheet)),
                  {"thin surface", "material thindielectric"}});
  const std::string holes =
      "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 4 \"float tex1\" 0.8 \"float "
      "tex2\" 0.1\n";
  // Balls: photons near the rim of something flat would be missed.
  rigs.push_back({"cut_out",
                  Room(kMatte, holes + Lamp("0.1 0.6 0.2") +
                                   Scope("Material \"diffuse\" Translate 0 0 0.2 Shape \"sphere\" \"float "
                                         "radius\" 0.3 \"texture alpha\" \"holes\"")),
                  {"cut-out"}});
  const std::string seen =
      "Material \"diffuse\" \"rgb reflectance\" [0.2 0.7 0.3] Translate -0.3 0.25 0.25 Shape \"sphere\" \"float "
      "radius\" 0.2 ";
  rigs.push_back({"cut_out_seen", Floor(Lamp("-0.2 1 0.3") + Scope(seen + "\"float alpha\" 0.4")), {"cut-out"}});
  rigs.push_back({"cut_out_by_texture_seen",
                  Floor(Lamp("-0.2 1 0.3") + holes + Scope(seen + "\"texture alpha\" \"holes\"")),
                  {"cut-out"}});
  const std::string facing =
      "Texture \"facing\" \"float\" \"directionmix\" \"float tex1\" 0.9 \"float tex2\" 0.3 \"vector3 dir\" [1 2 0]\n"
      "Texture \"cap\" \"spectrum\" \"directionmix\" \"rgb tex1\" [0.8 0.4 0.2] \"rgb tex2\" [0.2 0.3 0.7]\n";
  rigs.push_back({"direction_mix",
                  Room(kMatte, facing + Lamp("0.1 0.6 0.2") +
                                   Scope("Material \"diffuse\" \"texture reflectance\" \"cap\" Translate 0 0 0.2 Shape "
                                         "\"sphere\" \"float radius\" 0.3 \"texture alpha\" \"facing\"")),
                  {"cut-out", "directionmix"}});
  rigs.push_back({"cut_out_lamp",
                  Room(kMatte, holes + Scope("Translate 0.1 0.5 0.2 Material \"diffuse\" "
                                             "AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] Shape "
                                             "\"sphere\" \"float radius\" 0.3 \"texture alpha\" "
                                             "\"holes\"")),
                  {"cut-out"}});
}

}  // namespace lampyr::test
