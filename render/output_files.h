// Files that a command writes: checked before the work that would be lost, and written whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace lampyr {

// Throws a UsageError if the file cannot be written. `option`: the command-line option that the message names.
void CheckWritable(const std::filesystem::path& path, const std::string& option);
// Creates the folder. Throws a UsageError if that fails.
void MakeFolder(const std::filesystem::path& folder, const std::string& option);
// Writes a text file, whole or not at all. Throws an Error.
void WriteText(const std::filesystem::path& path, const std::string& text);

// True if both paths exist and lead to the same file, also through links.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);
// True if what is written to the two paths would be one file, whether it exists or not. Devices and pipes are none.
bool WouldBeSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

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
