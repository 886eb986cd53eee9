// The plugin itself: what it brings. This is all that makes a shared library a plugin.
#include "lights/plugin/plugin_api.h"

lampyr::LightType RingLightType();
lampyr::FilterType IrisFilterType();

LAMPYR_PLUGIN({.lights = {RingLightType()}, .filters = {IrisFilterType()}})
