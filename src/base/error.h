// Errors and warnings that name the place in the user's file they are about.
//
// A bad scene throws Error; what is tolerable goes to a Diagnostics object that the caller owns
// (nothing here is global). Both print as `file:line:col: error: what, and what would be right`.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lampyr {

// A place in a text file. Lines and columns count from 1; line 0 means "no particular place in the file".
struct FileLocation {
  std::shared_ptr<const std::string> file;  // null: no file at all
  int line = 0;
  int column = 0;

  // "file:12:3", "file", or "" when nothing is known.
  std::string ToString() const;
};

// A scene, a file or a setting that cannot be used. What() is complete: "file:line:col: error: text".
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& text);
  Error(const FileLocation& where, const std::string& text);

  const FileLocation& Where() const { return where_; }
  const std::string& Text() const { return text_; }  // without the place

 private:
  FileLocation where_;
  std::string text_;
};

// Wrong usage of the command line: like Error, but about no file.
class UsageError : public Error {
 public:
  using Error::Error;
};

// What `work` gives. An Error that names no place becomes one at `where`: for what is checked by code that knows
// nothing of files.
template <class Work>
auto LocateErrors(const FileLocation& where, const Work& work) {
  try {
    return work();
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    if (error.Where().file) throw;
    throw Error(where, error.Text());
  }
}

// Collects warnings. Each distinct (place, text) is reported once. Print: of warnings that differ in their numbers and
// quoted names alone, the first few texts are printed, and the rest is counted when the object goes. Thread-safe.
class Diagnostics {
 public:
  enum class Mode { Print, Collect, Strict };  // Strict: the first warning is thrown as an Error
  explicit Diagnostics(Mode mode = Mode::Print) : mode_(mode) {}
  ~Diagnostics();
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  void Warn(const FileLocation& where, const std::string& text);
  void Warn(const std::string& text) { Warn({}, text); }

  // All warnings so far, formatted, in the order they came. Not of Print, which keeps none.
  std::vector<std::string> Warnings() const;

 private:
  struct Kind {
    std::set<std::string> printed;  // texts
    size_t further = 0;             // warnings that were not printed
  };
  void Print(const FileLocation& where, const std::string& text);

  Mode mode_;
  mutable std::mutex mutex_;
  std::set<std::string> seen_;
  std::vector<std::string> warnings_;
  // Of Print: of messages that may be millions, the hashes alone.
  std::set<size_t> seenHashes_;
  std::map<std::string, Kind> kinds_;
};

// The entry of `known` that a person most likely meant by `given`, or "" when none is near
// (edit distance, transpositions counted as one, at most a third of the word's length and 1 at least).
std::string NearestName(std::string_view given, const std::vector<std::string>& known);

// " (did you mean \"sphere\"?)", or "" when no name is near. To be appended to a message.
std::string DidYouMean(std::string_view given, const std::vector<std::string>& known);

}  // namespace lampyr
