#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/json_report.h"
#include "film/metrics.h"

namespace lampyr {

int RunDiff(const DiffOptions& options) {
  ImageDifference difference;
  try {
    difference = CompareImages(ReadImage(options.a), ReadImage(options.b), options.blockSize);
  } catch (const Error& error) {  // what cannot be read or compared is wrong usage
    throw UsageError(error.Where(), error.Text());
  }
  if (options.json) {
    std::printf("%s", ToJson(difference).c_str());
    return kExitDone;
  }
  std::printf("MSE      %.6g\n", difference.mse);
  std::printf("relMSE   %.6g\n", difference.relMse);
  std::printf("FLIP     %.4f\n", difference.flip);
  std::printf("mean     %.6g against %.6g: bias %+.3f %% ± %.3f %% (95 %%)\n", difference.meanA, difference.meanB,
              100 * difference.bias, 100 * difference.biasInterval);
  if (difference.hasBlockTest) {
    const BlockTest& test = difference.blockTest;
    std::printf("z-test   %s: %d blocks of %d×%d, largest |z| %.2f (threshold %.2f), χ² %.1f (threshold %.1f)\n",
                test.Agrees() ? "agree" : "DIFFER", test.blocks, test.blockSize, test.blockSize, test.largestZ,
                test.threshold, test.chiSquared, test.chiSquaredThreshold);
  } else {
    std::printf("z-test   none: both images need variance layers\n");
  }
  return kExitDone;
}

}  // namespace lampyr
