// The files that a scene names: meshes, textures, spectra, profiles.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_description.h"

namespace lampyr {

// Absolute paths of all files that parameters name, sorted, each once: every text of a parameter that is the name of a
// file that is there. Not that of the film, which names the file to be written.
std::vector<std::string> ReferencedFiles(const SceneDescription& scene);

// A fingerprint of what is in the files, hexadecimal; what cannot be read counts as empty.
std::string HashOfFiles(const std::vector<std::string>& files);

}  // namespace lampyr
