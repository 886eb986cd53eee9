// The files of the desk's page (page/), which are compiled into the program.
#pragma once

#include <span>
#include <string_view>

namespace lampyr {

struct PageFile {
  const char* path;  // behind the token; "": the page itself
  const char* type;
  std::string_view text;
};

std::span<const PageFile> PageFiles();

}  // namespace lampyr
