// Reads what the loader needs from a plugin's file before any of it is loaded. Private to the plugin loader.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lampyr {

// The stamp that the shared library carries (plugin_stamp.h); nullopt if it has none. Throws an Error, with the
// expected and the actual property, for a file that does not exist or cannot be read, is no shared library, is one for
// another machine, or is truncated (loading that would end the process).
std::optional<std::string> ReadPluginStamp(const std::filesystem::path& file);

}  // namespace lampyr
