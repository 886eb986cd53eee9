// Parser of LM-63 files: the header, and candela over the measured angles. Internal to scene/.
//
// A file has label lines up to the line TILT=…, then numbers in a fixed order, separated by blanks, commas and line
// ends ([LM-63-02], [LM-63-19]; older editions differ in the first line and in the meaning of one number).
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace lampyr {

enum class IesPhotometry { TypeC = 1, TypeB = 2, TypeA = 3 };

struct IesFile {
  IesPhotometry type = IesPhotometry::TypeC;
  std::vector<double> vertical, horizontal;  // degrees, ascending
  // Including all multipliers; never negative; vertical angles fastest.
  std::vector<double> candela;
  FileLocation verticalWhere, horizontalWhere;  // of the first angle
};

// The file with the tilt table of an IES file; "": there is none, or the file cannot be read.
std::string TiltFileOf(const std::string& iesFile);

// Throws located Errors.
IesFile ParseIesFile(const std::string& text, const std::string& name);

}  // namespace lampyr
