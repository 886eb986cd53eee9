#include "scene/referenced_files.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "scene/ies_text.h"
#include "scene/text_file.h"

namespace lampyr {

namespace {

class Collector {
 public:
  void Add(const ParameterList& parameters) {
    for (const Parameter& parameter : parameters.All()) {
      for (const std::string& text : parameter.strings) {
        if (text.empty() || text.find('\0') != std::string::npos) continue;
        std::string file = parameters.ResolveFile(text, parameter.where);
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored)) continue;
        if (parameter.name.ends_with("ies:file")) {
          const std::string tilt = TiltFileOf(file);
          if (std::filesystem::is_regular_file(tilt, ignored)) files_.insert(tilt);
        }
        files_.insert(std::move(file));
      }
    }
  }
  void Add(const StatementDescription& statement) { Add(statement.parameters); }
  void Add(const std::vector<ShapeDescription>& shapes) {
    for (const ShapeDescription& shape : shapes) {
      Add(shape.shape);
      for (const auto& [target, parameters] : shape.attributes) Add(parameters);
    }
  }

  std::vector<std::string> Files() const { return {files_.begin(), files_.end()}; }

 private:
  std::set<std::string> files_;
};

}  // namespace

std::vector<std::string> ReferencedFiles(const SceneDescription& scene) {
  Collector collector;
  for (const StatementDescription* statement :
       {&scene.camera, &scene.pixelFilter, &scene.sampler, &scene.integrator, &scene.accelerator}) {
    collector.Add(*statement);
  }
  for (const auto& material : scene.materials) collector.Add(material);
  for (const auto& named : scene.namedMaterials) collector.Add(named.material);
  for (const auto& named : scene.textures) collector.Add(named.texture);
  for (const auto& medium : scene.media) collector.Add(medium.medium);
  for (const auto& filter : scene.lightFilters) collector.Add(filter.filter);
  for (const auto& light : scene.areaLights) collector.Add(light);
  for (const auto& light : scene.lights) collector.Add(light.light);
  collector.Add(scene.shapes);
  for (const ObjectDescription& object : scene.objects) collector.Add(object.shapes);
  return collector.Files();
}

std::string HashOfFiles(const std::vector<std::string>& files) {
  ContentHash hash;
  std::string part(size_t{1} << 20, '\0');
  for (const std::string& file : files) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
    while (const size_t count = stream ? std::fread(part.data(), 1, part.size(), stream.get()) : 0)
      hash.Add(std::string_view(part).substr(0, count));
    hash.Add("");
  }
  return hash.Hex();
}

}  // namespace lampyr
