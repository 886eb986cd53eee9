// Scene files that are missing, unreadable, cut off, or include themselves.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

TEST(SceneFileErrors, MissingScene) {
  const TemporaryFolder folder;
  const std::string file = (folder / "none.pbrt").string();
  EXPECT_EQ(ReadError(file), file + ": error: the file cannot be read: No such file or directory");
}

TEST(SceneFileErrors, FolderForScene) {
  const TemporaryFolder folder;
  const std::string file = (folder / "").string();
  EXPECT_EQ(ReadError(file), file + ": error: the file is a folder, not a scene file");
}

TEST(SceneFileErrors, DeviceForScene) {
  EXPECT_EQ(ReadError("/dev/null"), "/dev/null: error: the file is not a regular file");
}

TEST(SceneFileErrors, UnreadableScene) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TemporaryFolder folder;
  const std::string file = folder.Write("s.pbrt", "WorldBegin");
  chmod(file.c_str(), 0);
  EXPECT_EQ(ReadError(file), file + ": error: the file cannot be read: Permission denied");
}

TEST(SceneFileErrors, MissingInclude) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("s.pbrt", "WorldBegin\n  Include \"none.pbrt\"");
  EXPECT_EQ(ReadError(file), file + ":2:11: error: \"" + (folder / "none.pbrt").string() +
                                 "\" cannot be read: No such file or directory");
  folder.Write("s.pbrt", "WorldBegin\nInclude \"\"");
  EXPECT_EQ(ReadError(file), file + ":2:9: error: the file's name is empty");
  folder.Write("s.pbrt", "WorldBegin\nInclude geometry.pbrt");
  EXPECT_EQ(ReadError(file), file + ":2:9: error: Include needs a file's name in quotes, found \"geometry.pbrt\"");
  folder.Write("s.pbrt", "WorldBegin\nInclude \".\"");
  EXPECT_THAT(ReadError(file), HasSubstr(file + ":2:9: error: \""));
  EXPECT_THAT(ReadError(file), HasSubstr("is a folder, not a scene file"));
}

TEST(SceneFileErrors, IncludesItself) {
  const TemporaryFolder folder;
  const std::string a = folder.Write("a.pbrt", "WorldBegin Include \"a.pbrt\"");
  EXPECT_EQ(ReadError(a), a + ":1:20: error: a file that includes itself: " + a + " -> " + a);
  const std::string b = (folder / "b.pbrt").string(), c = (folder / "sub/../c.pbrt").string();
  for (const char* statement : {"Include", "Import"}) {
    folder.Write("a.pbrt", std::string("WorldBegin\n") + statement + " \"b.pbrt\"");
    folder.Write("b.pbrt", std::string("\n ") + statement + " \"sub/../c.pbrt\"");
    folder.Write("c.pbrt", std::string(statement) + " \"b.pbrt\"");
    folder.Write("sub/x", "");
    EXPECT_EQ(ReadError(a), c + ":1:" + std::to_string(std::string(statement).size() + 2) +
                                ": error: a file that includes itself: " + b + " -> " + c + " -> " + b);
  }
}

TEST(SceneFileErrors, IncludesItselfThroughALink) {
  const TemporaryFolder folder;
  const std::string a = folder.Write("a.pbrt", "WorldBegin Include \"link.pbrt\"");
  std::filesystem::create_symlink(folder / "a.pbrt", folder / "link.pbrt");
  EXPECT_THAT(ReadError(a), HasSubstr("a file that includes itself"));
}

TEST(SceneFileErrors, NestedTooDeep) {
  const TemporaryFolder folder;
  for (int i = 0; i < 300; ++i) {
    folder.Write("f" + std::to_string(i), "Include \"f" + std::to_string(i + 1) + "\"");
  }
  EXPECT_THAT(ReadError(folder / "f0"), HasSubstr("f255:1:9: error: files are nested more than 256 deep"));
}

TEST(SceneFileErrors, CutOffOrDamagedGzip) {
  const TemporaryFolder folder;
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 5000; ++i) text += "Shape \"sphere\" \"float radius\" " + std::to_string(i * i + 1) + "\n";
  const std::string bytes = ReadAll(folder.WriteGzipped("s.pbrt.gz", text));
  const std::string file = (folder / "s.pbrt.gz").string();
  for (const size_t keep : {size_t(2), size_t(5), size_t(11), bytes.size() / 2, bytes.size() - 9, bytes.size() - 1}) {
    folder.Write("s.pbrt.gz", bytes.substr(0, keep));
    EXPECT_EQ(ReadError(file), file + ": error: the file ends in the middle of its gzip data") << keep;
  }
  const auto damaged = [&](size_t position) {
    std::string copy = bytes;
    copy[position] = static_cast<char>(copy[position] ^ 0x55);
    folder.Write("s.pbrt.gz", copy);
    return ReadError(file);
  };
  EXPECT_EQ(damaged(bytes.size() - 6), file + ": error: the file has damaged gzip data") << "checksum";
  EXPECT_EQ(damaged(2), file + ": error: the file has damaged gzip data") << "method";
  EXPECT_NE(damaged(bytes.size() / 2), "no error");
  // The same through an Include.
  folder.Write("s.pbrt.gz", bytes.substr(0, 40));
  const std::string outer = folder.Write("o.pbrt", "WorldBegin Include \"s.pbrt.gz\"");
  EXPECT_EQ(ReadError(outer), outer + ":1:20: error: \"" + file + "\" ends in the middle of its gzip data");
}

TEST(SceneFileErrors, ScopesEndInTheImportedFile) {
  const TemporaryFolder folder;
  const std::string outer = folder.Write("s.pbrt", "WorldBegin AttributeBegin Import \"part\" AttributeEnd");
  const std::string part = folder.Write("part", "AttributeEnd");
  EXPECT_EQ(ReadError(outer), part + ":1:1: error: AttributeEnd without AttributeBegin");
  folder.Write("part", " AttributeBegin");
  EXPECT_EQ(ReadError(outer), part + ":1:2: error: this AttributeBegin has no AttributeEnd");
}

TEST(SceneFileErrors, ListsEndInTheirFile) {
  const TemporaryFolder folder;
  const std::string outer = folder.Write("s.pbrt", "WorldBegin Include \"part\" ]");
  const std::string part = folder.Write("part", "Shape \"s\" \"float a\" [ 1 2");
  EXPECT_EQ(ReadError(outer), part + ":1:21: error: this list has no \"]\" before the end of the file");
}

}  // namespace
}  // namespace lampyr
