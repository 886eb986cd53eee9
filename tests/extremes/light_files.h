// Small files that lights of the suite read, written when they are asked for.
#pragma once

#include <functional>
#include <string>

namespace lampyr::test {

// An image of floats, gray; returns its path. `name` without extension.
std::string WriteTexels(const std::string& name, int width, int height, const std::function<float(int, int)>& texel);
std::string WriteText(const std::string& name, const std::string& text);

}  // namespace lampyr::test
