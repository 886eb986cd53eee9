// The version that images and `lampyr --version` state.
#pragma once

namespace lampyr {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace lampyr
