// Scenes whose parts name one another. The input is a program of records of four bytes, so that a change of a byte is a
// change of the graph and not a mistake of spelling: what is done, what two earlier (or later) things are named, and
// how often the statement is repeated, each time naming the one before.
#include <array>
#include <string>

#include "fuzz/target_support.h"

namespace lampyr::fuzz {

namespace {

enum Family { Filters, FloatTextures, SpectrumTextures, Materials, Objects, Groups, kFamilies };

class GraphScene {
 public:
  void Add(const std::array<unsigned char, 4>& record) {
    // 1 to 1984 times; mostly few. Shapes that one ray asks for their alpha are few: each may take as long as the limit
    // of evaluations allows, and that is no hang.
    const bool isCutOut = record[0] % kStatements == kCutOut;
    const unsigned times = record[3] < 192 || isCutOut ? 1 + record[3] % 8 : 1 + 31 * (record[3] - 192u);
    for (unsigned i = 0; i < times && statements_ < kMostStatements; ++i) {
      ++statements_;
      AddStatement(record[0], record[1], record[2]);
    }
  }

  std::string Text() const {
    return "Film \"rgb\" \"integer xresolution\" 3 \"integer yresolution\" 3\nCamera \"perspective\" \"float fov\" "
           "20\nWorldBegin\nMakeNamedMaterial \"gray\" \"string type\" \"diffuse\"\n" +
           world_ + "LightSource \"point\" \"point3 from\" [ 0 0 1 ]\nTranslate 0 0 5\nShape \"sphere\"\n";
  }

 private:
  static constexpr unsigned kMostStatements = 4000;
  static constexpr unsigned kStatements = 24, kCutOut = 17;  // kinds, and one of them

  // A new name of the family.
  std::string New(Family family) { return "\"" + std::to_string(counts_[family]++) + "\" "; }
  // 0 is the newest, 1 the one before; from 224 on it is one that is yet to come, itself first.
  std::string Old(Family family, unsigned back) const {
    const unsigned count = counts_[family];
    if (back >= 224) return "\"" + std::to_string(count + back - 224) + "\" ";
    return "\"" + std::to_string(count > 0 ? count - 1 - back % count : 0) + "\" ";
  }
  std::string Both(Family family, unsigned a, unsigned b) const {
    return "[ " + Old(family, a) + Old(family, b) + "] ";
  }
  void Say(const std::string& statement) { world_ += statement + "\n"; }

  void AddStatement(unsigned what, unsigned a, unsigned b) {
    const char* modes[] = {"multiply", "max", "min", "screen"};
    // A statement names only objects that precede it.
    const std::string filters = Both(Filters, a, b), materials = Both(Materials, a, b), object = Old(Objects, a);
    const std::string floatA = Old(FloatTextures, a), floatB = Old(FloatTextures, b);
    const std::string colorA = Old(SpectrumTextures, a), colorB = Old(SpectrumTextures, b);
    // Objects may hold none, one or two.
    std::string instances;
    for (const unsigned back : {a, b}) {
      if (back < 128 || back >= 224) instances += "ObjectInstance " + Old(Objects, back);
    }
    switch (what % kStatements) {
      case 0:
        return Say("LightFilter \"rod\" \"string name\" " + New(Filters) + "\"string combineMode\" \"" + modes[a % 4] +
                   "\"");
      case 1:
        return Say("LightFilter \"combiner\" \"string name\" " + New(Filters) + "\"string filters\" " + filters);
      case 2:
        return Say("LightFilter \"combiner\" \"string name\" " + New(Filters) + "\"string filters\" " + filters +
                   "\"string mode\" \"" + modes[(a + b) % 4] + "\"");
      case 3:
        return Say("LightFilter \"intmult\" \"string linkingGroups\" " + New(Groups) + "\"string name\" " +
                   New(Filters));
      case 4:
        return Say("LightFilter \"none\"");
      case 5:
        return Say("Texture " + New(FloatTextures) + "\"float\" \"fbm\"");
      case 6:
        return Say("Texture " + New(FloatTextures) + "\"float\" \"scale\" \"texture tex\" " + floatA +
                   "\"texture scale\" " + floatB);
      case 7:
        return Say("Texture " + New(FloatTextures) + "\"float\" \"mix\" \"texture tex1\" " + floatA +
                   "\"texture amount\" " + floatB);
      case 8:
        return Say("Texture " + New(SpectrumTextures) + "\"spectrum\" \"checkerboard\" \"texture tex1\" " + colorA);
      case 9:
        return Say("Texture " + New(SpectrumTextures) + "\"spectrum\" \"mix\" \"texture tex1\" " + colorA +
                   "\"texture tex2\" " + colorB + "\"texture amount\" " + floatA);
      case 10:
        return Say("Texture " + New(SpectrumTextures) + "\"spectrum\" \"marble\"");
      case 11:
        return Say("Texture " + New(FloatTextures) + "\"float\" \"constant\" \"float value\" 0.5");
      case 12:
        return Say("MakeNamedMaterial " + New(Materials) + "\"string type\" \"diffuse\" \"texture reflectance\" " +
                   colorA);
      case 13:
        return Say("MakeNamedMaterial " + New(Materials) + "\"string type\" \"mix\" \"string materials\" " + materials);
      case 14:
        return Say("MakeNamedMaterial " + New(Materials) + "\"string type\" \"mix\" \"string materials\" [ \"gray\" " +
                   Old(Materials, a) + "] \"texture amount\" " + floatB);
      case 15:
        return Say("MakeNamedMaterial " + New(Materials) + "\"string type\" \"conductor\" \"texture roughness\" " +
                   floatA);
      case 16:
        return Say("NamedMaterial " + Old(Materials, a));
      case kCutOut:
        return Say("Translate 0 0 0.1 Shape \"sphere\" \"texture alpha\" " + floatA);
      case 18:
        return Say("ObjectBegin " + New(Objects) + "Shape \"disk\" \"float height\" 2 " + instances + "ObjectEnd");
      case 19:
        return Say("AttributeBegin ActiveTransform EndTime Translate 0.1 0 0 ActiveTransform All ObjectBegin " +
                   New(Objects) + "Shape \"disk\" " + instances + "ObjectEnd AttributeEnd");
      case 20:
        return Say("ObjectInstance " + object);
      case 21:
        return Say("AttributeBegin Attribute \"lightfilter\" \"string subset\" " + Old(Groups, a) +
                   "Attribute \"lighting\" \"string excludesubset\" " + Old(Groups, b) +
                   "Shape \"sphere\" AttributeEnd");
      case 22:
        return Say("LightSource \"point\" \"string name\" " + Old(Groups, a) +
                   "AttributeBegin AreaLightSource \"diffuse\"");
      case 23:
        return Say((a & 1u) != 0 ? "AttributeEnd" : "Import \"part.pbrt\"");
    }
  }

  std::string world_;
  std::array<unsigned, kFamilies> counts_{};
  unsigned statements_ = 0;
};

}  // namespace

bool BuildSceneGraph(std::string_view bytes) {
  GraphScene scene;
  for (size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    std::array<unsigned char, 4> record;
    for (size_t k = 0; k < record.size(); ++k) record[k] = static_cast<unsigned char>(bytes[i + k]);
    scene.Add(record);
  }
  return BuildSceneText(scene.Text());
}

}  // namespace lampyr::fuzz
