// Files that a command writes: checked before the work that would be lost, and written whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace lampyr {

// Throws a UsageError if the file cannot be written; `option` names the culprit.
void CheckWritable(const std::filesystem::path& path, const std::string& option);
// Makes the folder. Throws a UsageError if it cannot be made.
void MakeFolder(const std::filesystem::path& folder, const std::string& option);
// Whole or not at all.
void WriteText(const std::filesystem::path& path, const std::string& text);

// True if both paths exist and lead to the same file, through links too.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace lampyr
