// Lists the lights that the installed library knows.
#include <cstdio>

#include "lights/light_type.h"

int main() {
  for (const lampyr::LightType& type : lampyr::LightRegistry()) std::printf("%s\n", type.name.c_str());
  return lampyr::FindLightType("point", false) ? 0 : 1;
}
