// Light path expressions: regular expressions over the events of a light path, starting at the camera. The notation is
// that of [Heckbert90], the grammar that of OSL and RenderMan.
//
//   C                      the camera: each expression starts with it
//   R T                    reflection, transmission      D G S   diffuse, glossy, specular (perfectly smooth)
//   <RD> <T.> <.S>         both at once; . is any        V       a participating medium scatters
//   L O                    light of a lamp, of a glowing medium: each path ends with one
//   <L.'key'>              of the light, or the lights of the group, of that name
//   .                      anything      [DG] one of them      [^D] anything but      ( ) |  * + ?  {2} {1,} {1,3}
//
// C<RD>[LO] is light that is reflected once, diffusely. Surfaces that are crossed straight on, such as cut-outs and the
// boundaries of media, are no events.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lampyr {

// The event at a vertex of a path.
enum class PathEvent : uint8_t {
  DiffuseReflection,
  GlossyReflection,
  SpecularReflection,
  DiffuseTransmission,
  GlossyTransmission,
  SpecularTransmission,
  Volume
};
inline constexpr size_t kPathEvents = 7;

// The properties of a light source that expressions can name.
struct LightSourceName {
  std::string name, group;
  bool isMedium = false;  // a participating medium that glows
};

// A set of sources.
struct LightSources {
  enum class Kind { AnyLight, Media, Named, InGroup, InNoGroup };  // Named: the light or its group
  struct Term {
    Kind kind = Kind::AnyLight;
    std::string name;
  };
  std::vector<Term> terms;  // in any of these
  bool isNegated = false;   // in none of these

  bool Has(const LightSourceName& source) const;
};

// An expression as the positions of its symbols, without empty transitions ([Glushkov61]).
class PathExpression {
 public:
  // A symbol: what it matches, and the positions that may come next.
  struct Position {
    uint8_t events = 0;  // bits, by PathEvent
    LightSources sources;
    std::vector<uint32_t> next;
  };

  // Throws an Error that names the character of a mistake.
  explicit PathExpression(const std::string& text);
  // All paths from these sources.
  explicit PathExpression(LightSources sources);

  const std::vector<Position>& Positions() const { return positions_; }
  // Positions after the camera, and those at which a path may end.
  const std::vector<uint32_t>& First() const { return first_; }
  const std::vector<uint32_t>& Last() const { return last_; }

  // The names of lights in it, each once.
  std::vector<std::string> NamedLights() const;
  // The same expression restricted to paths from the named light or group.
  PathExpression OnlyFrom(const std::string& light) const;

 private:
  friend class ExpressionParser;
  PathExpression() = default;

  std::vector<Position> positions_;
  std::vector<uint32_t> first_, last_;
};

// A name without capitals, spaces, '-' and '_', by which known layers are found.
std::string PlainName(const std::string& name);

// Expressions that have a name: beauty, caustic, emission, and so on. Spaces, '-' and '_' in names are the same.
struct NamedExpression {
  const char* name;
  const char* text;
};
const std::vector<NamedExpression>& NamedExpressions();
// The expression of that name; null: there is none.
const NamedExpression* FindNamedExpression(const std::string& name);

}  // namespace lampyr
