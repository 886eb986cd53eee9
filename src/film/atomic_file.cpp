// Temporary names contain the process id: two processes that write the same file do not share one.
#include "film/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr const char* kSuffix = ".tmp";

std::string TemporaryPrefix(const std::filesystem::path& path) {
  return "." + path.filename().string() + ".";
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path) {
  if (!path.has_filename()) throw Error("cannot write \"" + path.string() + "\": it names no file");
  target_ = WriteTarget(path);
  std::error_code ignored;
  const std::filesystem::file_status there = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(there)) Fail(EISDIR);
  // Renaming would replace the device itself.
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
    throw Error("cannot write \"" + path.string() + "\": it is a device or a pipe, not a file");
  temporary_ = target_;
  temporary_.replace_filename(TemporaryPrefix(target_) + std::to_string(getpid()) + kSuffix);
  errno = 0;
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (!file_) Fail(errno);
  // Keeps the permissions of the file that is replaced.
  if (std::filesystem::is_regular_file(there))
    (void)fchmod(fileno(file_), static_cast<mode_t>(there.permissions() & std::filesystem::perms::mask));
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::Fail(int errorNumber) {
  if (firstError_ == 0) firstError_ = errorNumber;
  throw Error("cannot write \"" + path_.string() + "\": " + std::generic_category().message(firstError_));
}

void AtomicFile::Write(const void* bytes, size_t count) {
  errno = 0;
  if (std::fwrite(bytes, 1, count, file_) != count) Fail(errno != 0 ? errno : EIO);
}

uint64_t AtomicFile::Position() {
  const off_t position = ftello(file_);
  if (position < 0) Fail(errno);
  return static_cast<uint64_t>(position);
}

void AtomicFile::Seek(uint64_t position) {
  if (fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) Fail(errno);
}

void AtomicFile::SeekToEnd() {
  if (fseeko(file_, 0, SEEK_END) != 0) Fail(errno);
}

void AtomicFile::ThrowIfFailed() {
  if (firstError_ != 0) Fail(firstError_);
}

void AtomicFile::Commit() {
  ThrowIfFailed();
  if (std::fflush(file_) != 0) Fail(errno);
  // Syncs the bytes before the rename, so that the name never precedes them. Not every file system supports it.
  if (fsync(fileno(file_)) != 0 && errno != EINVAL && errno != ENOTSUP) Fail(errno);
  std::FILE* file = file_;
  file_ = nullptr;
  int failure = std::fclose(file) != 0 ? errno : 0;
  if (failure == 0 && std::rename(temporary_.c_str(), target_.c_str()) != 0) failure = errno;
  if (failure == 0) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  Fail(failure);
}

void AtomicFile::RemoveLeftovers(const std::filesystem::path& path) {
  const std::filesystem::path target = WriteTarget(path);
  const std::string prefix = TemporaryPrefix(target);
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(FolderOf(target), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= prefix.size() + std::strlen(kSuffix) || !name.starts_with(prefix) || !name.ends_with(kSuffix))
      continue;
    const std::string process = name.substr(prefix.size(), name.size() - prefix.size() - std::strlen(kSuffix));
    if (process.find_first_not_of("0123456789") == std::string::npos) std::filesystem::remove(entry.path(), ignored);
  }
}

std::filesystem::path WriteTarget(const std::filesystem::path& path) {
  constexpr int mostLinks = 40;  // the system's own limit
  std::filesystem::path target = path;
  for (int i = 0; i < mostLinks; ++i) {
    std::error_code code;
    const std::filesystem::path next = std::filesystem::read_symlink(target, code);
    if (code) return target;  // not a link
    target = next.is_absolute() ? next : FolderOf(target) / next;
  }
  throw Error("cannot write \"" + path.string() + "\": " + std::generic_category().message(ELOOP));
}

std::filesystem::path FolderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

}  // namespace lampyr
