// Loads plugins: shared libraries that add types of lights and of light filters (plugin_api.h). The only place in the
// lights that opens shared libraries.
#pragma once

#include <filesystem>

#include "lights/types/type_registry.h"

namespace lampyr {

// A plugin whose static constructors threw. The exception interrupted the system's loader, which blocks other threads
// from then on: the process must end.
class LoaderBroken : public Error {
 public:
  using Error::Error;
};

// Checks the file and its stamp, resolves all of its symbols, and gets the types from its entry point. Throws an Error
// that names the file, what was expected and what was found, if one of these steps fails or the plugin throws.
//
// The types' factories are wrapped: any exception, and a null result, becomes an Error that names the statement of the
// scene and the plugin. (An Error of theirs that has a location is passed on unchanged.) The library is never unloaded,
// because it contains the code and tables of lights, filters and exceptions.
Plugin LoadPlugin(const std::filesystem::path& file);

}  // namespace lampyr
