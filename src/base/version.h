// The version, as images and `lampyr --version` carry it.
#pragma once

namespace lampyr {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace lampyr
