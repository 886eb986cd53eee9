// Disks that are full, folders that go away, two renders on one image.
#include <sys/mount.h>

#include <chrono>
#include <thread>

#include "film/image.h"
#include "resume/resume_fixture.h"

namespace lampyr::test {
namespace {

class Faults : public Resume {
 protected:
  // Until the file is there.
  void WaitFor(const std::string& name) const {
    for (int i = 0; i < 1000 && !Exists(name); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(Exists(name)) << name;
  }
  // The picture that a message says is kept elsewhere; removed.
  static Image KeptPicture(const std::string& message) {
    const std::string mark = "the picture is kept as \"";
    const size_t at = message.find(mark);
    if (at == std::string::npos) return {};
    const size_t from = at + mark.size();
    const std::filesystem::path path = message.substr(from, message.find('"', from) - from);
    Image image = ReadImage(path);
    std::filesystem::remove(path);
    return image;
  }
};

// A limit on the size of files fails as a full disk does, after some bytes.
TEST_F(Faults, AFullDiskLeavesTheOldImageAndKeepsTheNewOneElsewhere) {
  Do("render scene.pbrt --quiet -o out.exr --spp 1");
  const std::string before = Bytes("out.exr");
  std::filesystem::create_directory(folder_ / "other");
  // 8 KiB, and nothing beside it either: the picture is lost, and that is said.
  const Outcome lost = RunLampyr(folder_.Path(), "render scene.pbrt --quiet -o out.exr --spp 2", "ulimit -f 8;");
  EXPECT_EQ(lost.exitCode, 1) << lost.output;
  EXPECT_NE(lost.output.find("cannot write \"out.exr\": File too large"), std::string::npos) << lost.output;
  EXPECT_EQ(Bytes("out.exr"), before);
  EXPECT_EQ(folder_.FileCount(), 4u) << "the scene, its mesh, the image, the folder, and nothing half written";
}

TEST_F(Faults, AFullFileSystem) {
  const std::filesystem::path small = folder_ / "small";
  std::filesystem::create_directory(small);
  if (mount("lampyr-test", small.c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "no file system can be mounted here";
  const Outcome first = Run("render scene.pbrt --quiet -o small/out.exr --spp 1");
  const std::string before = Bytes("small/out.exr");
  const Outcome second = Run("render scene.pbrt --quiet -o small/out.exr --spp 64");
  const std::string after = Bytes("small/out.exr");
  const Outcome third = Run("render scene.pbrt -o small/out.exr --spp 3000 --checkpoint 0.1s");
  const bool isClean = !Exists("small/out.checkpoint");
  const Outcome homeless =
      RunLampyr(folder_.Path(), "render scene.pbrt --quiet -o small/out.exr --spp 65", "export TMPDIR=/nonexistent;");
  umount(small.c_str());
  EXPECT_EQ(first.exitCode, 0) << first.output;
  EXPECT_EQ(second.exitCode, 1) << second.output;
  EXPECT_NE(second.output.find("No space left on device"), std::string::npos) << second.output;
  EXPECT_EQ(before, after);
  EXPECT_EQ(KeptPicture(second.output).metadata["lampyr.samplesPerPixel"], "64") << second.output;
  EXPECT_EQ(KeptPicture(homeless.output).metadata["lampyr.samplesPerPixel"], "65") << homeless.output;
  EXPECT_NE(third.output.find("warning: no checkpoint was written, the render goes on"), std::string::npos)
      << third.output;
  EXPECT_EQ(third.exitCode, 1) << third.output;
  EXPECT_EQ(KeptPicture(third.output).metadata["lampyr.samplesPerPixel"], "3000") << third.output;
  EXPECT_TRUE(isClean);
}

TEST_F(Faults, AFolderThatGoesAwayCostsNoPicture) {
  std::filesystem::create_directory(folder_ / "gone");
  const std::string log = (folder_ / "log").string();
  const std::string command = "'" LAMPYR_BINARY "' render '" + (folder_ / "scene.pbrt").string() +
                              "' --quiet --spp 3000 -o gone/out.exr --checkpoint 0.1s 2> '" + log + "'";
  std::thread remover([this] {
    WaitFor("gone/out.checkpoint");
    std::filesystem::remove_all(folder_ / "gone");
  });
  const int status = std::system(("cd '" + folder_.Path().string() + "' && " + command).c_str());
  remover.join();
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const std::string message = ReadBytes(log);
  EXPECT_NE(message.find("cannot write \"gone/out.exr\": No such file or directory"), std::string::npos) << message;
  EXPECT_EQ(KeptPicture(message).metadata["lampyr.samplesPerPixel"], "3000") << message;
}

TEST_F(Faults, WhatCannotBeWrittenIsSaidBeforeTheWork) {
  ExpectRefused("render scene.pbrt -o none/out.exr", 2, "there is no folder \"none\"");
  ExpectRefused("render scene.pbrt -o /proc/out.exr", 2, "cannot write \"/proc/out.exr\"");
  std::filesystem::create_directory(folder_ / "taken.exr");
  ExpectRefused("render scene.pbrt -o taken.exr", 2, "\"taken.exr\" is a folder");
  std::filesystem::create_directory(folder_ / "out.checkpoint");
  ExpectRefused("render scene.pbrt -o out.exr --checkpoint 1s", 2, "\"out.checkpoint\" is a folder");
}

TEST_F(Faults, OneRenderAtATimeWritesAnImage) {
  const std::string command = "render scene.pbrt --quiet -o out.exr --spp 100000000 --checkpoint 0.1s";
  {
    LampyrProcess first(folder_.Path(), command);
    WaitFor("out.checkpoint");
    const std::string owner = "another render (process " + std::to_string(first.Id()) + ") is writing \"out.exr\"";
    ExpectRefused("render scene.pbrt --quiet -o out.exr --spp 1", 1, owner);
    ExpectRefused("render scene.pbrt --quiet -o ./out.exr --resume --spp 1", 1, "is writing \"./out.exr\"");
    Do("render scene.pbrt --quiet -o other.exr --spp 1");
    WriteBytes(folder_ / ".out.exr.1.tmp", "half");
    WriteBytes(folder_ / ".out.checkpoint.77.tmp", "half");
    WriteBytes(folder_ / ".out.exr.mine.tmp", "not ours");
    EXPECT_EQ(first.Kill(SIGKILL), 128 + SIGKILL);
  }
  // Its lock went with it, and what is half written goes with the next one.
  Do("render scene.pbrt --quiet -o out.exr --spp 1");
  EXPECT_FALSE(Exists(".out.exr.1.tmp"));
  EXPECT_FALSE(Exists(".out.checkpoint.77.tmp"));
  EXPECT_TRUE(Exists(".out.exr.mine.tmp"));
  EXPECT_FALSE(Exists(".out.exr.lock"));
}

// Whoever comes first: of many at once, those that are let in write whole images, and the others say why not.
TEST_F(Faults, ManyAtOnceLeaveOneWholeImage) {
  Do("render scene.pbrt --quiet -o whole.exr --spp 4");
  for (int round = 0; round < 4; ++round) {
    std::vector<std::unique_ptr<LampyrProcess>> renders;
    for (int i = 0; i < 6; ++i)
      renders.push_back(
          std::make_unique<LampyrProcess>(folder_.Path(), "render scene.pbrt --quiet -o out.exr --spp 4"));
    int done = 0;
    for (auto& render : renders) {
      const int exitCode = render->Wait();
      EXPECT_TRUE(exitCode == 0 || exitCode == 1) << exitCode;
      done += exitCode == 0 ? 1 : 0;
    }
    EXPECT_GE(done, 1);
    EXPECT_EQ(Bytes("out.exr"), Bytes("whole.exr"));
  }
}

}  // namespace
}  // namespace lampyr::test
