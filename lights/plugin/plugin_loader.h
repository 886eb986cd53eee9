// Loads plugins: shared libraries that add types of lights and of light filters (plugin_api.h). The only place in the
// lights that opens shared libraries.
#pragma once

#include <filesystem>

#include "lights/types/type_registry.h"

namespace lampyr {

// A plugin whose static constructors threw. The system's loader was left in the midst of its work and keeps other
// threads waiting from then on: the process must end.
class LoaderBroken : public Error {
 public:
  using Error::Error;
};

// Looks at the file and its stamp, resolves all of its symbols, and asks its entry point for the types. Throws an Error
// that names the file, what was expected and what was found, when any of that does not hold or the plugin throws.
//
// The types' factories are made safe: whatever they throw, and a null that they return, becomes an Error that names the
// statement of the scene and the plugin. (An Error of theirs that says where stays as it is.) The library is never
// unloaded: code and tables of lights, filters and exceptions are in it.
Plugin LoadPlugin(const std::filesystem::path& file);

}  // namespace lampyr
