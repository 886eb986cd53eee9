// A file that is written completely or not at all: bytes go to a temporary name in the same folder, which is renamed
// when all are written. A symbolic link is kept, and its target written. Every failure is an Error with the system's
// reason, and leaves the old file as it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace lampyr {

class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();  // removes the temporary file unless committed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void Write(const void* bytes, size_t count);
  uint64_t Position();
  void Seek(uint64_t position);
  void SeekToEnd();

  // Throws if an earlier Write failed and its Error was lost (for example because it was thrown in a destructor).
  void ThrowIfFailed();
  // Renames the file, once its bytes are on disk. Also throws as ThrowIfFailed does.
  void Commit();

  // Removes temporary files of `path` left behind by processes that were killed while they wrote it. No process may be
  // writing it.
  static void RemoveLeftovers(const std::filesystem::path& path);

 private:
  [[noreturn]] void Fail(int errorNumber);

  std::filesystem::path path_, target_, temporary_;
  std::FILE* file_ = nullptr;
  int firstError_ = 0;
};

// The target of `path`: links are followed, also to a file that does not exist yet. Throws an Error for a cycle of
// links.
std::filesystem::path WriteTarget(const std::filesystem::path& path);

// The folder of a file name; "." if the name has none.
std::filesystem::path FolderOf(const std::filesystem::path& path);

}  // namespace lampyr
