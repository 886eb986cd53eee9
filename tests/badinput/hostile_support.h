// Support for the tests of hostile files: the memory that a refusal takes, and building a scene's text.
#pragma once

#include <fstream>
#include <string>

#include "render/build/scene_builder.h"
#include "unit/scene/scene_support.h"

namespace lampyr {

// Peak memory of this process since Restart, MiB.
class PeakMemory {
 public:
  PeakMemory() {
    std::ofstream("/proc/self/clear_refs") << "5";
    before_ = HighWaterMark();
  }
  double GrownBy() const { return HighWaterMark() - before_; }

 private:
  static double HighWaterMark() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
      double kibibytes = 0;
      if (word == "VmHWM:" && status >> kibibytes) return kibibytes / 1024;
    }
    return 0;
  }
  double before_ = 0;
};

constexpr uint64_t kMebibyte = uint64_t{1} << 20;

// The error of building the scene `text`, named scene.pbrt in `folder`, with a budget of `memory` bytes.
inline std::string BuildError(const std::string& text, const std::filesystem::path& folder = {},
                              uint64_t memory = 256 * kMebibyte) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  RenderOverrides overrides;
  overrides.memory = memory;
  return ErrorOf(
      [&] { BuildScene(ParseScene(text, folder / "scene.pbrt", diagnostics), overrides, true, diagnostics); });
}

}  // namespace lampyr
