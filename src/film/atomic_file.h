// A file that is written whole or not at all: bytes go to a temporary name in the same folder, which takes the final
// name when all are written. A link stays one: what it leads to is written. Every failure is an Error with the system's
// reason; the old file stays as it was.
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

  // Throws when an earlier Write failed and its Error was lost on the way here (in a destructor, say).
  void ThrowIfFailed();
  // Gives the file its name, once its bytes are on the disk. Throws as ThrowIfFailed does, too.
  void Commit();

  // Removes what processes that were ended while they wrote this file have left beside it. While nobody writes it.
  static void RemoveLeftovers(const std::filesystem::path& path);

 private:
  [[noreturn]] void Fail(int errorNumber);

  std::filesystem::path path_, target_, temporary_;
  std::FILE* file_ = nullptr;
  int firstError_ = 0;
};

// The file that is written when `path` is: where links lead, also where there is nothing yet. Throws an Error where they
// lead in a circle.
std::filesystem::path WriteTarget(const std::filesystem::path& path);

// Of a file's name; "." where it names none.
std::filesystem::path FolderOf(const std::filesystem::path& path);

}  // namespace lampyr
