// Statements that change the current transformation matrix (CTM). Each multiplies from the right: the last statement is
// applied to a point first.
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/limits.h"
#include "scene/scene_parser.h"

namespace lampyr {

namespace {

// True if the determinant is lost in rounding: far below the product of the lengths of the columns [Hadamard93].
bool IsNearlySingular(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return !(std::abs(glm::determinant(linear)) > 1e-14 * volume);
}

// True if all elements fit floats, in which rendering keeps matrices and their inverses.
bool FitsFloat(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (std::abs(m[column][row]) > static_cast<double>(std::numeric_limits<float>::max())) return false;
    }
  }
  return true;
}

}  // namespace

bool SceneParser::IsInvertible(const Token& statement, const Transform& transform) {
  if (transform.IsSingular()) return false;
  if (!FitsFloat(transform.Matrix()) || !FitsFloat(transform.InverseMatrix())) {
    throw Error(statement.where, statement.text + " makes the transform too large or too small (beyond 3.4e38)");
  }
  return true;
}

Placement SceneParser::PlacementOf(const Token& statement) const {
  if (const std::optional<Token>& singular = state_.Singular()) {
    throw Error(singular->where, singular->text + " makes the transform singular: it cannot be inverted, as " +
                                     statement.text + " at " + statement.where.ToString() + " needs it");
  }
  return {state_.ctm[0], state_.ctm[1]};
}

bool SceneParser::LeavesOutSingular(const Token& statement) const {
  const std::optional<Token>& singular = state_.Singular();
  if (!singular) return false;
  diagnostics_.Warn(statement.where, "this " + statement.text + " is left out: " + singular->text + " at " +
                                         singular->where.ToString() +
                                         " makes its transform singular, so that it has no extent");
  return true;
}

void SceneParser::Concat(const Token& statement, const Transform& transform) {
  const bool isSingular = IsNearlySingular(transform.Matrix()) || !IsInvertible(statement, transform);
  for (size_t i = 0; i < 2; ++i) {
    if (!state_.active[i] || state_.singular[i]) continue;  // remains singular
    const Transform product = isSingular ? transform : state_.ctm[i] * transform;
    if (isSingular || !IsInvertible(statement, product)) {
      state_.singular[i] = statement;
    } else {
      state_.ctm[i] = product;
    }
  }
}

void SceneParser::Identity(const Token&) {
  for (size_t i = 0; i < 2; ++i) {
    if (!state_.active[i]) continue;
    state_.singular[i].reset();
    state_.ctm[i] = Transform();
  }
}

void SceneParser::Translate(const Token& statement) {
  const auto n = ReadNumbers<3>(statement);
  Concat(statement, Transform::Translate({n[0], n[1], n[2]}));
}

void SceneParser::Scale(const Token& statement) {
  const auto n = ReadNumbers<3>(statement);
  Concat(statement, Transform::Scale({n[0], n[1], n[2]}));
}

void SceneParser::Rotate(const Token& statement) {
  const auto n = ReadNumbers<4>(statement);
  const Vector3d axis(n[1], n[2], n[3]);
  const double size = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  if (size == 0) throw Error(statement.where, "the axis of Rotate is (0, 0, 0)");
  Concat(statement, Transform::Rotate(n[0], axis / size));
}

void SceneParser::LookAt(const Token& statement) {
  const auto n = ReadNumbers<9>(statement);
  const Point3d eye(n[0], n[1], n[2]), target(n[3], n[4], n[5]);
  const Vector3d up(n[6], n[7], n[8]), direction = target - eye;
  const auto size = [](const Vector3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  if (size(direction) == 0) throw Error(statement.where, "LookAt looks at the point it stands at");
  if (size(up) == 0) throw Error(statement.where, "the up vector of LookAt is (0, 0, 0)");
  const Vector3d unitUp = glm::normalize(up / size(up)), unitDirection = glm::normalize(direction / size(direction));
  if (glm::length(glm::cross(unitUp, unitDirection)) < 1e-9) {
    throw Error(statement.where, "the up vector of LookAt is parallel to the direction of view");
  }
  Concat(statement, Transform::LookAt(eye, target, unitUp));
}

std::array<double, 16> SceneParser::ReadMatrix(const Token& statement) {
  const Token open = tokens_.Next();
  if (open.kind != TokenKind::Open) {
    throw Error(open.where, statement.text + " needs 16 numbers in brackets, found " + Describe(open));
  }
  const auto matrix = ReadNumbers<16>(statement);
  const Token close = tokens_.Next();
  if (close.kind != TokenKind::Close) {
    throw Error(close.where, statement.text + " needs \"]\" after 16 numbers, found " + Describe(close));
  }
  return matrix;
}

namespace {

// Numbers are in column-major order, as in GLM: 12, 13, 14 are the translation.
Transform MatrixTransform(const std::array<double, 16>& n, const Token& statement) {
  // Exporters that invert matrices leave rounding errors in the last row.
  constexpr double kRounding = 1e-5;
  const double largest = std::max({std::abs(n[3]), std::abs(n[7]), std::abs(n[11])});
  if (!(largest <= kRounding * std::abs(n[15])) || n[15] == 0) {
    throw Error(statement.where, "the matrix of " + statement.text +
                                     " is not affine: its 4th, 8th and 12th numbers must be 0 and its 16th must not");
  }
  glm::dmat4 m(1.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) m[column][row] = n[4 * column + row] / n[15];
  }
  return Transform(m);
}

}  // namespace

void SceneParser::TransformStatement(const Token& statement) {
  const Transform transform = MatrixTransform(ReadMatrix(statement), statement);
  const bool isSingular = IsNearlySingular(transform.Matrix()) || !IsInvertible(statement, transform);
  for (size_t i = 0; i < 2; ++i) {
    if (!state_.active[i]) continue;
    state_.singular[i].reset();
    if (isSingular) {
      state_.singular[i] = statement;
    } else {
      state_.ctm[i] = transform;
    }
  }
}

void SceneParser::ConcatTransform(const Token& statement) {
  Concat(statement, MatrixTransform(ReadMatrix(statement), statement));
}

// Only changes are recorded for Import to restore: copying all coordinate systems for each Import would be quadratic.
void SceneParser::SetCoordinateSystem(const std::string& name, const TransformPair& transforms) {
  const auto [entry, isNew] = coordinateSystems_.emplace(name, transforms);
  if (imports_ > 0) changedSystems_.emplace_back(name, isNew ? std::nullopt : std::optional(entry->second));
  entry->second = transforms;
}

void SceneParser::RestoreCoordinateSystems(size_t changes) {
  for (; changedSystems_.size() > changes; changedSystems_.pop_back()) {
    const auto& [name, before] = changedSystems_.back();
    if (before) {
      coordinateSystems_[name] = *before;
    } else {
      coordinateSystems_.erase(name);
    }
  }
}

void SceneParser::CoordinateSystem(const Token& statement) {
  const std::string name = ReadString(statement, "a name");
  const Placement placement = PlacementOf(statement);
  SetCoordinateSystem(name, {placement.start, placement.end});
}

void SceneParser::CoordSysTransform(const Token& statement) {
  const std::string name = ReadString(statement, "a name");
  const auto found = coordinateSystems_.find(name);
  if (found != coordinateSystems_.end()) {
    state_.singular = {};
    state_.ctm = found->second;
    return;
  }
  // As in pbrt-v4, the transform is unchanged, although that is unlikely to be intended.
  std::vector<std::string> names;
  if (coordinateSystems_.size() <= limits::kSuggestedNames) {
    for (const auto& entry : coordinateSystems_) names.push_back(entry.first);
  }
  diagnostics_.Warn(statement.where, "there is no coordinate system \"" + name + "\"" + DidYouMean(name, names) +
                                         ": the transform stays as it is");
}

void SceneParser::ActiveTransform(const Token& statement) {
  const Token which = tokens_.Next();
  if (which.kind == TokenKind::Word && which.text == "All") {
    state_.active = {true, true};
  } else if (which.kind == TokenKind::Word && which.text == "StartTime") {
    state_.active = {true, false};
  } else if (which.kind == TokenKind::Word && which.text == "EndTime") {
    state_.active = {false, true};
  } else {
    throw Error(which.where, statement.text + " is All, StartTime or EndTime, not " + Describe(which) +
                                 DidYouMean(which.text, {"All", "StartTime", "EndTime"}));
  }
}

void SceneParser::TransformTimes(const Token& statement) {
  const auto n = ReadNumbers<2>(statement);
  if (n[1] < n[0]) throw Error(statement.where, "TransformTimes ends before it starts");
  scene_.shutterOpen = n[0];
  scene_.shutterClose = n[1];
}

}  // namespace lampyr
