// Private to the geometry: primitives and instances as geometries of Embree, not yet committed. A failed allocation is
// reported as an error of the device.
#pragma once

#include <embree3/rtcore.h>

#include "geometry/scene_tables.h"

namespace lampyr {

// The geometry refers to the record, which has to outlive it. `visibleTo`: kinds of rays (VisibleTo). Null for a shape
// without primitives.
RTCGeometry NewGeometry(RTCDevice device, const PrimitiveRecord& record, uint32_t visibleTo);

RTCGeometry NewInstance(RTCDevice device, const InstanceRecord& instance, RTCScene object);

}  // namespace lampyr
