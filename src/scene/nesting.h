// Named things that are made of other named things: textures of textures, materials of materials, filters of filters.
// Asking one asks those within it, recursively, and each as often as it is named: a few lines can describe more
// evaluations than a machine can make. Counted while the things are made, in the order in which they name one another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/error.h"
#include "scene/limits.h"

namespace lampyr {

class Nesting {
 public:
  // A thing that names nothing.
  Nesting() = default;

  // What is asked of `part` is asked whenever this is asked.
  void Add(const Nesting& part) {
    depth_ = std::max(depth_, part.depth_ + 1);
    evaluations_ += part.evaluations_;
  }

  size_t Depth() const { return depth_; }              // things within one another
  double Evaluations() const { return evaluations_; }  // of one that is asked once

  // Throws an Error at `where`. `what`: what they are, plural; `defined`: how many of them the scene has, which may
  // all be asked once.
  void Check(const char* what, size_t defined, const FileLocation& where) const {
    if (depth_ > limits::kNestedNames) throw Error(where, std::string(what) + " are nested more than 256 deep");
    const size_t most = std::max(limits::kEvaluations, defined);
    if (evaluations_ <= static_cast<double>(most)) return;
    throw Error(where, std::string(what) + " within one another multiply to more than " + std::to_string(most) +
                           " evaluations; each counts as often as it is named");
  }

 private:
  size_t depth_ = 1;
  double evaluations_ = 1;
};

}  // namespace lampyr
