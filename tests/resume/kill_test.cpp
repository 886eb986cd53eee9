// Renders that are killed at random moments: what is on the disk is whole at any time, and the picture that is gone on
// with has the bytes of one that was never interrupted.
#include <chrono>
#include <random>
#include <thread>

#include "film/image.h"
#include "render/render_part.h"
#include "resume/resume_fixture.h"

namespace lampyr::test {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Kill : public Resume {
 protected:
  // Kills the render as often as it takes to be done; how often.
  int RenderInPieces(const std::string& command, double seconds, std::mt19937& random) {
    const std::string pieces = command + " -o pieces.exr --checkpoint 0.01s --resume";
    std::uniform_real_distribution<double> moment(0, seconds);
    int kills = 0;
    while (true) {
      LampyrProcess render(folder_.Path(), pieces);
      const auto start = Clock::now();
      const double end = moment(random);
      while (SecondsSince(start) < end && !render.HasEnded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (render.HasEnded()) {
        EXPECT_EQ(render.Wait(), 0) << pieces;
        return kills;
      }
      if (render.Kill(SIGKILL) != 128 + SIGKILL) return kills;
      ++kills;
      CheckFiles();
    }
  }

  // Whole or absent.
  void CheckFiles() {
    if (Exists("pieces.exr")) {
      const Image image = ReadImage(folder_ / "pieces.exr");
      EXPECT_EQ(image.width, 48);
      ++images_;
    }
    if (Exists("pieces.checkpoint")) {
      const PartReader part(folder_ / "pieces.checkpoint", PartKind::Checkpoint);
      EXPECT_GT(part.Header().samples, 0u);
      ++checkpoints_;
    }
  }

  int images_ = 0, checkpoints_ = 0;
};

TEST_F(Kill, AtFiftyRandomMomentsNothingIsLost) {
  constexpr int kFewest = 50;
  const char* const settings[] = {"path --learn-always --spp 400", "bdpt --spp 300", "vcm --spp 150", "sppm --spp 150",
                                  "light --spp 400"};
  std::mt19937 random(8);
  int kills = 0, renders = 0;
  while (kills < kFewest) {
    for (const char* setting : settings) {
      const std::string command = std::string("render scene.pbrt --quiet --integrator ") + setting;
      const auto start = Clock::now();
      Do(command + " -o whole.exr");
      kills += RenderInPieces(command, 0.9 * SecondsSince(start), random);
      ++renders;
      EXPECT_EQ(Bytes("pieces.exr"), Bytes("whole.exr")) << setting;
      // The render is over: going on with it changes nothing.
      Do(command + " -o pieces.exr --resume");
      EXPECT_EQ(Bytes("pieces.exr"), Bytes("whole.exr")) << setting;
      std::filesystem::remove(folder_ / "pieces.exr");
      std::filesystem::remove(folder_ / "pieces.checkpoint");
    }
    ASSERT_LT(renders, 200) << "no render lived long enough to be killed";
  }
  EXPECT_GT(checkpoints_, kFewest / 5) << "most were killed before they had anything to lose";
  std::printf("[   info   ] %d kills in %d renders; %d images and %d checkpoints met, all whole\n", kills, renders,
              images_, checkpoints_);
  // Nothing half written stays.
  for (const auto& entry : std::filesystem::directory_iterator(folder_.Path())) {
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    EXPECT_NE(entry.path().extension(), ".lock") << entry.path();
  }
}

}  // namespace
}  // namespace lampyr::test
