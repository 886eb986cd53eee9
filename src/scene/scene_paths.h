// Resolution of the file names in scene files.
#pragma once

#include <filesystem>
#include <string>

namespace lampyr {

// Resolves `name`, which occurs in the file `writer` of the scene `sceneFile`. As in pbrt-v4, relative to the folder of
// the scene file, also for names in included files; if nothing exists there, relative to the folder of `writer`.
// Absolute names are unchanged. If neither exists: the path in the folder of the scene file, so that the message of the
// failed open names the place where the file is expected.
std::filesystem::path FindSceneFile(const std::string& name, const std::string& writer, const std::string& sceneFile);

}  // namespace lampyr
