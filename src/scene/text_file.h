// Reading a whole text file, plain or gzipped.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace lampyr {

// The bytes of the file, decompressed if they are gzip (by content, whatever the name). Throws an Error at `where` if
// the file is missing, unreadable, not a regular file, or truncated, or if it grows out of proportion when
// decompressed. Without `where`, the Error is located in the file itself.
std::string ReadTextFile(const std::filesystem::path& file, const FileLocation& where);

// A 128-bit hash of texts, in hexadecimal: not cryptographic, independent of the platform.
class ContentHash {
 public:
  void Add(std::string_view text);
  std::string Hex() const;

 private:
  uint64_t low_ = 0xcbf29ce484222325u;
  uint64_t high_ = 0x9ae16a3b2f90404fu;
};

}  // namespace lampyr
