// One render at a time writes an image and its checkpoint: another one that is told to write the same is refused, and
// what an ended one has left half written beside them is removed.
#pragma once

#include <filesystem>

namespace lampyr {

class OutputLock {
 public:
  // Held until the end of the process at the latest, however it ends. Throws an Error where another process holds it.
  // On file systems that know no locks there are none.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace lampyr
