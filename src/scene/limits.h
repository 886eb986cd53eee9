// Limits of the demands of a scene file. No scene intended for rendering comes near them: they protect the machine from
// broken or hostile files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lampyr::limits {

inline constexpr size_t kOpenFiles = 256;              // nested
inline constexpr size_t kNamedFiles = 50'000;          // executed Include and Import statements
inline constexpr uint64_t kRepeatedText = 1ull << 30;  // bytes of files that are included again
inline constexpr size_t kOpenScopes = 50'000;          // nested AttributeBegin and ObjectBegin
inline constexpr size_t kParameters = 1000;            // per statement
// For one target of Attribute, because each statement that follows holds a copy.
inline constexpr size_t kDefaultParameters = 64, kDefaultValues = 1000;
inline constexpr size_t kNestedNames = 256;        // nested textures, materials, light filters or motions
inline constexpr size_t kEvaluations = 2000;       // of nested textures or filters, per evaluation of the outermost
inline constexpr size_t kSuggestedNames = 1000;    // more names than this are not searched for suggestions
inline constexpr size_t kLinks = size_t{1} << 27;  // entries of the light-linking tables
// Compressed text that grows by more than the factor kLargestGrowth, and beyond kAlwaysFineText bytes, is rejected.
inline constexpr size_t kLargestGrowth = 200;
inline constexpr size_t kAlwaysFineText = size_t{64} << 20;

}  // namespace lampyr::limits
