#include "app/network_place.h"

#include "base/error.h"

namespace lampyr {

NetworkPlace ParseNetworkPlace(const std::string& option, const std::string& text) {
  const size_t colon = text.rfind(':');
  NetworkPlace place;
  if (colon != std::string::npos) {
    place.host = text.substr(0, colon);
    place.port = text.substr(colon + 1);
  }
  if (place.host.size() > 2 && place.host.front() == '[' && place.host.back() == ']')
    place.host = place.host.substr(1, place.host.size() - 2);
  const bool isNumber =
      !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
  constexpr int kLargestPort = 65535;
  if (place.host.empty() || !isNumber || std::stoi(place.port) < 1 || std::stoi(place.port) > kLargestPort)
    throw UsageError(option + ": \"" + text + "\" is no host and port; write 127.0.0.1:14158");
  return place;
}

}  // namespace lampyr
