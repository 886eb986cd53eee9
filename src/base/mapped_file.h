// A read-only memory mapping of a file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace lampyr {

class MappedFile {
 public:
  // Throws an Error with the system's reason if `path` cannot be mapped or is not a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> Bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace lampyr
