// Errors and warnings, with the location in the user's file at which they occurred.
//
// An invalid scene throws an Error. Tolerable defects go to a Diagnostics object that the caller owns (nothing here is
// global). Both print as `file:line:col: error: what is wrong, and what would be right`.
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

// A place in a text file. Lines and columns count from 1; line 0 means the file as a whole.
struct FileLocation {
  std::shared_ptr<const std::string> file;  // null: no file at all
  int line = 0;
  int column = 0;

  // "file:12:3"; "file" without a line; "" without a file.
  std::string ToString() const;
};

// The error of an invalid scene, file or setting. what() is the complete message: "file:line:col: error: text".
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& text);
  Error(const FileLocation& where, const std::string& text);

  const FileLocation& Where() const { return where_; }
  const std::string& Text() const { return text_; }  // without the location

 private:
  FileLocation where_;
  std::string text_;
};

// Wrong usage of the command line; has no file.
class UsageError : public Error {
 public:
  using Error::Error;
};

// Returns work(). An Error without a location is rethrown with the location `where`, for checks in code that does not
// depend on files. A UsageError passes unchanged.
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

// Receives warnings and reports each distinct pair of location and text once. In Print mode, warnings that differ only
// in numbers and quoted names form a kind: the first three texts of a kind are printed, the others are counted, and the
// destructor prints the count. Thread-safe.
class Diagnostics {
 public:
  enum class Mode { Print, Collect, Strict };  // Strict: the first warning is thrown as an Error
  explicit Diagnostics(Mode mode = Mode::Print) : mode_(mode) {}
  ~Diagnostics();
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  void Warn(const FileLocation& where, const std::string& text);
  void Warn(const std::string& text) { Warn({}, text); }

  // All warnings so far, formatted, in the order of arrival. Empty in Print mode, which keeps none.
  std::vector<std::string> Warnings() const;

 private:
  struct Kind {
    std::set<std::string> printed;  // texts
    size_t further = 0;             // count of warnings not printed
  };
  void Print(const FileLocation& where, const std::string& text);

  Mode mode_;
  mutable std::mutex mutex_;
  std::set<std::string> seen_;
  std::vector<std::string> warnings_;
  // Print mode keeps hashes only: there may be millions of messages.
  std::set<size_t> seenHashes_;
  std::map<std::string, Kind> kinds_;
};

// The entry of `known` that is nearest to `given`, or "" if none is near. Distance: number of edits, case ignored, a
// transposition counted as one; near is at most a third of the length of `given`, and at least 1.
std::string NearestName(std::string_view given, const std::vector<std::string>& known);

// " (did you mean \"sphere\"?)", or "" if no name is near. To be appended to a message.
std::string DidYouMean(std::string_view given, const std::vector<std::string>& known);

}  // namespace lampyr
