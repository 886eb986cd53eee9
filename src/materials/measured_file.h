// Reader of measured materials: the tensor files of the RGL material database ([Dupuy18]), with spectra or with RGB.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "materials/measured.h"

namespace lampyr {

// Throws an Error at `where` that names the file if it cannot be read, has another format, or has tables that are
// inconsistent, negative or not finite.
MeasuredData ReadMeasured(const std::filesystem::path& file, const FileLocation& where);
// Parses the bytes of a file. Throws the same Errors, without a location.
MeasuredData ParseMeasured(std::span<const std::byte> bytes);

}  // namespace lampyr
