// Every type of light with every sample block of its table: the first by itself, the others together, each in its
// place. Lights with a place shine in the closed room, those at infinity on the floor.
#include <array>
#include <cmath>

#include "lights/types/type_registry.h"
#include "matrix/matrix_rigs.h"

namespace lampyr::test {

using namespace rigs;

namespace {

// Blocks that no number of samples that a test can afford gives a mean of to 2 %, and why.
constexpr std::array<std::pair<const char*, const char*>, 4> kLeftOut = {{
    {"suite-bright.exr", "nearly all light in one texel; tests/extremes has it"},
    {"suite-black.exr", "no light at all; tests/extremes has it"},
    {"\"float coneangle\" 0.01", "a beam thinner than a pixel; tests/extremes has it"},
    {"\"float fov\" 1 ", "a beam of one degree; tests/extremes has it"},
}};

bool IsLeftOut(const std::string& block) {
  for (const auto& [text, why] : kLeftOut) {
    if ((block + " ").find(text) != std::string::npos) return true;
  }
  return false;
}

bool IsAtInfinity(const std::string& type) {
  return type == "infinite" || type == "dome" || type == "distant" || type == "portal";
}

// The k-th place in the room, out of sight, or over the floor.
std::string Placement(const std::string& type, const std::string& block, size_t k) {
  // A distant light shines along +z unless it has a "from".
  if (type == "distant" && block.find("point3 from") == std::string::npos) return "Rotate 90 1 0 0 ";
  if (type == "portal") return "Translate -0.1 0.9 0.1 Rotate -90 1 0 0 Scale 0.5 0.5 0.5 ";
  if (IsAtInfinity(type)) return "Rotate -90 1 0 0 ";
  if (k == 0) return "Translate 0.2 0.25 0 Scale 0.25 0.25 0.25 ";
  // Far from the walls, where a light that is near would make a bright spot that nobody samples well.
  const double angle = 0.8 * static_cast<double>(k);
  return "Translate " + std::to_string(0.3 + 0.2 * std::cos(angle)) + " 0.2 " + std::to_string(0.25 * std::sin(angle)) +
         " Rotate " + std::to_string(40 * k) + " 1 2 3 Scale 0.1 0.1 0.1 ";
}

std::string Statement(const LightType& type, const std::string& block, size_t k, const std::string& more = "") {
  const std::string place = Placement(type.name, block, k);
  if (!type.isAreaLight) return Scope(place + "LightSource \"" + type.name + "\" " + block + more);
  return Scope(place + "Material \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2] AreaLightSource \"" + type.name + "\" " +
               block + more +
               (k % 2 == 0 ? " Shape \"sphere\" \"float radius\" 0.8"
                           : " Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 .5] \"integer "
                             "indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1]"));
}

// The whole room is seen: what a light projects has edges, and photons blur one that is the border of the picture out
// of it, or into it.
std::string Lit(const LightType& type, const std::string& lights, double photonRadius = 0.08) {
  return IsAtInfinity(type.name) ? Floor(lights) : Room(kMatte, lights, "Camera \"spherical\"\n", 3, photonRadius);
}

}  // namespace

void AddLightRigs(std::vector<Rig>& rigs) {
  for (const LightType* type : TypeRegistry::BuiltIn().Lights()) {
    const std::string name = (type->isAreaLight ? "area_" : "") + type->name;
    const std::vector<std::string> covers = {std::string(type->isAreaLight ? "area light " : "light ") + type->name};
    std::string others;
    size_t count = 0;
    for (size_t k = 0; k < type->samples.size(); ++k) {
      if (IsLeftOut(type->samples[k])) continue;
      if (count == 0) {
        rigs.push_back({"light_" + name, Lit(*type, Statement(*type, type->samples[k], 0)), covers});
      } else {
        others += Statement(*type, type->samples[k], count);
      }
      ++count;
    }
    // The narrow cones of spots have edges near the borders of the picture's quarters, across which photons are
    // blurred.
    const double photonRadius = type->name == "spot" ? 0.02 : 0.08;
    if (count > 1) rigs.push_back({"light_" + name + "_others", Lit(*type, others, photonRadius), covers});
  }
  // Properties common to all lights: visible to the camera or not, starting paths or not, groups, importance.
  const std::string bulb = "LightSource \"point\" \"rgb I\" [0.5 0.5 1] \"point3 from\" [0.4 -0.3 0.2] ";
  rigs.push_back({"light_seen", Floor(Lamp("-0.35 0.25 0.3", 0.12) + Lamp("-0.1 0.9 0.3", 0.1)), {"light seen"}});
  rigs.push_back({"light_not_seen",
                  Floor(Lamp("-0.35 0.25 0.3", 0.12, "\"bool cameraVisible\" false") + Lamp("-0.1 0.9 0.3", 0.1)),
                  {"light not seen"}});
  rigs.push_back(
      {"light_groups",
       Room(kMatte, Lamp("0.25 0.4 0.1", 0.25, "\"string lightGroup\" \"key\" \"float importanceMultiplier\" 3") +
                        bulb + "\"string lightGroup\" \"fill\""),
       {"light groups"}});
  rigs.push_back(
      {"light_sample_counts",
       Room(kMatte, Lamp("0.25 0.4 0.1", 0.25, "\"integer fixedSampleCount\" 2") + bulb +
                        "\"integer fixedSampleCount\" 3\n" + Lamp("-0.3 -0.2 0.3", 0.15) +
                        Scope("Translate -0.3 0.3 -0.2 AreaLightSource \"diffuse\" \"rgb L\" [2 1 1] \"integer "
                              "fixedSampleCount\" 2 Shape \"trianglemesh\" \"point3 P\" [-.2 -.2 0 .2 -.2 0 .2 .2 0 "
                              "-.1 .3 .1] \"integer indices\" [0 1 2 0 2 3]")),
       {"light sample counts"}});
  // Links: the ball sees one of the two lamps, and the floor the other and half of the sky.
  rigs.push_back({"light_linking",
                  Floor(Scope("LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3] \"string lightGroup\" \"sky\"") +
                            Lamp("-0.2 1 0.3", 0.2, "\"string lightGroup\" \"lamp\"") +
                            "LightSource \"point\" \"rgb I\" [1 0.5 0.5] \"point3 from\" [-0.5 0.8 0] \"string name\" "
                            "\"bulb\"\nAttribute \"lighting\" \"string excludesubset\" [ \"bulb\" ]\n",
                        "Attribute \"lighting\" \"string excludesubset\" [ \"lamp\" ] Material \"diffuse\" \"rgb "
                        "reflectance\" [0.8 0.8 0.8]"),
                  {"light linking"}});
}

void AddFilterRigs(std::vector<Rig>& rigs) {
  const std::string image = "\"string filename\" \"" LAMPYR_SOURCE_DIR "/scenes/data/wood.png\" ";
  const auto filter = [](const std::string& type, const std::string& parameters) {
    return "LightFilter \"" + type + "\" " + parameters + "\n";
  };
  // Over the floor: a panel, and a point beside it, with the same filters.
  const auto lit = [&](const std::string& filters, const std::string& before = "") {
    return Floor(
        Scope("Translate -0.2 1 0.2 Rotate -90 1 0 0 " + filters +
              "LightSource \"rect\" \"float width\" 0.3 \"float height\" 0.2 \"float intensity\" 20") +
            Scope("Translate -0.6 0.9 0.3 Rotate -90 1 0 0 " + filters + "LightSource \"point\" \"rgb I\" [1 1.5 2]") +
            before,
        "Material \"conductor\" \"float roughness\" 0.5 \"rgb reflectance\" [0.8 0.8 0.8] ");
  };
  const auto add = [&](const std::string& name, const std::string& type, const std::string& filters) {
    rigs.push_back({"filter_" + name, lit(filters), {"filter " + type}});
  };
  add("barn", "barn",
      filter("barn",
             "\"float width\" 0.7 \"float height\" 0.6 \"float edge\" 0.3 \"float left\" 0.2 "
             "\"float radius\" 0.1 \"float specular\" 0.5"));
  add("barn_analytic", "barn", filter("barn", "\"string mode\" \"analytic\" \"float radius\" 0.2 \"float edge\" 0.2"));
  add("blocker", "blocker", "Translate 0 0 -0.8 " + filter("blocker", "\"float radius\" 0.4 \"float edge\" 0.3"));
  add("rod", "rod",
      "Translate 0 0 -0.8 " + filter("rod",
                                     "\"float width\" 0.8 \"float depth\" 0.6 \"float edge\" 0.3 "
                                     "\"rgb color\" [0.3 1.6 0.5] \"bool invert\" true"));
  add("ramp", "ramp", filter("ramp", "\"float begin\" 0.6 \"float end\" 1.5"));
  add("ramp_by_angle", "ramp",
      filter("ramp",
             "\"string mode\" \"angle\" \"float end\" 50 \"float knots\" [0 0.5 1] \"rgb colors\" [1 0.2 0.2  1 "
             "1 0.3  0.2 0.4 1]"));
  add("intmult", "intmult",
      filter("intmult", "\"float saturation\" 0.3 \"float exposure\" 0.5 \"rgb tint\" [1 0.5 1]"));
  add("gobo", "gobo", filter("gobo", image + "\"float width\" 1.2 \"float height\" 1.4 \"rgb fill\" [0.1 0.1 0.4]"));
  add("cookie", "cookie", filter("cookie", image + "\"float width\" 0.7 \"float height\" 0.7 \"bool tile\" true"));
  const std::string parts =
      filter("ramp", "\"string name\" \"near\" \"float end\" 1.5 \"string combineMode\" \"max\"") +
      filter("intmult", "\"string name\" \"warm\" \"rgb tint\" [1.3 1 0.6]") +
      filter("barn",
             "\"string name\" \"slot\" \"float width\" 1 \"float height\" 0.5 \"float edge\" 0.5 \"string "
             "combineMode\" \"screen\" \"float density\" 0.6");
  add("combiner", "combiner", parts + filter("combiner", "\"string filters\" [ \"near\" \"slot\" \"warm\" ]"));
  // Off but for the ball, which subscribes.
  const std::string grouped = "Translate 0 0 -0.8 " + filter("blocker",
                                                             "\"float radius\" 0.6 \"float edge\" 0.4 "
                                                             "\"string linkingGroups\" \"dim\"");
  rigs.push_back({"filter_linking",
                  lit(grouped, Scope("Attribute \"lightfilter\" \"string subset\" [ \"dim\" ] Material \"diffuse\" "
                                     "\"rgb reflectance\" [0.7 0.7 0.7] Translate -0.4 0.2 0.3 Shape \"sphere\" "
                                     "\"float radius\" 0.15")),
                  {"filter linking"}});
}

}  // namespace lampyr::test
