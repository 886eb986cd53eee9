// Lock on an image and its checkpoint. A second render with the same output is refused, and temporary files that an
// ended render left beside them are removed.
#pragma once

#include <filesystem>

namespace lampyr {

class OutputLock {
 public:
  // Takes the lock, which is held until the end of the process at the latest, however it ends. Throws an Error if
  // another process holds it. Without effect on file systems that have no locks.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace lampyr
