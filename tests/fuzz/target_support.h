// Code that the targets share.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "fuzz/targets.h"

namespace lampyr::fuzz {

// The input as a file of this process, overwritten by the next one with the same extension; removed at the end.
std::filesystem::path AsFile(std::string_view bytes, const char* extension);

inline bool IsGzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

// Where scenes under test are said to be: beside a few files that they may name.
std::filesystem::path SceneName();

// True if `read` throws no Error.
template <class Read>
bool AcceptErrors(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    if (error.Text().empty()) Fail("an Error without a text");
    return false;
  }
}

}  // namespace lampyr::fuzz
