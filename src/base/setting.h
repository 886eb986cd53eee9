// Settings of integrators and commands, each declared once. The command-line option, the scene parameter, the check of
// a value, the help, the page in docs/, the JSON report and the identity of a checkpoint are derived from the
// declaration.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lampyr {

// A switch, an integer, a number, or one of a list of words.
using SettingValue = std::variant<bool, int64_t, double, std::string>;

struct Setting {
  std::string name;    // on the command line: "shadow-roulette"
  std::string help{};  // one line, without the default
  SettingValue fallback;

  // Numbers: the closed range [least, most]; `range` replaces the text of Range() if "from 0 to 1" does not suffice.
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  std::string range{};
  std::string unit{};                  // "scene units", "bytes" (which may be written 512M), "" for none
  std::string fallbackText{};          // the fallback in words: "from the size of pixels"; "": its value
  std::vector<std::string> choices{};  // words: the allowed ones
  std::string without{};               // switches that are on by default: the effect of turning them off, for the help

  std::string sceneName{};  // name in scene files; "": `name` without hyphens
  bool isInScenes = true;   // false: command line only
  bool isBiased = false;    // true: any other value than the fallback biases the picture, for speed

  std::string NameInScenes() const;
  // The range in words: "from 0 to 1", "0 or more"; "" for numbers without a range.
  std::string Range() const;
  // A value for display: "0.05", "on", "4 GiB". Numbers are rounded to three digits.
  std::string Format(const SettingValue& value) const;
  // A value as text without rounding: different values have different texts.
  static std::string ToExactString(const SettingValue& value);
  // The value of a command-line argument. Throws an Error that describes valid values if the text is malformed or the
  // number is out of range.
  SettingValue Parse(const std::string& text) const;
  // `value`, converted to the type of the fallback (integers become numbers). Throws an Error if the type does not
  // match or the value is out of range; the fallback itself is accepted even if it is out of range.
  SettingValue Check(const SettingValue& value) const;
  // Throws an Error if `number` is out of range. The ranges of integer settings fit their type.
  void CheckRange(double number) const;
};

// Values of declared settings, by name.
class Settings {
 public:
  Settings() = default;
  // Every setting has its fallback. The declarations must outlive this object; a setting declared several times counts
  // once.
  explicit Settings(const std::vector<const Setting*>& declared);

  bool IsOn(const std::string& name) const { return std::get<bool>(Get(name)); }
  int64_t Integer(const std::string& name) const { return std::get<int64_t>(Get(name)); }
  double Number(const std::string& name) const { return std::get<double>(Get(name)); }
  const std::string& Word(const std::string& name) const { return std::get<std::string>(Get(name)); }
  // Throws an Error if there is no such setting.
  const SettingValue& Value(const std::string& name) const { return Get(name); }

  // Throws an Error if there is no such setting, or if it rejects the value (Setting::Check).
  void Set(const std::string& name, const SettingValue& value);
  const Setting* Find(const std::string& name) const;
  // Biased settings get their fallbacks.
  void RemoveBias();
  // In the order of declaration.
  const std::vector<std::pair<const Setting*, SettingValue>>& All() const { return values_; }
  std::vector<std::string> Names() const;

 private:
  const SettingValue& Get(const std::string& name) const;

  std::vector<std::pair<const Setting*, SettingValue>> values_;
};

// "90s", "1.5M": a number followed by one of `units` (name, factor), times the factor; NaN for any other text.
double ParseWithUnit(const std::string& text, const std::vector<std::pair<std::string, double>>& units);
// "800M", "4G" -> bytes; NaN for any other text.
double ParseBytes(const std::string& text);

}  // namespace lampyr
