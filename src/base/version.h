// The version in images and in the output of `lampyr --version`.
#pragma once

namespace lampyr {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace lampyr
