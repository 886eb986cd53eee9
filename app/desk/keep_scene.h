// *Keep* of the lighting desk: writes the scene, with its edits and faders, and the picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desk/desk_lights.h"
#include "app/desk/desk_session.h"

namespace lampyr {

struct KeptFiles {
  std::vector<std::filesystem::path> scenes;  // the last one is the scene to render
  std::filesystem::path picture;
  std::vector<std::string> notes;  // notes on edits that could not be kept
};

// Notes on faders of glowing media that are not 1, because the media of the scene are not changed. `factors`: by fader.
std::vector<std::string> GlowsThatStay(const std::vector<Fader>& faders, const std::vector<Color>& factors);

// Writes the scene as SCENE.desk.pbrt beside the original, because file names in it are relative to that; included
// files with edits, beside theirs. The picture, mixed by the faders, goes to the working folder as SCENE.desk.exr. If
// such a file exists, the names are SCENE.desk-2.pbrt, …: nothing is overwritten. `factors`: by fader; set into the
// lights of the scene (EditsOf). Throws an Error.
KeptFiles Keep(const EditableScene& scene, DeskSession& session, const std::vector<Fader>& faders,
               const std::vector<Color>& factors);

}  // namespace lampyr
