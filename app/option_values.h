// Values of options on the command line, read from text.
#pragma once

#include <string>
#include <utility>

#include "render/settings/render_settings.h"

namespace lampyr {

// Each of these throws a UsageError that names the option and describes valid values.
// "90", "90s", "1.5m", "2h": seconds.
double ParseDuration(const std::string& option, const std::string& text);
// "640x360".
void ParseResolution(const std::string& text, RenderOverrides& overrides);
// "2/8": the second of eight parts.
std::pair<int, int> ParseShard(const std::string& text);

// Checks in the form that CLI11 takes: a description of the error in the text, or "". CLI11's own checks accept NaN.
// For options that are stored as float: smaller numbers would become 0, larger ones infinite.
std::string CheckPositive(const std::string& text);
std::string CheckFinite(const std::string& text);
// Above 0, at most 1.
std::string CheckShare(const std::string& text);
// A whole number of 64 bits.
std::string CheckSeed(const std::string& text);

}  // namespace lampyr
