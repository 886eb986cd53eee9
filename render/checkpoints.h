// Checkpoints: the state of a render, written to disk at intervals, so that the render can be resumed however it ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "render/progressive_render.h"
#include "render/render_part.h"

namespace lampyr {

// Path of an image's checkpoint: out.checkpoint beside out.exr.
std::filesystem::path CheckpointPath(const std::filesystem::path& image);

class Checkpoints {
 public:
  // `seconds`: interval between checkpoints. `header`: header of all checkpoints, but for the number of samples.
  // `writeImage` writes the picture so far; it is called before each checkpoint.
  Checkpoints(std::filesystem::path path, double seconds, PartHeader header, const ProgressiveRender& render,
              std::function<void(const RenderOutcome&)> writeImage);

  // Writes picture and checkpoint if the interval has passed. The interval grows with the time that writing takes, so
  // that checkpoints of large pictures cost little. An error is only a warning: the render goes on, and the next
  // checkpoint may succeed.
  void MayWrite(const RenderOutcome& soFar);
  // Writes the last checkpoint. Throws an Error.
  void Finish(const RenderOutcome& outcome);

 private:
  using Clock = std::chrono::steady_clock;
  void Write(const RenderOutcome& outcome);

  std::filesystem::path path_;
  double seconds_;
  PartHeader header_;
  const ProgressiveRender& render_;
  std::function<void(const RenderOutcome&)> writeImage_;
  Clock::time_point last_ = Clock::now();
  double lastCost_ = 0;  // seconds
};

// Loads a checkpoint into `render`. Throws a UsageError if it is of another render or has more samples than are wanted,
// an Error if it is damaged.
void ResumeFrom(const std::filesystem::path& path, const PartHeader& header, ProgressiveRender& render);

}  // namespace lampyr
