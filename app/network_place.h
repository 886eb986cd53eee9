// A network address, as given in options.
#pragma once

#include <string>

namespace lampyr {

struct NetworkPlace {
  std::string host, port;
};

// Parses "HOST:PORT" or "[IPv6]:PORT". Throws a UsageError that names the option.
NetworkPlace ParseNetworkPlace(const std::string& option, const std::string& text);

}  // namespace lampyr
