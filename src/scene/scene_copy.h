// A copy of a scene's text in which parameters of statements are changed. All else stays as it was written: comments,
// order, line breaks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/parameters.h"

namespace lampyr {

// Parameters of one statement, to be replaced where the statement has them and added where it has not.
struct StatementChange {
  FileLocation where;  // of the statement
  std::vector<Parameter> parameters;
};

// A file of the copy.
struct CopiedFile {
  std::filesystem::path path, original;
  std::string text;
};

// The scene's own file, and those of the files that it includes in which statements are changed, or that include such
// ones; each is to be written beside its original, as NAME + `suffix`, so that names of files in it mean the same.
// A copy that includes others names their copies. The last one is that of the scene. Throws an Error if a file
// is no longer as it was when the scene was read: there is no such statement any more.
std::vector<CopiedFile> CopyScene(const std::filesystem::path& scene, const std::vector<StatementChange>& changes,
                                  const std::string& suffix);

// The path of the copy of a file: "stage.pbrt" and "stage.pbrt.gz" with the suffix ".desk" are "stage.desk.pbrt".
std::filesystem::path PathOfCopy(const std::filesystem::path& original, const std::string& suffix);

// As a scene file would write it: "float intensity" 2. Numbers are read back as they were.
std::string Written(const Parameter& parameter);

}  // namespace lampyr
