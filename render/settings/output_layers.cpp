#include "render/settings/output_layers.h"

#include <algorithm>
#include <map>
#include <set>

#include "film/cryptomatte.h"
#include "lights/services/lighting_services.h"

namespace lampyr {

namespace {

[[noreturn]] void Fail(const FileLocation& where, const std::string& text) {
  if (where.file) throw Error(where, text);
  throw UsageError("--layer: " + text);
}

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

struct Read {
  PathExpression expression;
  std::string text, name;  // name: of a known expression, and of the light that it is limited to
};

// A known expression, perhaps of one light alone, or an expression.
Read ReadExpression(const std::string& text) {
  const size_t pair = text.find('<');
  const NamedExpression* named = FindNamedExpression(Trimmed(text.substr(0, pair)));
  if (!named) {
    if (!text.empty() && text[0] != 'C' && text.find_first_of("<[(.*") == std::string::npos) {
      std::vector<std::string> known;
      for (const NamedExpression& each : NamedExpressions()) known.emplace_back(each.name);
      for (const PixelLayer& each : PixelLayers()) known.emplace_back(each.name);
      known.emplace_back(kStrategies);
      throw Error("there is no layer \"" + text + "\"" + DidYouMean(text, known) +
                  "; an expression starts with the camera, C");
    }
    return {PathExpression(text), text, ""};
  }
  const PathExpression expression(named->text);
  if (pair == std::string::npos) return {expression, named->text, named->name};
  const std::string from = Trimmed(text.substr(pair));
  const std::vector<std::string> lights = PathExpression("C" + from).NamedLights();
  if (lights.size() != 1 || from.find('>') + 1 != from.size())
    throw Error("after \"" + std::string(named->name) + "\" may stand one light alone: <L.'name'>");
  return {expression.OnlyFrom(lights[0]), std::string(named->text) + " from " + from,
          std::string(named->name) + " " + lights[0]};
}

// Where a name ends and an expression starts; npos: there is no name.
size_t EndOfName(const std::string& text) {
  const size_t equals = text.find('=');
  return equals < text.find_first_of("<'\"") ? equals : std::string::npos;
}

}  // namespace

const std::vector<PixelLayer>& PixelLayers() {
  static const std::vector<PixelLayer> layers = {{"albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}},
                                                 {"N", {"N.X", "N.Y", "N.Z"}},
                                                 {"P", {"P.X", "P.Y", "P.Z"}},
                                                 {"Z", {"Z"}},
                                                 {"uv", {"u", "v"}},
                                                 {kObjectMatte, CryptomatteChannels("CryptoObject")},
                                                 {kMaterialMatte, CryptomatteChannels("CryptoMaterial")},
                                                 {kSamplesLayer, {"samples"}},
                                                 {kErrorLayer, {"relativeError"}},
                                                 {kBiasLayer, {"bias.R", "bias.G", "bias.B"}}};
  return layers;
}

bool IsOfSamples(const PixelLayer& layer) {
  const std::string name = layer.name;
  return name == kSamplesLayer || name == kErrorLayer || name == kBiasLayer;
}

const PixelLayer* FindPixelLayer(const std::string& name) {
  for (const PixelLayer& layer : PixelLayers()) {
    if (PlainName(layer.name) == PlainName(name)) return &layer;
  }
  return nullptr;
}

std::vector<std::string> StrategyLayers::Names() const {
  std::vector<std::string> techniques;
  for (int events = 0; events <= mostEvents_; ++events) {
    for (int s = 0; s <= events + 1; ++s)
      techniques.push_back("s" + std::to_string(s) + "-t" + std::to_string(events + 2 - s));
  }
  techniques.emplace_back("longer");
  if (merges_) techniques.emplace_back("merged");
  std::vector<std::string> names;
  for (const std::string& technique : techniques) {
    names.push_back("weighted." + technique);
    names.push_back("unweighted." + technique);
  }
  return names;
}

uint32_t StrategyLayers::Of(int s, int t) const {
  const int events = s + t - 2;
  return 2 * (events > mostEvents_ ? Connecting() : static_cast<uint32_t>(events * (events + 3) / 2 + s));
}

LayerRequest ParseLayer(const std::string& text, const FileLocation& where) {
  const size_t end = EndOfName(text);
  std::string name = end == std::string::npos ? "" : Trimmed(text.substr(0, end));
  try {
    if (end != std::string::npos && name.empty()) throw Error("the layer has no name before =");
    Read read = ReadExpression(Trimmed(end == std::string::npos ? text : text.substr(end + 1)));
    if (end == std::string::npos) name = read.name;
    if (name.empty()) throw Error("a layer by an expression has a name: NAME=" + Trimmed(text));
    return {{LayerNameOf(name, "a layer"), std::move(read.expression), read.text}, where};
  } catch (const Error& error) {
    Fail(where, (name.empty() ? "" : "layer \"" + name + "\": ") + error.Text());
  }
}

std::shared_ptr<const OutputPlan> MakeOutputPlan(const LightingServices& lighting,
                                                 const std::vector<LayerRequest>& requests) {
  if (lighting.Groups().Layers().empty() && requests.empty()) return std::make_shared<const OutputPlan>();
  std::vector<LightSourceName> sources;
  std::map<std::string, std::string> groups;  // by layer
  std::vector<std::string> known;
  for (const PlacedLight& placed : lighting.Lights()) {
    const LightSettings& light = placed.light->Settings();
    sources.push_back({light.name, light.lightGroup, false});
    if (!light.lightGroup.empty()) groups.emplace(LayerOfLightGroup(light.lightGroup), light.lightGroup);
    for (const std::string& name : {light.name, light.lightGroup}) {
      if (!name.empty()) known.push_back(name);
    }
  }
  std::vector<OutputLayer> layers;
  std::set<std::string> names;
  for (const std::string& layer : lighting.Groups().Layers()) {
    const auto group = groups.find(layer);
    const LightSources::Term term = group != groups.end()
                                        ? LightSources::Term{LightSources::Kind::InGroup, group->second}
                                        : LightSources::Term{LightSources::Kind::InNoGroup, ""};
    layers.push_back({layer, PathExpression(LightSources{{term}, false}), ""});
    names.insert(layer);
  }
  for (const LayerRequest& request : requests) {
    const OutputLayer& layer = request.layer;
    for (const std::string& light : layer.expression.NamedLights()) {
      if (std::find(known.begin(), known.end(), light) == known.end())
        Fail(request.where, "layer \"" + layer.name + "\": the scene has no light or light group \"" + light + "\"" +
                                DidYouMean(light, known));
    }
    if (!names.insert(layer.name).second)
      Fail(request.where, "two layers have the name \"" + layer.name + "\": rename one");
    layers.push_back(layer);
  }
  try {
    return std::make_shared<const OutputPlan>(std::move(layers), sources);
  } catch (const Error& error) {
    Fail(requests.empty() ? FileLocation() : requests.front().where, error.Text());
  }
}

}  // namespace lampyr
