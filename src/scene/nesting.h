// Nesting of named objects: textures of textures, materials of materials, filters of filters. Evaluating an object
// evaluates those within it, recursively, each as often as it is named: a few lines can describe more evaluations than
// a machine can execute. They are counted while the objects are made, each object after those that it names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/error.h"
#include "scene/limits.h"

namespace lampyr {

class Nesting {
 public:
  // An object that names no other.
  Nesting() = default;

  // Adds a part that is evaluated whenever this object is.
  void Add(const Nesting& part) {
    depth_ = std::max(depth_, part.depth_ + 1);
    evaluations_ += part.evaluations_;
  }

  size_t Depth() const { return depth_; }              // nesting depth
  double Evaluations() const { return evaluations_; }  // per evaluation of this object

  // Throws an Error at `where` if the depth or the number of evaluations is too large. `what`: the kind of objects,
  // plural. `defined`: their number in the scene; that many evaluations are always allowed.
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
