#include "scene/scene_paths.h"

#include <system_error>

namespace lampyr {

std::filesystem::path FindSceneFile(const std::string& name, const std::string& writer, const std::string& sceneFile) {
  const std::filesystem::path file(name);
  if (file.is_absolute()) return file;
  const std::filesystem::path besideScene = std::filesystem::path(sceneFile).parent_path() / file;
  const std::filesystem::path besideWriter = std::filesystem::path(writer).parent_path() / file;
  std::error_code ignored;
  const bool useWriter =
      !std::filesystem::exists(besideScene, ignored) && std::filesystem::exists(besideWriter, ignored);
  return useWriter ? besideWriter : besideScene;
}

}  // namespace lampyr
