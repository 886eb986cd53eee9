// A plugin's file as it lies on disk, looked at before any of it is loaded. Private to the plugin loader.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lampyr {

// The stamp that the shared library carries (plugin_stamp.h); nullopt: it carries none. Throws an Error, with what was
// expected and what was found, for a file that is not there or cannot be read, is no shared library, is one for another
// machine, or has an end missing (loading that would end the process).
std::optional<std::string> ReadPluginStamp(const std::filesystem::path& file);

}  // namespace lampyr
