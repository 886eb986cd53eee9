// Where the files are that a scene file names.
#pragma once

#include <filesystem>
#include <string>

namespace lampyr {

// `name` as written in the file `writer` of the scene `sceneFile`. pbrt-v4 looks beside the scene's file, also for
// names in included files; when nothing is there, the folder of the file that wrote the name is tried. Absolute names
// stay. When neither exists: the path beside the scene's file, so that the message of whoever opens it says where to
// put it.
std::filesystem::path FindSceneFile(const std::string& name, const std::string& writer, const std::string& sceneFile);

}  // namespace lampyr
