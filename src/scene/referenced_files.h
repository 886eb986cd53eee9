// The files that a scene refers to: meshes, textures, spectra, profiles.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_description.h"

namespace lampyr {

// Absolute paths of all existing files named by string values of parameters, sorted, without duplicates. Parameters of
// the film are excluded, since they name the file to be written.
std::vector<std::string> ReferencedFiles(const SceneDescription& scene);

// Hexadecimal hash of the contents of the files; an unreadable file counts as empty.
std::string HashOfFiles(const std::vector<std::string>& files);

}  // namespace lampyr
