// Reads the parameters of a statement: "type name" value, or "type name" [ values … ]. Internal to scene/.
#pragma once

#include <vector>

#include "scene/parameters.h"
#include "scene/token_stream.h"

namespace lampyr {

// All parameters up to the next token that is no string. rgb values are taken to be in `colorSpace`.
// Throws located Errors: unknown types, values of another type, lists without an end, the same name twice.
std::vector<Parameter> ReadParameters(TokenStream& tokens, RgbColorSpace colorSpace);

}  // namespace lampyr
