#include "render/output_files.h"

#include <unistd.h>

#include "base/error.h"
#include "film/atomic_file.h"

namespace lampyr {

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

}  // namespace lampyr
