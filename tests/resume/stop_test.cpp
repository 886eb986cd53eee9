// SIGTERM, SIGINT and SIGHUP at random moments: each is answered within two seconds, wherever a pass is, by an image
// and a checkpoint that are whole. LAMPYR_STOPS sets the number of moments (20); `tests/run stops` takes 200.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "film/image.h"
#include "render/render_part.h"
#include "resume/resume_fixture.h"

namespace lampyr::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLongest = 2;  // seconds

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void Sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// The field of /proc/loadavg that counts the threads which run or want to.
double RunningThreads() {
  std::ifstream file("/proc/loadavg");
  std::string skipped, running;
  file >> skipped >> skipped >> skipped >> running;
  return std::atof(running.c_str());
}

// Closed and white: no path ever ends.
constexpr const char* kSphere = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 1000000000
WorldBegin
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0.3 0.2]
Material "diffuse" "rgb reflectance" [1 1 1]
Shape "sphere" "float radius" 2
)";
// Mirrors within a mirror, and glass within glass, all without loss.
constexpr const char* kMirrors = R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
LookAt 0 0 -1.5  0 0 1  0 1 0
Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 1000000000
WorldBegin
AttributeBegin Translate 0 1.5 0
AreaLightSource "diffuse" "rgb L" [4 4 4] Material "diffuse" "rgb reflectance" [1 1 1] Shape "sphere" "float radius" 0.2
AttributeEnd
Material "conductor" "rgb reflectance" [1 1 1]
Shape "sphere" "float radius" 2
AttributeBegin Translate 0.8 0 0 Shape "sphere" "float radius" 0.5 AttributeEnd
Material "dielectric" "float eta" 1.5
AttributeBegin Translate -0.8 0 0
Shape "sphere" "float radius" 0.6 Shape "sphere" "float radius" 0.5 Shape "sphere" "float radius" 0.4
AttributeEnd
)";

class Stop : public Resume {
 protected:
  Stop() {
    WriteBytes(folder_ / "sphere.pbrt", kSphere);
    WriteBytes(folder_ / "mirrors.pbrt", kMirrors);
    WriteBytes(folder_ / "mesh.pbrt", LargeMesh());
  }

  // Takes long to be read.
  static std::string LargeMesh() {
    constexpr int side = 400;
    std::string points, indices;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        points += std::to_string(x) + " " + std::to_string((x * y) % 7) + " " + std::to_string(y) + "\n";
        if (x == 0 || y == 0) continue;
        const int i = y * side + x;
        for (const int corner : {i, i - 1, i - side - 1}) indices += std::to_string(corner) + " ";
      }
    }
    return std::string(kScene) + "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [" +
           indices + "]\n";
  }

  struct Answer {
    double seconds = 0;       // from the signal to the end
    double otherThreads = 0;  // that wanted to run meanwhile, on the mean, beside those of this process
    int exitCode = 0;
  };
  // Renders, or compares, until a moment.
  Answer StopAt(const std::string& command, double moment, int signal) {
    LampyrProcess process(folder_.Path(), command);
    const auto start = Clock::now();
    while (SecondsSince(start) < moment && !process.HasEnded()) Sleep(0.002);
    EXPECT_FALSE(process.HasEnded()) << command << ": over before it could be stopped";
    const auto asked = Clock::now();
    double running = 0;
    int looks = 0;
    kill(process.Id(), signal);
    while (!process.HasEnded() && SecondsSince(asked) < 60) {
      running += RunningThreads();
      ++looks;
      Sleep(0.01);
    }
    Answer answer;
    answer.seconds = SecondsSince(asked);
    const double own = std::thread::hardware_concurrency() + 1;
    answer.otherThreads = std::max(running / std::max(looks, 1) - own, 0.0);
    answer.exitCode = process.HasEnded() ? process.Wait() : process.Kill(SIGKILL);
    return answer;
  }

  // Again where the machine had no time for it, because others wanted more than it has; in a calmer moment, if one
  // comes.
  Answer AnswerTo(const std::string& command, double moment, int signal) {
    const auto cores = static_cast<double>(std::thread::hardware_concurrency());
    for (int repeat = 0;; ++repeat) {
      RemoveOutput();
      const Answer answer = StopAt(command, moment, signal);
      if (answer.seconds < kLongest || answer.otherThreads < cores || repeat == 5) return answer;
      ++overloaded_;
      const auto start = Clock::now();
      while (RunningThreads() > 1 + cores && SecondsSince(start) < 10) Sleep(0.05);
    }
  }

  void RemoveOutput() {
    for (const char* name : {"out.exr", "out.checkpoint", ".out.exr.lock"}) std::filesystem::remove(folder_ / name);
    std::filesystem::remove_all(folder_ / "report");
  }

  // Checks the output of a stopped render. Without an image, it was stopped before it began, and has left no file.
  void CheckOutput(const std::string& command) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.Path()))
      EXPECT_NE(entry.path().extension(), ".tmp") << command << ": " << entry.path();
    if (!Exists("out.exr")) {
      EXPECT_FALSE(Exists("out.checkpoint")) << command;
      ++early_;
      return;
    }
    EXPECT_FALSE(Exists(".out.exr.lock")) << command;
    const PartReader part(folder_ / "out.checkpoint", PartKind::Checkpoint);
    const std::string samples = std::to_string(part.Header().samples);
    EXPECT_EQ(ReadImage(folder_ / "out.exr").metadata.at("lampyr.samplesPerPixel"), samples) << command;
    (part.Header().samples == 0 ? partial_ : whole_)++;
  }

  int overloaded_ = 0, early_ = 0, partial_ = 0, whole_ = 0;
};

TEST_F(Stop, IsAnsweredWithinTwoSecondsWhereverAPassIs) {
  const char* const commands[] = {
      "sphere.pbrt --integrator path", "mirrors.pbrt --integrator path",
      "scene.pbrt --integrator vcm",   "scene.pbrt --integrator sppm --photons 2000000",
      "sphere.pbrt --integrator bdpt", "scene.pbrt --integrator path --learn-always --resolution 400x300",
      "mesh.pbrt --integrator bdpt",   "mirrors.pbrt --integrator vcm",
      "sphere.pbrt --integrator sppm", "scene.pbrt --integrator bdpt --resolution 320x240",
      "sphere.pbrt --integrator vcm",  "mirrors.pbrt --integrator sppm",
      "sphere.pbrt --integrator light"};
  const char* const wanted = std::getenv("LAMPYR_STOPS");
  const int moments = wanted ? std::atoi(wanted) : 20;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> moment(0.01, wanted ? 2.0 : 0.5);
  double longest = 0, sum = 0;
  for (int i = 0; i < moments; ++i) {
    const int signal = std::array{SIGTERM, SIGINT, SIGHUP}[static_cast<size_t>(i) % 3];
    const std::string chosen = commands[static_cast<size_t>(i) % std::size(commands)];
    const std::string command = "render " + chosen + " --quiet --spp 100000000 --checkpoint 1h -o out.exr";
    const Answer answer = AnswerTo(command, moment(random), signal);
    EXPECT_LT(answer.seconds, kLongest) << command << "; " << answer.otherThreads << " other threads wanted to run";
    EXPECT_EQ(answer.exitCode, 128 + signal) << command;
    CheckOutput(command);
    longest = std::max(longest, answer.seconds);
    sum += answer.seconds;
  }
  std::printf(
      "[   info   ] %d stops: %d before the first pass, %d within it, %d after it; answered in %.2f s, %.2f s at most; "
      "%d repeated for a busy machine\n",
      moments, early_, partial_, whole_, sum / moments, longest, overloaded_);
}

// The sums of whole samples are what counts: those of the pass that was cut short are added again.
TEST_F(Stop, ThenTheRenderGoesOnToTheSameBytes) {
  const std::string render = "render scene.pbrt --quiet --resolution 240x180 -o out.exr ";
  for (const char* integrator : {"--integrator bdpt ", "--integrator vcm "}) {
    RemoveOutput();
    const Answer answer = StopAt(render + integrator + "--spp 1000000 --checkpoint 1h", 1.0, SIGTERM);
    EXPECT_EQ(answer.exitCode, 143);
    const PartReader part(folder_ / "out.checkpoint", PartKind::Checkpoint);
    const std::string samples = "--spp " + std::to_string(part.Header().samples + 1);
    Do(render + integrator + samples + " --resume");
    const std::string resumed = Bytes("out.exr");
    RemoveOutput();
    Do(render + integrator + samples);
    EXPECT_TRUE(Bytes("out.exr") == resumed) << integrator;
  }
}

TEST_F(Stop, WithoutAWholeSampleTheMessageSaysWhatThePictureIs) {
  const Outcome timed = Run("render sphere.pbrt --time 0.3s --resume -o out.exr");
  EXPECT_EQ(timed.exitCode, 1) << timed.output;
  EXPECT_NE(timed.output.find("error: no sample of every pixel was done in the time (--time): the picture is a part of "
                              "the first sample: 0 % of its pixels have it, the others are black"),
            std::string::npos)
      << timed.output;
  CheckOutput("sphere.pbrt");
  EXPECT_EQ(partial_, 1);
  // From the beginning.
  const Outcome again = Run("render sphere.pbrt --time 0.3s --resume -o out.exr");
  EXPECT_NE(again.output.find("out.checkpoint: goes on after 0 spp"), std::string::npos) << again.output;
}

TEST_F(Stop, TimeIsHeldWithinAPass) {
  for (const char* integrator : {"path", "bdpt", "sppm"}) {
    const auto start = Clock::now();
    Run(std::string("render sphere.pbrt --quiet --time 0.2s -o out.exr --integrator ") + integrator);
    EXPECT_LT(SecondsSince(start), 0.2 + kLongest) << integrator;
    EXPECT_EQ(ReadImage(folder_ / "out.exr").metadata.at("lampyr.samplesPerPixel"), "0");
  }
}

TEST_F(Stop, OfAComparisonIsAnsweredWithinAPass) {
  const std::string command = "compare sphere.pbrt --integrators path,vcm --budget 60s --quiet -o report";
  for (const int signal : {SIGINT, SIGHUP}) {
    const Answer answer = AnswerTo(command, 1.0, signal);
    EXPECT_LT(answer.seconds, kLongest);
    EXPECT_EQ(answer.exitCode, 128 + signal);
  }
}

// The same for a part, whose image holds whole samples only.
TEST_F(Stop, APartWithoutAWholeSampleIsNotFinished) {
  const Outcome outcome = Run("render sphere.pbrt --quiet --spp 8 --time 0.2s --shard 1/2 -o p1.exr");
  EXPECT_NE(outcome.output.find("the part holds no samples"), std::string::npos) << outcome.output;
  const PartReader part(folder_ / "p1.exr", PartKind::Picture);
  EXPECT_EQ(part.Header().samples, 0u);
  EXPECT_FALSE(part.Header().isFinished);
}

TEST_F(Stop, ASecondSignalEndsAtOnce) {
  LampyrProcess render(folder_.Path(), "render sphere.pbrt --quiet -o out.exr");
  Sleep(0.7);
  kill(render.Id(), SIGTERM);
  Sleep(0.1);
  const auto start = Clock::now();
  EXPECT_EQ(render.Kill(SIGINT), 128 + SIGINT);
  EXPECT_LT(SecondsSince(start), 0.5 * kLongest);
  EXPECT_FALSE(Exists("out.exr"));
}

// The shell and the system both tell of a connection that is lost.
TEST_F(Stop, ASecondHangupDoesNot) {
  LampyrProcess render(folder_.Path(), "render sphere.pbrt --quiet -o out.exr");
  Sleep(0.7);
  kill(render.Id(), SIGHUP);
  Sleep(0.1);
  EXPECT_EQ(render.Kill(SIGHUP), 128 + SIGHUP);
  EXPECT_TRUE(Exists("out.exr"));
}

// As under nohup.
TEST_F(Stop, AHangupThatIsIgnoredStaysSo) {
  const Outcome outcome = RunLampyr(
      folder_.Path(), "render scene.pbrt --quiet --time 1s -o out.exr & p=$!; sleep 0.5; kill -HUP $p; wait $p",
      "trap '' HUP;");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
}

}  // namespace
}  // namespace lampyr::test
