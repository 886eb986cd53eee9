// Denoising with progress and a report on stderr, for `lampyr denoise` and `lampyr render --denoise`.
#pragma once

#include <atomic>

#include "film/image.h"

namespace lampyr {

// Denoises with progress on stderr, and reports there which inputs the filter lacked and what it removed. Returns an
// image without channels if `interrupted` was set. Throws an Error if the image cannot be denoised.
Image DenoiseForUser(const Image& noisy, int threads, const std::atomic<bool>& interrupted, bool quiet);

}  // namespace lampyr
