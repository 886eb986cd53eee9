#include "camera/lens_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string_view>

#include "scene/lexer.h"
#include "scene/text_file.h"

namespace lampyr {

namespace {

constexpr double kLargest = 1e9;       // mm: a radius of a kilometre counts as flat
constexpr double kLargestIndex = 10;   // far above any glass
constexpr double kFlush = 1e-6;        // mm by which rims may overlap: the numbers of a file are rounded
constexpr size_t kLongestNumber = 64;  // characters
constexpr const char* kWhatIsASurface =
    "a surface has four: radius of curvature, thickness, index of refraction and diameter of the aperture";

std::string Shown(double value) {
  std::ostringstream text;
  text << std::setprecision(9) << value;
  return text.str();
}

struct Word {
  std::string_view text;
  FileLocation where;
};

struct Row {
  LensSurface surface;
  std::array<FileLocation, 4> where;
};

// Splits a text into lines, without comments, and lines into words.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name)
      : text_(text), name_(std::make_shared<const std::string>(name)) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  bool Next(std::vector<Word>& words) {
    words.clear();
    if (position_ > text_.size()) return false;
    ++line_;
    const size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    line = line.substr(0, line.find('#'));
    for (size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
      const size_t until = std::min(line.find_first_of(kBlanks, at), line.size());
      words.push_back({line.substr(at, until - at), {name_, line_, static_cast<int>(at) + 1}});
      // Further words would be rejected anyway.
      if (words.size() > kMostWords) break;
      at = line.find_first_not_of(kBlanks, until);
    }
    position_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    return true;
  }
  FileLocation Here() const { return {name_, std::max(line_, 1), 1}; }

 private:
  static constexpr std::string_view kBlanks = " \t\v\f";
  static constexpr size_t kMostWords = 4;

  std::string_view text_;
  std::shared_ptr<const std::string> name_;
  size_t position_ = 0;
  int line_ = 0;
};

double NumberOf(const Word& word, const char* what) {
  if (IsNonFinite(word.text)) throw Error(word.where, std::string(what) + " is not finite: " + ShownWord(word.text));
  if (word.text.size() > kLongestNumber || !LooksLikeNumber(word.text) ||
      word.text.find_first_not_of("0123456789+-.eE") != std::string_view::npos)
    throw Error(word.where, "expected " + std::string(what) + ", a number, found " + ShownWord(word.text));
  return ParseNumber(word.text, word.where);
}

Row RowOf(const std::vector<Word>& words) {
  if (words.size() != 4) {
    const std::string count = words.size() > 4 ? "more than 4" : std::to_string(words.size());
    throw Error(words[0].where,
                "this line has " + count + (words.size() == 1 ? " number: " : " numbers: ") + kWhatIsASurface);
  }
  Row row;
  for (size_t i = 0; i < 4; ++i) row.where[i] = words[i].where;
  LensSurface& surface = row.surface;
  surface.curvatureRadius = NumberOf(words[0], "a radius of curvature");
  if (std::abs(surface.curvatureRadius) > kLargest)
    throw Error(row.where[0], "the radius of curvature is " + Shown(surface.curvatureRadius) +
                                  " mm: it has to be at most 1e9 (which is flat), or 0 for the aperture stop");
  surface.thickness = NumberOf(words[1], "a thickness");
  if (!(surface.thickness >= 0 && surface.thickness <= kLargest))
    throw Error(row.where[1],
                "the thickness is " + Shown(surface.thickness) + " mm: it has to be from 0 to 1e9, towards the film");
  surface.index = NumberOf(words[2], "an index of refraction");
  if (surface.index == 0) surface.index = 1;
  if (!(surface.index >= 1 && surface.index <= kLargestIndex))
    throw Error(row.where[2], "the index of refraction is " + Shown(surface.index) +
                                  ": it has to be from 1 (air) to 10, or 0, which stands for 1");
  const double diameter = NumberOf(words[3], "a diameter of an aperture");
  if (!(diameter > 0 && diameter <= kLargest))
    throw Error(row.where[3],
                "the diameter of the aperture is " + Shown(diameter) + " mm: it has to be above 0 and at most 1e9");
  surface.apertureRadius = 0.5 * diameter;
  if (!surface.IsStop() && surface.apertureRadius > std::abs(surface.curvatureRadius))
    throw Error(row.where[3], "an aperture of " + Shown(diameter) + " mm does not fit a sphere with a radius of " +
                                  Shown(std::abs(surface.curvatureRadius)) + " mm: it has to be at most " +
                                  Shown(2 * std::abs(surface.curvatureRadius)) + " mm");
  return row;
}

// The distance between two spheres is monotonic in the height, so that it is smallest on the axis or at the rim of the
// smaller aperture.
void CheckOverlap(const Row& front, const Row& rear) {
  const double height = std::min(front.surface.apertureRadius, rear.surface.apertureRadius);
  const double gap = front.surface.thickness + Sag(rear.surface, height) - Sag(front.surface, height);
  if (gap >= -kFlush) return;
  throw Error(front.where[1], "the surface overlaps the next one (line " + std::to_string(rear.where[0].line) +
                                  "): " + Shown(height) + " mm from the axis they are " + Shown(-gap) +
                                  " mm inside one another. The thickness would have to be at least " +
                                  Shown(std::ceil(1e3 * (front.surface.thickness - gap)) / 1e3) +
                                  " mm, or the apertures smaller");
}

void CheckStops(const std::vector<Row>& rows, const FileLocation& end) {
  const Row* stop = nullptr;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].surface.IsStop()) continue;
    if (stop)
      throw Error(rows[i].where[0], "a second aperture stop (a radius of curvature of 0); the first is in line " +
                                        std::to_string(stop->where[0].line) +
                                        ". A flat surface of glass has a large radius, such as 1e6");
    stop = &rows[i];
    const double before = i > 0 ? rows[i - 1].surface.index : 1;
    if (rows[i].surface.index != before)
      throw Error(rows[i].where[2],
                  "the aperture stop refracts nothing: its index of refraction has to be that of "
                  "what is before it, " +
                      Shown(before));
  }
  if (!stop) throw Error(end, "the lens has no aperture stop: a line with a radius of curvature of 0");
}

}  // namespace

const LensSurface& LensPrescription::Stop() const {
  return *std::find_if(surfaces.begin(), surfaces.end(), [](const LensSurface& s) { return s.IsStop(); });
}

double Sag(const LensSurface& surface, double height) {
  if (surface.IsStop()) return 0;
  const double r = surface.curvatureRadius;
  const double root = std::sqrt(std::max(r * r - height * height, 0.0));
  return std::copysign(height * height / (std::abs(r) + root), r);
}

LensPrescription ParseLensFile(const std::string& text, const std::string& name) {
  Lines lines(text, name);
  std::vector<Row> rows;
  for (std::vector<Word> words; lines.Next(words);) {
    if (words.empty()) continue;
    if (rows.size() == kMostLensSurfaces)
      throw Error(words[0].where, "the lens has more than " + std::to_string(kMostLensSurfaces) + " surfaces");
    rows.push_back(RowOf(words));
  }
  if (rows.empty()) throw Error(lines.Here(), std::string("the file has no numbers: ") + kWhatIsASurface);
  CheckStops(rows, lines.Here());
  for (size_t i = 0; i + 1 < rows.size(); ++i) CheckOverlap(rows[i], rows[i + 1]);
  if (rows.back().surface.index != 1)
    throw Error(rows.back().where[2],
                "the film is in glass: the index of refraction behind the last surface has to be 1");
  LensPrescription lens;
  for (const Row& row : rows) lens.surfaces.push_back(row.surface);
  return lens;
}

LensPrescription ReadLensFile(const std::string& file, const FileLocation& where) {
  return ParseLensFile(ReadTextFile(file, where), file);
}

}  // namespace lampyr
