// Preview of a render that is still running: a PNG of the picture so far, and a small picture in the terminal.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "film/image.h"
#include "render/progressive_render.h"

namespace lampyr {

class Preview {
 public:
  // `png`: written at most every `seconds`, atomically. `quiet`: nothing on the terminal.
  Preview(std::filesystem::path png, double seconds, float exposure, ToneMap toneMap, bool quiet);

  // To be called after passes. Writes the picture so far when it is due; `progress` is cleared before printing.
  void MayShow(const ProgressiveRender& render, double secondsSoFar, Progress& progress);

 private:
  void PrintPicture(const Image& image, Progress& progress);

  const std::filesystem::path png_;
  const double seconds_;
  const float exposure_;
  const ToneMap toneMap_;
  const bool isOnTerminal_;
  double next_;
  bool hasFailed_ = false;  // writing a picture failed
  int lines_ = 0;  // of the picture on the terminal
};

}  // namespace lampyr
