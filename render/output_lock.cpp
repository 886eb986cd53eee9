#include "render/output_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "base/error.h"
#include "film/atomic_file.h"

namespace lampyr {

namespace {

// True if `path` is still the opened file. A process that releases the lock removes the file, and a lock on a removed
// file excludes nobody.
bool IsStillThere(int file, const std::filesystem::path& path) {
  struct stat opened {
  }, there{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &there) == 0 && opened.st_ino == there.st_ino &&
         opened.st_dev == there.st_dev;
}

std::string OwnerOf(int file) {
  char text[32] = {};
  const ssize_t count = pread(file, text, sizeof text - 1, 0);
  return count > 0 ? " (process " + std::string(text) + ")" : "";
}

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& output)
    : path_(FolderOf(WriteTarget(output)) / ("." + WriteTarget(output).filename().string() + ".lock")) {
  while (file_ < 0) {
    const int file = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return;  // writing the output reports the reason
    if (flock(file, LOCK_EX | LOCK_NB) != 0) {
      const bool isTaken = errno == EWOULDBLOCK;
      const std::string owner = isTaken ? OwnerOf(file) : "";
      close(file);
      if (!isTaken) return;
      throw Error("another render" + owner + " is writing \"" + output.string() +
                  "\": wait for it, or write elsewhere with --output");
    }
    if (IsStillThere(file, path_)) {
      file_ = file;
    } else {
      close(file);
    }
  }
  const std::string own = std::to_string(getpid());
  if (ftruncate(file_, 0) != 0 || pwrite(file_, own.data(), own.size(), 0) < 0) {
    // The process id is only for the message.
  }
  for (const char* extension : {".exr", ".png", ".checkpoint"})
    AtomicFile::RemoveLeftovers(std::filesystem::path(output).replace_extension(extension));
}

OutputLock::~OutputLock() {
  if (file_ < 0) return;
  unlink(path_.c_str());
  close(file_);
}

}  // namespace lampyr
