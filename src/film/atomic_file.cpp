// Temporary names hold the process id: two processes that write the same file do not share one.
#include "film/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "base/error.h"

namespace lampyr {

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), temporary_(path) {
  if (!path.has_filename()) throw Error("cannot write \"" + path.string() + "\": it names no file");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) Fail(EISDIR);
  std::string name = ".";
  name.append(path.filename().string()).append(".").append(std::to_string(getpid())).append(".tmp");
  temporary_.replace_filename(name);
  errno = 0;
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (!file_) Fail(errno);
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

void AtomicFile::ThrowIfFailed() {
  if (firstError_ != 0) Fail(firstError_);
}

void AtomicFile::Commit() {
  ThrowIfFailed();
  if (std::fflush(file_) != 0) Fail(errno);
  std::FILE* file = file_;
  file_ = nullptr;
  int failure = std::fclose(file) != 0 ? errno : 0;
  if (failure == 0 && std::rename(temporary_.c_str(), path_.c_str()) != 0) failure = errno;
  if (failure == 0) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  Fail(failure);
}

}  // namespace lampyr
