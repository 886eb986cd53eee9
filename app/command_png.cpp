#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "film/image_colors.h"
#include "render/output_files.h"

namespace lampyr {

int RunPng(const PngOptions& options) {
  const std::filesystem::path output =
      options.output.empty() ? std::filesystem::path(options.input).replace_extension(".png") : options.output;
  if (output.extension() != ".png") throw UsageError("--output: \"" + output.string() + "\" must end in .png");
  if (IsSameFile(options.input, output))
    throw UsageError("\"" + output.string() + "\" is the image that is read: name another with --output");
  Image image;
  try {
    image = InRec709(ReadImage(options.input), WhiteHandling::Adapt, GamutHandling::Keep);
    if (!image.HasRgb()) throw Error("\"" + options.input.string() + "\" has no R, G and B channels");
  } catch (const Error& wrong) {  // images that cannot be read are wrong usage
    throw UsageError(wrong.Where(), wrong.Text());
  }
  CheckWritable(output, "--output");
  WritePng(output, image, options.exposure, options.clip ? ToneMap::Clip : ToneMap::Filmic);
  if (!options.quiet) std::fprintf(stderr, "%s: %d×%d\n", output.c_str(), image.width, image.height);
  return kExitDone;
}

}  // namespace lampyr
