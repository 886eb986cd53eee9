// Settings: what may be set of something, declared once. From a declaration come the option of the command line, the
// parameter of a scene, the check of a value, the help, the page in docs/, the JSON report, and whether a checkpoint
// with another value is one of another render.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lampyr {

// On or off, a whole number, a number, or one of a few words.
using SettingValue = std::variant<bool, int64_t, double, std::string>;

struct Setting {
  std::string name;    // as the command line has it: "shadow-roulette"
  std::string help{};  // one line, without the default
  SettingValue fallback;

  // Of numbers: the range, and how it is said if "from 0 to 1" says too little.
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  std::string range{};
  std::string unit{};                  // "scene units", "bytes" (which may be written 512M), "" for none
  std::string fallbackText{};          // what the fallback means: "from the size of pixels"; "": as it is
  std::vector<std::string> choices{};  // of words
  std::string without{};               // of switches that are on: what is there without it, for the help

  std::string sceneName{};     // as scenes have it; "": the name without hyphens
  bool isInScenes = true;      // false: the command line alone says it
  bool changesPicture = true;  // it is part of a checkpoint's identity

  std::string NameInScenes() const;
  // "from 0 to 1", "0 or more", "above 0".
  std::string Range() const;
  // "0.05", "on", "4 GiB": as people read it.
  std::string Format(const SettingValue& value) const;
  // Exactly: another text is another value.
  static std::string Exactly(const SettingValue& value);
  // As the command line gives it, in the range. Throws an Error that says what would be right.
  SettingValue Parse(const std::string& text) const;
  // Of the type of the fallback: whole numbers become numbers. Throws an Error where it cannot be, or is out of range;
  // the fallback may be outside of it.
  SettingValue Check(const SettingValue& value) const;
  // Throws an Error for a number out of range. Whole numbers have a range that fits them.
  void CheckRange(double number) const;
};

// The values of declared settings.
class Settings {
 public:
  Settings() = default;
  // All fallbacks. `declared` must outlive the values. Settings that are declared several times are one.
  explicit Settings(const std::vector<const Setting*>& declared);

  bool IsOn(const std::string& name) const { return std::get<bool>(Get(name)); }
  int64_t Integer(const std::string& name) const { return std::get<int64_t>(Get(name)); }
  double Number(const std::string& name) const { return std::get<double>(Get(name)); }
  const std::string& Word(const std::string& name) const { return std::get<std::string>(Get(name)); }
  // Throws an Error where there is no such setting.
  const SettingValue& Value(const std::string& name) const { return Get(name); }

  // Throws an Error where there is no such setting, or it cannot have the value.
  void Set(const std::string& name, const SettingValue& value);
  const Setting* Find(const std::string& name) const;
  // In the order of their declaration.
  const std::vector<std::pair<const Setting*, SettingValue>>& All() const { return values_; }
  std::vector<std::string> Names() const;

 private:
  const SettingValue& Get(const std::string& name) const;

  std::vector<std::pair<const Setting*, SettingValue>> values_;
};

// "90s", "1.5M": a number and one of the units, which stand for factors; NaN where it is not that.
double ParseWithUnit(const std::string& text, const std::vector<std::pair<std::string, double>>& units);
// "800M", "4G" -> bytes; NaN where it is no size.
double ParseBytes(const std::string& text);

}  // namespace lampyr
