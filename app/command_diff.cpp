#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
#include "film/image_colors.h"
#include "film/metrics.h"
#include "render/output_files.h"
#include "render/sample_image.h"

namespace lampyr {

namespace {

void Print(const ImageDifference& difference) {
  std::printf("MSE      %.6g\n", difference.mse);
  std::printf("relMSE   %.6g\n", difference.relMse);
  std::printf("FLIP     %.4f\n", difference.flip);
  std::printf("mean     %.6g against %.6g: bias %+.3f %% ± %.3f %% (95 %%)\n", difference.meanA, difference.meanB,
              100 * difference.bias, 100 * difference.biasInterval);
  const BlockTest& test = difference.blockTest;
  switch (difference.verdict) {
    case Verdict::Equal:
      std::printf("z-test   equal: no value differs by more than rounding\n");
      break;
    case Verdict::CannotSay:
      std::printf("z-test   cannot say: %s\n", difference.reason.c_str());
      break;
    case Verdict::Agree:
    case Verdict::Differ:
      std::printf("z-test   %s: %d blocks of %d×%d, largest |z| %.2f (threshold %.2f), χ² %.1f (threshold %.1f)\n",
                  difference.verdict == Verdict::Agree ? "agree" : "DIFFER", test.blocks, test.blockSize,
                  test.blockSize, test.largestZ, test.threshold, test.chiSquared, test.chiSquaredThreshold);
      break;
  }
}

// Images are compared in one colour space, whatever their own are.
Image ReadInRec709(const std::filesystem::path& file) {
  return InRec709(ReadImage(file), WhiteHandling::Adapt, GamutHandling::Keep);
}

}  // namespace

int RunDiff(const DiffOptions& options) {
  if (!options.output.empty()) CheckImageOutput(options.output, "--output", false);
  for (const std::filesystem::path& input : {options.a, options.b}) {
    if (!options.output.empty() && IsSameFile(input, options.output))
      throw UsageError("--output: \"" + options.output.string() +
                       "\" is one of the images that are compared: it would be lost; write to another file");
  }
  ImageDifference difference;
  Image error;
  try {
    const Image a = ReadInRec709(options.a), b = ReadInRec709(options.b);
    difference = CompareImages(a, b, options.blockSize);
    if (!options.output.empty()) error = DifferenceImage(a, b);
  } catch (const Error& wrong) {  // images that cannot be read or compared are wrong usage
    throw UsageError(wrong.Where(), wrong.Text());
  }
  if (!options.output.empty()) WriteExr(options.output, error, ExrPrecision::Float);
  if (options.json) {
    std::printf("%s", ToJson(difference).c_str());
  } else {
    Print(difference);
  }
  const bool agrees = difference.verdict == Verdict::Equal || difference.verdict == Verdict::Agree;
  return options.fail && !agrees ? kExitFailed : kExitDone;
}

}  // namespace lampyr
