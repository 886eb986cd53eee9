#include "detection/subjects.h"

#include <stdexcept>

#include "agreement/agreement_scenes.h"

namespace lampyr::test {

namespace {

// Unlike multipliers, so that taking one for the other shows.
const std::string kSplit = "\"float diffuse\" 0.5 \"float specular\" 2 ";

// Light statement of a subject, in the current transform.
std::string Statement(const LightSubject& subject, const std::string& type) {
  if (!subject.isOnShape) return "LightSource \"" + type + "\" " + subject.parameters + "\n";
  return "AreaLightSource \"" + type + "\" " + subject.parameters +
         "\nMaterial \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2]\nShape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 "
         "0  1 1 0  -1 1 0] \"integer indices\" [0 2 1 0 3 2]\n";
}

std::string Within(const std::string& placement, const std::string& before, const std::string& statement) {
  return "AttributeBegin\n" + placement + before + statement + "AttributeEnd\n";
}

template <class Subject>
const Subject& FindByName(const std::vector<Subject>& subjects, const std::string& name) {
  for (const Subject& subject : subjects) {
    if (subject.name == name) return subject;
  }
  throw std::invalid_argument("there is no subject \"" + name + "\"");
}

}  // namespace

const std::vector<LightSubject>& LightSubjects() {
  static const std::vector<LightSubject> subjects = {
      {"rect", "rect", false, false, "\"float width\" 1.4 \"float height\" 0.8 \"float intensity\" 3 " + kSplit},
      {"disk", "disk", false, false, "\"float radius\" 0.6 \"float exposure\" 1 " + kSplit},
      {"hidden disk", "disk", false, false, "\"float radius\" 0.6 \"bool cameraVisible\" false " + kSplit},
      {"square", "diffuse", true, false, kSplit},
      {"point", "point", false, false, "\"rgb I\" [ 3 2 1 ] " + kSplit},
      {"spot", "spot", false, false, "\"float coneangle\" 50 " + kSplit},
      {"parallel", "distant", false, true, kSplit},
      {"sun", "distant", false, true, "\"float angle\" 40 " + kSplit},
      {"dome", "dome", false, true, "\"string texture:file\" \"suite-latlong.exr\" " + kSplit},
      {"portal", "portal", false, true, "\"float width\" 2 \"float height\" 2 " + kSplit},
  };
  return subjects;
}

const std::vector<FilterSubject>& FilterSubjects() {
  static const std::vector<FilterSubject> subjects = {
      {"blocker", "blocker", "\"float radius\" 0.6 \"float edge\" 0.4 "},
      {"intmult", "intmult", "\"float intensity\" 0.7 \"rgb tint\" [ 1 0.6 0.8 ] "},
      {"ramp", "ramp", "\"float begin\" 0.3 \"float end\" 2 "},
      {"barn", "barn", "\"float width\" 1.2 \"float height\" 1 \"float edge\" 0.3 "},
  };
  return subjects;
}

const LightSubject& FindLightSubject(const std::string& name) {
  return FindByName(LightSubjects(), name);
}
const FilterSubject& FindFilterSubject(const std::string& name) {
  return FindByName(FilterSubjects(), name);
}

std::string FurnaceScene(const LightSubject& subject, const std::string& type, const std::string& before) {
  const std::string white = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n";
  if (subject.isInfinite) {
    return "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n" + FilmWith("box", 16, 16) +
           World(8) + Within("Translate 0 2.5 0 " + kFacesDown, before, Statement(subject, type)) + white +
           "Shape \"sphere\" \"float radius\" 1\n";
  }
  const std::string corners = "-3 -3 -3  3 -3 -3  3 3 -3  -3 3 -3  -3 -3 3  3 -3 3  3 3 3  -3 3 3";
  return "LookAt 1.5 1.2 -2  0 0 0  0 1 0\nCamera \"spherical\"\n" + FilmWith("box", 16, 16) + World(12) +
         Within("", before, Statement(subject, type)) + white + "Shape \"trianglemesh\" \"point3 P\" [" + corners +
         "] \"integer indices\" [0 1 2 0 2 3  4 6 5 4 7 6  0 5 1 0 4 5  3 2 6 3 6 7  0 3 7 0 7 4  1 5 6 1 6 2]\n";
}

std::string TileScene(const LightSubject& subject, const std::string& type, const std::string& before) {
  const std::string statement = Statement(subject, type);
  if (subject.isInfinite) {
    return FilmWith("box") + kDown + World(3) + Within("Translate 0 2.5 0 " + kFacesDown, before, statement) + kThings;
  }
  return FilmWith("box") + kSeesLamp + World(3) + kBackdrop + kThings +
         Within("Translate 0 1.4 0 " + kFacesDown + "Scale 0.4 0.4 0.4\n", before, statement);
}

}  // namespace lampyr::test
