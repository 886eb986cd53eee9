#include "app/preview.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "base/terminal.h"
#include "film/terminal_picture.h"

namespace lampyr {

Preview::Preview(std::filesystem::path png, double seconds, float exposure, ToneMap toneMap, bool quiet)
    : png_(std::move(png)),
      seconds_(seconds),
      exposure_(exposure),
      toneMap_(toneMap),
      isOnTerminal_(!quiet && isatty(STDERR_FILENO) != 0 && TerminalHasTrueColor()),
      next_(seconds) {}

void Preview::MayShow(const ProgressiveRender& render, double secondsSoFar, Progress& progress) {
  if (secondsSoFar < next_) return;
  next_ = secondsSoFar + seconds_;
  const Image image = render.Picture().Develop();
  try {
    WritePng(png_, image, exposure_, toneMap_);
  } catch (const Error& error) {  // the render continues
    progress.Clear();
    if (!hasFailed_) std::fprintf(stderr, "warning: no preview: %s\n", error.Text().c_str());
    hasFailed_ = true;
  }
  if (isOnTerminal_) PrintPicture(image, progress);
}

// Overwrites the previous picture.
void Preview::PrintPicture(const Image& image, Progress& progress) {
  constexpr int kUsualColumns = 80, kMostColumns = 64, kMostLines = 20;
  const int columns = std::min(TerminalColumns(STDERR_FILENO, kUsualColumns) - 1, kMostColumns);
  const std::string picture = TerminalPicture(image, columns, kMostLines, exposure_, toneMap_);
  progress.Clear();
  if (lines_ > 0) std::fprintf(stderr, "\r\033[%dA", lines_);
  std::fputs(picture.c_str(), stderr);
  lines_ = static_cast<int>(std::count(picture.begin(), picture.end(), '\n'));
}

}  // namespace lampyr
