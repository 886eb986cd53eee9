// *Keep* of the lighting desk: writes the scene, with its edits and faders, and the picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desk/desk_lights.h"
#include "app/desk/desk_session.h"

namespace lampyr {

struct KeptFiles {
  std::vector<std::filesystem::path> scenes;  // the last one is to be rendered
  std::filesystem::path picture;
  std::vector<std::string> notes;  // what could not be kept
};

// Notes on faders of glowing media that are not 1: the media of the scene stay as they are. `factors`: by fader.
std::vector<std::string> GlowsThatStay(const std::vector<Fader>& faders, const std::vector<Color>& factors);

// Writes the scene as SCENE.desk.pbrt beside the original, because names of files in it are relative to that; files
// that it includes and in which something is edited, beside those. The picture, mixed by the faders, goes to the
// working folder as SCENE.desk.exr. Where such a file exists, the names are SCENE.desk-2.pbrt, …: nothing is
// overwritten. `factors`: by fader; set into the lights of the scene (EditsOf). Throws an Error.
KeptFiles Keep(const EditableScene& scene, DeskSession& session, const std::vector<Fader>& faders,
               const std::vector<Color>& factors);

}  // namespace lampyr
