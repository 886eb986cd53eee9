#include "render/output_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>

#include "base/error.h"
#include "film/atomic_file.h"

namespace lampyr {

namespace {

// Signals that end the process wait as long as this lives: a file that exists for a moment is not left behind.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t waiting;
    sigemptyset(&waiting);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&waiting, signal);
    pthread_sigmask(SIG_BLOCK, &waiting, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

void CheckWritable(const std::filesystem::path& path, const std::string& option) {
  std::filesystem::path folder;
  try {
    folder = FolderOf(WriteTarget(path));
  } catch (const Error& error) {
    throw UsageError(option + ": " + error.Text());
  }
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw UsageError(option + ": there is no folder \"" + folder.string() + "\"");
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw UsageError(option + ": the folder \"" + folder.string() + "\" is not writable");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw UsageError(option + ": \"" + path.string() + "\" is a folder");
  }
  // Permissions alone are not conclusive: the file is created to find out.
  const SignalsWait signalsWait;
  try {
    const AtomicFile probe(path);
  } catch (const Error& error) {
    throw UsageError(option + ": " + error.Text());
  }
}

void MakeFolder(const std::filesystem::path& folder, const std::string& option) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw UsageError(option + ": cannot make the folder \"" + folder.string() + "\"");
}

void WriteText(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

bool WouldBeSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  if (std::filesystem::exists(a, ignored) && !std::filesystem::is_regular_file(a, ignored)) return false;
  if (IsSameFile(a, b)) return true;
  try {
    const auto target = [](const std::filesystem::path& path) {
      return std::filesystem::weakly_canonical(std::filesystem::absolute(WriteTarget(path)));
    };
    return target(a) == target(b);
  } catch (const std::exception&) {
    return false;  // CheckWritable says what is wrong
  }
}

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
