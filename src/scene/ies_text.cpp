#include "scene/ies_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "scene/lexer.h"
#include "scene/text_file.h"

namespace lampyr {

namespace {

constexpr double kLargestCandela = 1e30;  // products with the factors of lights stay within float
constexpr double kSmallestStep = 1e-6;    // degrees
constexpr std::string_view kSeparators = " \t\r\n\f\v,";

std::string Shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string Trimmed(std::string_view line) {
  const size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
  return begin == std::string_view::npos ? "" : std::string(line.substr(begin, end - begin + 1));
}

std::string Upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// The text with a cursor that tracks lines.
class IesText {
 public:
  IesText(const std::string& text, const std::string& name)
      : text_(text), name_(std::make_shared<const std::string>(name)) {
    if (text_.starts_with("\xef\xbb\xbf")) position_ = lineStart_ = 3;
  }

  bool AtEnd() const { return position_ >= text_.size(); }
  size_t Remaining() const { return text_.size() - position_; }
  FileLocation Here() const { return {name_, line_, static_cast<int>(position_ - lineStart_) + 1}; }
  const std::string& Name() const { return *name_; }

  // The rest of the line, without surrounding blanks.
  std::string NextLine() {
    const size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
    const std::string line = Trimmed(text_.substr(position_, end - position_));
    position_ = end;
    if (!AtEnd()) Advance();
    return line;
  }

  void SkipSeparators() {
    while (!AtEnd() && kSeparators.find(text_[position_]) != std::string_view::npos) Advance();
  }

  double Number(const std::string& what) {
    SkipSeparators();
    if (AtEnd()) throw Error(Here(), "the file ends where " + what + " should be");
    const size_t end = std::min(text_.find_first_of(kSeparators, position_), text_.size());
    const std::string_view word = text_.substr(position_, end - position_);
    if (IsNonFinite(word)) throw Error(Here(), what + " is not a finite number: " + ShownWord(word));
    if (word.size() > 64 || !LooksLikeNumber(word))
      throw Error(Here(), "expected " + what + ", a number, found " + ShownWord(word));
    const double value = ParseNumber(word, Here());
    position_ = end;
    return value;
  }

  double NumberInRange(const std::string& what, double low, double high, const std::string& range) {
    SkipSeparators();
    const FileLocation where = Here();
    const double value = Number(what);
    if (!(value >= low && value <= high)) throw Error(where, what + " is " + Shown(value) + ": it has to be " + range);
    return value;
  }

  // Reads a count: at least `least`, and limited by the length of the rest of the file.
  size_t Count(const std::string& what, size_t least) {
    SkipSeparators();
    const FileLocation where = Here();
    const double value = Number("the number of " + what);
    if (!(value >= static_cast<double>(least)) || value != std::floor(value)) {
      throw Error(where, "the number of " + what + " has to be a whole number of at least " + std::to_string(least));
    }
    CheckRoom(value, what, where);
    return static_cast<size_t>(value);
  }

  // Throws an Error if the file is too short for `count` numbers, of which each needs a digit and a separator. Called
  // before any allocation.
  void CheckRoom(double count, const std::string& what, const FileLocation& where) const {
    const double room = std::floor((static_cast<double>(Remaining()) + 1) / 2);
    if (count > room) {
      throw Error(where, "the file announces " + Shown(count) + " " + what + " but has room for at most " +
                             std::to_string(static_cast<size_t>(room)) + " numbers");
    }
  }

  std::vector<double> AscendingAngles(size_t count, const std::string& what, double low, double high) {
    std::vector<double> angles(count);
    for (size_t i = 0; i < count; ++i) {
      SkipSeparators();
      const FileLocation where = Here();
      angles[i] = Number(what + " " + std::to_string(i + 1) + " of " + std::to_string(count));
      if (!(angles[i] >= low && angles[i] <= high)) {
        throw Error(where, what + " is out of range: it has to be between " + std::to_string(static_cast<int>(low)) +
                               " and " + std::to_string(static_cast<int>(high)) + " degrees");
      }
      if (i > 0 && !(angles[i] > angles[i - 1] + kSmallestStep))
        throw Error(where, what + " is not larger than the one before: they have to ascend");
    }
    return angles;
  }

  // Called after the last of `count` values. Words that are no numbers are remarks.
  void CheckNoNumberFollows(size_t count) {
    SkipSeparators();
    const size_t end = std::min(text_.find_first_of(kSeparators, position_), text_.size());
    const std::string_view word = text_.substr(position_, end - position_);
    const bool isNumber = LooksLikeNumber(word) && word.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
    if (AtEnd() || !isNumber) return;
    throw Error(Here(), "the file has more than the " + std::to_string(count) +
                            " candela values that it announces: its counts are wrong, or its numbers have decimal "
                            "commas, which separate numbers here");
  }

 private:
  std::string_view text_;
  std::shared_ptr<const std::string> name_;
  size_t position_ = 0, lineStart_ = 0;
  int line_ = 1;

  // Advances by one character. CR LF and a lone CR end a line like LF.
  void Advance() {
    const char c = text_[position_++];
    const bool pair = c == '\r' && position_ < text_.size() && text_[position_] == '\n';
    if (pair) ++position_;
    if (c == '\n' || c == '\r') {
      ++line_;
      lineStart_ = position_;
    }
  }
};

// The factor on the output of the lamp at tilt 0. A tilt table gives the output over the angle by which the luminaire
// is tilted out of the position in which it was measured, for lamps whose output depends on it: a factor on the whole
// distribution, not one over its directions. The lamp-to-luminaire geometry determines which tilts count: 1, the lamp
// is vertical and all do; 2 and 3, it lies in the 0°-180° or the 90°-270° plane, and tilting across the lamp changes
// nothing. A scene has no gravity: the luminaire burns as measured, at a tilt of 0, whatever the geometry.
double ReadTiltFactor(IesText& text) {
  text.NumberInRange("the lamp-to-luminaire geometry", 1, 3, "1, 2 or 3");
  const size_t count = text.Count("tilt angles and factors", 1);
  text.CheckRoom(2 * static_cast<double>(count), "tilt angles and factors", text.Here());
  const std::vector<double> angles = text.AscendingAngles(count, "tilt angle", -180, 180);
  std::vector<double> factors(count);
  for (double& factor : factors) factor = text.NumberInRange("a tilt factor", 0, 1e6, "a factor between 0 and 1000000");
  const size_t above = static_cast<size_t>(std::upper_bound(angles.begin(), angles.end(), 0.0) - angles.begin());
  if (above == 0) return factors.front();
  if (above == count) return factors.back();
  const double t = -angles[above - 1] / (angles[above] - angles[above - 1]);
  return factors[above - 1] + t * (factors[above] - factors[above - 1]);
}

std::filesystem::path TiltFile(const IesText& text, const std::string& setting) {
  return std::filesystem::path(text.Name()).parent_path() / setting;
}

double TiltFactor(IesText& text, const std::string& setting, const FileLocation& where) {
  const std::string upper = Upper(setting);
  if (upper == "NONE") return 1;
  if (upper == "INCLUDE") return ReadTiltFactor(text);
  if (setting.empty()) throw Error(where, "TILT= has to be followed by NONE, INCLUDE or the name of a file");
  const std::filesystem::path file = TiltFile(text, setting);
  const std::string contents = ReadTextFile(file, where);
  IesText tilt(contents, file.string());
  return ReadTiltFactor(tilt);
}

// The label lines up to TILT=. hasBallastLampFactor: true for editions with the ballast-lamp photometric factor, a
// number that is unused in 1995 and describes how the file was made in 2002 and 2019.
struct Labels {
  std::string tilt;
  FileLocation tiltWhere;
  bool hasBallastLampFactor = true;
};

Labels ReadLabels(IesText& text) {
  Labels labels;
  for (bool first = true; !text.AtEnd(); first = false) {
    labels.tiltWhere = text.Here();
    const std::string line = text.NextLine();
    const std::string upper = Upper(line.substr(0, 16));
    if (first && (upper.starts_with("IESNA:LM-63") || upper.starts_with("IES:LM-63")))
      labels.hasBallastLampFactor = false;
    if (!upper.starts_with("TILT")) continue;
    const size_t equals = line.find('=');
    if (equals == std::string::npos || Trimmed(std::string_view(line).substr(4, equals - 4)) != "") continue;
    labels.tilt = Trimmed(std::string_view(line).substr(equals + 1));
    return labels;
  }
  throw Error(text.Here(), "this is not an IES file: it has no line TILT=NONE, TILT=INCLUDE or TILT=<file>");
}

}  // namespace

std::string TiltFileOf(const std::string& iesFile) {
  try {
    const std::string contents = ReadTextFile(iesFile, {});
    IesText text(contents, iesFile);
    const Labels labels = ReadLabels(text);
    const std::string upper = Upper(labels.tilt);
    if (upper == "NONE" || upper == "INCLUDE" || upper.empty()) return "";
    return TiltFile(text, labels.tilt).string();
  } catch (const Error&) {
    return "";  // reported when the light is made
  }
}

IesFile ParseIesFile(const std::string& source, const std::string& name) {
  if (source.starts_with("\xff\xfe") || source.starts_with("\xfe\xff"))
    throw Error(FileLocation{std::make_shared<const std::string>(name), 1, 1}, "the file is UTF-16, not plain text");
  IesText text(source, name);
  const Labels labels = ReadLabels(text);
  double factor = TiltFactor(text, labels.tilt, labels.tiltWhere);
  text.Number("the number of lamps");
  text.Number("the lumens of a lamp");  // the candela refer to it; -1: absolute photometry
  factor *= text.NumberInRange("the candela multiplier", 0, kLargestCandela, "between 0 and 1e30");
  const size_t vertical = text.Count("vertical angles", 2);
  text.SkipSeparators();
  const FileLocation horizontalCount = text.Here();
  const size_t horizontal = text.Count("horizontal angles", 1);
  IesFile file;
  file.type = static_cast<IesPhotometry>(
      static_cast<int>(text.NumberInRange("the photometric type", 1, 3, "1 (type C), 2 (type B) or 3 (type A)")));
  for (const char* what : {"the units of length", "the luminaire's width", "the luminaire's length", "its height"})
    text.Number(what);
  factor *= text.NumberInRange("the ballast factor", 0, 1e6, "between 0 and 1000000");
  const double ballastLamp = text.Number("the ballast-lamp photometric factor (or file generation type)");
  if (labels.hasBallastLampFactor && ballastLamp > 0) factor *= ballastLamp;
  text.Number("the input watts");
  if (!(factor <= kLargestCandela))
    throw Error(labels.tiltWhere, "the tilt factor, the candela multiplier and the ballast factors make " +
                                      Shown(factor) + " together: it has to be at most 1e30");

  text.CheckRoom(static_cast<double>(vertical) * static_cast<double>(horizontal), "candela values", horizontalCount);
  const bool typeC = file.type == IesPhotometry::TypeC;
  text.SkipSeparators();
  file.verticalWhere = text.Here();
  file.vertical = text.AscendingAngles(vertical, "vertical angle", typeC ? 0 : -90, typeC ? 180 : 90);
  text.SkipSeparators();
  file.horizontalWhere = text.Here();
  file.horizontal = text.AscendingAngles(horizontal, "horizontal angle", typeC ? 0 : -90, typeC ? 360 : 90);
  file.candela.resize(vertical * horizontal);
  for (size_t i = 0; i < file.candela.size(); ++i) {
    text.SkipSeparators();
    const FileLocation where = text.Here();
    const double value =
        text.Number("candela value " + std::to_string(i + 1) + " of " + std::to_string(file.candela.size()));
    file.candela[i] = std::max(value * factor, 0.0);
    if (!(file.candela[i] <= kLargestCandela))
      throw Error(where, "the candela value " + Shown(value) + ", times the file's multipliers " + Shown(factor) +
                             ", is " + Shown(file.candela[i]) + ": it has to be at most 1e30");
  }
  text.CheckNoNumberFollows(file.candela.size());
  return file;
}

}  // namespace lampyr
