// A scene to be rendered repeatedly, with each integrator and many seeds.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "base/work_timer.h"
#include "render/build/scene_builder.h"
#include "render/progressive_render.h"

namespace lampyr {

// Thrown after an interrupt.
struct ComparisonInterrupted {};

class ComparedScene {
 public:
  // `built` must outlive this. `ofProcessor`: times are processor times over the threads, instead of wall-clock times;
  // other work on the machine then has little influence.
  ComparedScene(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted, bool ofProcessor = false)
      : built_(built), threads_(threads), interrupted_(interrupted), ofProcessor_(ofProcessor) {}

  const BuiltScene& Built() const { return built_; }
  int Threads() const { return threads_; }

  // State of a render after `seconds` with `samplesPerPixel`.
  struct Milestone {
    double seconds = 0;
    int samplesPerPixel = 0;
    std::optional<ErrorParts> stated;  // by a render that merges photons (Film::PartsOfError)
  };
  // The picture at a milestone: `index` counts the times, then the sample counts.
  using AtMilestone = std::function<void(size_t index, const Milestone& reached, const Image& image)>;
  // Called after each pass with the seconds of rendering so far.
  using AfterPass = std::function<void(double seconds)>;

  // Renders until the last of `times` (seconds) and `sampleCounts`, both ascending, and takes a snapshot at each. The
  // time of snapshots is not counted.
  // `firstSample`: index of the first sample of a pixel; merging radii are those of a render that has reached this
  // sample.
  // `secondsBefore`: time that counts as elapsed at the start of the render; ChoiceSeconds to measure the time of a
  // user.
  // Pictures of an integrator whose name ends in ":denoise" are denoised; the time of that and of its features counts.
  // Throws ComparisonInterrupted.
  void Render(const std::string& integrator, uint64_t seed, const std::vector<double>& times,
              const std::vector<int>& sampleCounts, const AtMilestone& atMilestone, const AfterPass& afterPass,
              uint32_t firstSample = 0, double secondsBefore = 0) const;
  // The time in which "auto" chose its integrator, which is part of every render with it; 0 for other integrators.
  double ChoiceSeconds(const std::string& integrator) const;

 private:
  double Seconds(const WorkTime& time) const { return ofProcessor_ ? time.processor / threads_ : time.clock; }
  Image DenoisedPicture(const Film& film, const Image& features, int samplesPerPixel) const;

  const BuiltScene& built_;
  int threads_;
  const std::atomic<bool>& interrupted_;
  bool ofProcessor_;
};

}  // namespace lampyr
