#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/command_line.h"
#include "app/commands.h"
#include "film/mix.h"
#include "render/output_files.h"

namespace lampyr {

namespace {

// LAYER=FACTOR: one number, or three for R, G and B.
LayerFactor ParseFactor(const std::string& text) {
  const size_t equals = text.find('=');
  const auto fail = [&] {
    throw UsageError("\"" + text + "\": a layer and its factor are wanted, such as key=2 or fill=0.5,0.4,0.3");
  };
  if (equals == std::string::npos || equals == 0) fail();
  std::vector<float> values;
  for (const std::string& number : Split(text.substr(equals + 1), ',')) {
    char* rest = nullptr;
    values.push_back(std::strtof(number.c_str(), &rest));
    if (number.empty() || *rest != '\0' || !std::isfinite(values.back())) fail();
  }
  if (values.size() != 1 && values.size() != 3) fail();
  const std::string layer = text.substr(0, equals);
  return {layer, values.size() == 1 ? Color(values[0]) : Color(values[0], values[1], values[2])};
}

}  // namespace

int RunMix(const MixOptions& options) {
  CheckImageOutput(options.output, "--output", options.png);
  if (IsSameFile(options.input, options.output))
    throw UsageError("\"" + options.output.string() + "\" is the picture that is read: name another with --output");
  std::vector<LayerFactor> factors;
  for (const std::string& factor : options.factors) factors.push_back(ParseFactor(factor));
  Image mixed;
  bool hadVariances = false;
  std::vector<std::string> layers;
  try {
    const Image image = ReadImage(options.input);
    hadVariances = image.ChannelIndex("variance.R") >= 0;
    layers = ColorLayers(image);
    mixed = LocateErrors({std::make_shared<const std::string>(options.input.string())},
                         [&] { return MixLayers(image, factors); });
  } catch (const Error& wrong) {  // images that cannot be read or lack the layer are wrong usage
    throw UsageError(wrong.Where(), wrong.Text());
  }
  if (hadVariances && mixed.ChannelIndex("variance.R") < 0 && !options.quiet)
    std::fprintf(stderr, "the variances of what is mixed are not known, because lights share paths: left out\n");
  const std::vector<std::string> kept = ColorLayers(mixed);
  std::string lost;
  for (const std::string& layer : layers) {
    if (std::find(kept.begin(), kept.end(), layer) == kept.end()) lost += (lost.empty() ? "" : ", ") + layer;
  }
  if (!lost.empty() && !options.quiet)
    std::fprintf(stderr, "how much of the light that has changed is in these layers is not known: left out: %s\n",
                 lost.c_str());
  WriteExr(options.output, mixed, ExrPrecision::Float);
  if (options.png) WritePngBeside(options.output, mixed, options.exposure, options.clipPng);
  if (!options.quiet) std::fprintf(stderr, "%s: %d×%d\n", options.output.c_str(), mixed.width, mixed.height);
  return kExitDone;
}

}  // namespace lampyr
