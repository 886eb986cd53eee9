// A render's state on the disk, now and then, so that it can be gone on with whatever ends it.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "render/progressive_render.h"
#include "render/render_part.h"

namespace lampyr {

// Beside the image: out.exr has out.checkpoint.
std::filesystem::path CheckpointPath(const std::filesystem::path& image);

class Checkpoints {
 public:
  // `seconds` between two of them. `header` is that of all that are written, but for its samples. `writeImage` writes
  // the picture so far; a checkpoint comes after it.
  Checkpoints(std::filesystem::path path, double seconds, PartHeader header, const ProgressiveRender& render,
              std::function<void(const RenderOutcome&)> writeImage);

  // Writes if it is time: those of a large picture that take long come less often, so that they cost little. What goes
  // wrong is a warning, and the next one may succeed: no render ends for it.
  void MayWrite(const RenderOutcome& soFar);
  // The last one. Throws an Error.
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

// Goes on where the checkpoint ends. Throws a UsageError where it is of another render, an Error where it is damaged.
void ResumeFrom(const std::filesystem::path& path, const PartHeader& header, ProgressiveRender& render);

}  // namespace lampyr
