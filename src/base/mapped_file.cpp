#include "base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace lampyr {

MappedFile::MappedFile(const std::filesystem::path& path) {
  const auto fail = [&path](const std::string& what) { throw Error("cannot read \"" + path.string() + "\": " + what); };
  const auto reason = [] { return std::generic_category().message(errno); };
  // O_NONBLOCK: opening a pipe without a writer must not block.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) fail(reason());
  struct stat status {};
  const bool isFile = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const auto size = static_cast<size_t>(isFile ? status.st_size : 0);
  void* bytes = size > 0 ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
  const std::string whyNot = bytes == MAP_FAILED ? reason() : "";
  close(file);
  if (!isFile) fail("it is not a regular file");
  if (bytes == MAP_FAILED) fail(whyNot);
  bytes_ = {static_cast<const std::byte*>(bytes), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace lampyr
