// Checks of lights that are their own surface.
#pragma once

#include "suite/surface_tracer.h"

namespace lampyr::suite {

void CheckSurfaceReceivers(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer,
                           Rng& rng, SuiteReport& report);
void CheckSurfaceEmission(const SuiteSubject& subject, const SuiteOptions& options, const SurfaceTracer& tracer,
                          Rng& rng, SuiteReport& report);

}  // namespace lampyr::suite
