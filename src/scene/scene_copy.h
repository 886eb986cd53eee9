// A copy of a scene's text in which parameters of statements are changed. Everything else is unchanged: comments,
// order, line breaks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/parameters.h"

namespace lampyr {

// Parameters of one statement, which replace those of the same name or are added.
struct StatementChange {
  FileLocation where;  // of the statement
  std::vector<Parameter> parameters;
};

// A file of the copy.
struct CopiedFile {
  std::filesystem::path path, original;
  std::string text;
};

// Copies of the scene's own file, and of the included files in which statements are changed or that include such files.
// Each is to be written beside its original, as NAME + `suffix`, so that file names in it keep their meaning. A copy
// that includes others names their copies. The last one is that of the scene. Throws an Error if a file has changed
// since the scene was read, so that it has no such statement any more.
std::vector<CopiedFile> CopyScene(const std::filesystem::path& scene, const std::vector<StatementChange>& changes,
                                  const std::string& suffix);

// The path of the copy of a file: "stage.pbrt" and "stage.pbrt.gz" with the suffix ".desk" are "stage.desk.pbrt".
std::filesystem::path PathOfCopy(const std::filesystem::path& original, const std::string& suffix);

// The parameter as in a scene file: "float intensity" 2. Numbers are read back exactly.
std::string Written(const Parameter& parameter);

}  // namespace lampyr
