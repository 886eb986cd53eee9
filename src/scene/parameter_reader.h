// Reader for the parameters of a statement: "type name" value, or "type name" [ values … ]. Internal to scene/.
#pragma once

#include <vector>

#include "base/error.h"
#include "scene/parameters.h"
#include "scene/token_stream.h"

namespace lampyr {

// Reads parameters up to the next token that is not a string. rgb values are interpreted in `colorSpace`. If a
// parameter is given twice, the last one counts, with a warning. Throws located Errors for unknown types, values of the
// wrong type, unterminated lists, and a name with two types.
std::vector<Parameter> ReadParameters(TokenStream& tokens, RgbColorSpace colorSpace, Diagnostics& diagnostics);

}  // namespace lampyr
