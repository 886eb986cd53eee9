#include <cstdio>

#include "app/command_line.h"
#include "app/command_support.h"
#include "app/commands.h"
#include "app/denoise_support.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "denoise/denoise.h"
#include "render/output_files.h"
#include "render/sample_image.h"

namespace lampyr {

namespace {

void PrintReport(const DenoiseReport& report) {
  if (!report.hasFeatures && !report.hasHalves) {
    std::fprintf(stderr,
                 "note: without features and halves of the samples, by colour and variance alone: `lampyr render "
                 "--denoise` keeps them\n");
  } else if (!report.hasHalves) {
    std::fprintf(stderr,
                 "note: without halves of the samples: the noise is taken as independent from pixel to pixel\n");
  } else if (!report.hasFeatures) {
    std::fprintf(stderr, "note: without features: edges are told from noise by colour alone\n");
  }
  if (report.invalidPixels > 0) {
    std::fprintf(stderr, "warning: %lld pixels are not finite: replaced by what is around them\n",
                 static_cast<long long>(report.invalidPixels));
  }
  if (report.outliers > 0) {
    std::fprintf(stderr,
                 "warning: %lld pixels stand out by a few bright samples: reduced to what is around them, which takes "
                 "%s of the light; the variance allows for it\n",
                 static_cast<long long>(report.outliers), FormatPercent(report.removed).c_str());
  }
}

}  // namespace

Image DenoiseForUser(const Image& noisy, int threads, const std::atomic<bool>& interrupted, bool quiet) {
  Progress progress(quiet);
  DenoiseReport report;
  Image image = Denoise(
      noisy, threads, interrupted, [&](double done) { progress.Update(done, "denoising"); }, report);
  progress.Clear();
  if (!quiet && !image.channels.empty()) PrintReport(report);
  return image;
}

int RunDenoise(const DenoiseOptions& options) {
  OutliveSurroundings();
  if (IsSameFile(options.input, options.output))
    throw UsageError("\"" + options.output.string() + "\" is the image that is read: name another with --output");
  CheckImageOutput(options.output, "--output", options.png);
  const OutputLock lock(options.output);
  const Progress clock(true);
  const int threads = options.threads > 0 ? options.threads : HardwareThreads();
  Image image;
  try {
    image = DenoiseForUser(ReadImage(options.input), threads, FinishOnInterrupt(), options.quiet);
  } catch (const Error& wrong) {  // files that cannot be read or denoised are wrong usage
    if (wrong.Text().starts_with("\"") || wrong.Where().file) throw UsageError(wrong.Where(), wrong.Text());
    throw UsageError("\"" + options.input.string() + "\" cannot be denoised: " + wrong.Text());
  }
  if (image.channels.empty()) {
    std::fprintf(stderr, "warning: interrupted: nothing was written\n");
    return InterruptExitCode();
  }
  WriteExr(options.output, image, ExrPrecision::Float);
  if (options.png) WritePngBeside(options.output, image, options.exposure, options.clipPng);
  if (!options.quiet) {
    std::fprintf(stderr, "%s: %d×%d, denoised in %s\n", options.output.c_str(), image.width, image.height,
                 FormatDuration(clock.Seconds()).c_str());
  }
  return kExitDone;
}

}  // namespace lampyr
