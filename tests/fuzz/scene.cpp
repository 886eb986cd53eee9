#include "fuzz/target_support.h"
#include "scene/scene_description.h"
#include "scene/spectrum.h"

namespace lampyr::fuzz {

namespace {

void AskFor(const ParameterList& list, const std::string& name) {
  AcceptErrors([&] { list.GetFloat(name, 0); });
  AcceptErrors([&] { list.GetInteger(name, 0); });
  AcceptErrors([&] { list.GetBool(name, false); });
  AcceptErrors([&] { list.GetString(name, ""); });
  AcceptErrors([&] { list.GetPoint2(name, {}); });
  AcceptErrors([&] { list.GetPoint3(name, {}); });
  AcceptErrors([&] { list.GetVector3(name, {}); });
  AcceptErrors([&] { list.GetFloats(name); });
  AcceptErrors([&] { list.GetPoint2s(name); });
  AcceptErrors([&] { list.GetPoint3s(name); });
  AcceptErrors([&] { list.GetFile(name); });
  AcceptErrors([&] { list.GetTextureName(name); });
  for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant}) {
    AcceptErrors([&] {
      for (const Color& color : list.GetColors(name, role)) {
        if (!color.IsValid()) Fail("a colour that is none");
      }
    });
  }
}

void AskForAll(const ParameterList& list) {
  for (const Parameter& parameter : list.All()) AskFor(list, parameter.name);
}

void AskForAll(const SceneDescription& scene) {
  for (const auto* statement : {&scene.camera, &scene.film, &scene.pixelFilter, &scene.sampler, &scene.integrator}) {
    AskForAll(statement->parameters);
  }
  for (const auto& light : scene.lights) AskForAll(light.light.parameters);
  for (const auto& light : scene.areaLights) AskForAll(light.parameters);
  for (const auto& filter : scene.lightFilters) AskForAll(filter.filter.parameters);
  for (const auto& texture : scene.textures) AskForAll(texture.texture.parameters);
  for (const auto& material : scene.materials) AskForAll(material.parameters);
  for (const auto& shape : scene.shapes) AskForAll(shape.shape.parameters);
}

}  // namespace

bool ReadSceneText(std::string_view bytes) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return AcceptErrors([&] {
    AskForAll(IsGzip(bytes) ? ReadScene(AsFile(bytes, ".pbrt.gz"), diagnostics)
                            : ParseScene(std::string(bytes), SceneName(), diagnostics));
  });
}

}  // namespace lampyr::fuzz
