#include "app/desk/keep_scene.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include "base/version.h"
#include "film/atomic_file.h"
#include "film/image.h"
#include "film/mix.h"
#include "lights/services/lighting_services.h"
#include "render/output_files.h"
#include "scene/scene_copy.h"

namespace lampyr {

namespace {

namespace fs = std::filesystem;

std::string SuffixOf(int number) {
  return number == 1 ? ".desk" : ".desk-" + std::to_string(number);
}

bool Exists(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(file, ignored));
}

fs::path PicturePath(const fs::path& scene, const std::string& suffix) {
  return PathOfCopy(scene, suffix).filename().replace_extension(".exr");
}

// The edits so far, and those of the faders.
std::vector<StatementChange> AllChanges(const EditableScene& scene, const std::vector<StatementEdit>& more) {
  std::vector<StatementChange> changes = scene.Changes();
  for (const StatementEdit& edit : more) {
    const FileLocation& where = scene.Statements()[edit.statement].where;
    auto change = std::find_if(changes.begin(), changes.end(),
                               [&](const StatementChange& each) { return each.where.ToString() == where.ToString(); });
    if (change == changes.end()) change = changes.insert(changes.end(), {where, {}});
    for (const Parameter& parameter : edit.parameters) {
      std::erase_if(change->parameters, [&](const Parameter& other) { return other.name == parameter.name; });
      change->parameters.push_back(parameter);
    }
    std::sort(change->parameters.begin(), change->parameters.end(),
              [](const Parameter& a, const Parameter& b) { return a.name < b.name; });
  }
  return changes;
}

// Copies with unused names.
struct FreeCopies {
  std::vector<CopiedFile> files;
  fs::path picture;
};
FreeCopies FindFreeCopies(const fs::path& scene, const std::vector<StatementChange>& changes) {
  constexpr int kMost = 10000;
  for (int number = 1; number < kMost; ++number) {
    const std::string suffix = SuffixOf(number);
    FreeCopies copies{{}, PicturePath(scene, suffix)};
    if (Exists(copies.picture) || Exists(PathOfCopy(scene, suffix))) continue;
    copies.files = CopyScene(scene, changes, suffix);
    const auto isTaken = [](const CopiedFile& file) { return Exists(file.path); };
    if (std::none_of(copies.files.begin(), copies.files.end(), isTaken)) return copies;
  }
  throw Error("there are " + std::to_string(kMost) + " kept scenes already: remove some");
}

void WritePicture(const fs::path& path, const BuiltScene& scene, const Film& film, int samplesPerPixel,
                  const std::vector<Fader>& faders, const std::vector<Color>& factors) {
  Image image = film.Develop();
  const std::vector<std::string>& groups = scene.scene.lighting->Groups().Layers();
  std::string list;
  for (const std::string& group : groups) list += (list.empty() ? "" : ",") + group;
  image.metadata = {{"lampyr.version", kVersion},
                    {"lampyr.integrator", scene.settings.integrator},
                    {"lampyr.seed", std::to_string(scene.settings.seed)},
                    {"lampyr.samplesPerPixel", std::to_string(samplesPerPixel)}};
  if (!list.empty()) image.metadata["lampyr.lightGroups"] = list;
  std::vector<LayerFactor> mixed;
  for (size_t i = 0; i < faders.size(); ++i) {
    if (factors[i] == Color(1.0f)) continue;
    if (faders[i].layer.empty())  // the fader of all light
      image = ScaleAllLight(image, factors[i]);
    else
      mixed.push_back({faders[i].layer, factors[i]});
  }
  WriteExr(path, mixed.empty() ? image : MixLayers(image, mixed), ExrPrecision::Float);
}

}  // namespace

std::vector<std::string> GlowsThatStay(const std::vector<Fader>& faders, const std::vector<Color>& factors) {
  std::vector<std::string> notes;
  for (size_t i = 0; i < faders.size(); ++i) {
    if (faders[i].hasGlow && factors[i] != Color(1.0f))
      notes.push_back("the glow of media is in \"" + faders[i].label +
                      "\", too: its fader is not set into the media of the scene");
  }
  return notes;
}

KeptFiles Keep(const EditableScene& scene, DeskSession& session, const std::vector<Fader>& faders,
               const std::vector<Color>& factors) {
  const FreeCopies copies =
      FindFreeCopies(scene.Description().file, AllChanges(scene, EditsOf(scene, faders, factors)));
  KeptFiles kept;
  kept.notes = GlowsThatStay(faders, factors);
  // Files that are there already are removed if a later one cannot be written. Their names were unused.
  std::vector<fs::path> written;
  try {
    for (const CopiedFile& copy : copies.files) {
      AtomicFile file(copy.path);
      file.Write(copy.text.data(), copy.text.size());
      file.Commit();
      written.push_back(copy.path);
      kept.scenes.push_back(fs::absolute(copy.path));
    }
    session.WithFilm([&](const BuiltScene& built, const Film& film, int samplesPerPixel) {
      WritePicture(copies.picture, built, film, samplesPerPixel, faders, factors);
    });
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& file : written) fs::remove(file, ignored);
    throw;
  }
  kept.picture = fs::absolute(copies.picture);
  return kept;
}

}  // namespace lampyr
