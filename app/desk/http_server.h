// A server for one page on this machine. It refuses requests without its token: from a page of another site, another
// user, or another machine.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace lampyr {

struct HttpRequest {
  std::string method;  // "GET", "POST"
  std::string path;    // behind the token: "" for the page itself
  std::string body;
};

struct HttpReply {
  int status = 200;
  std::string type = "text/plain";
  std::string body;
  std::string header;  // value of X-Lampyr; "": absent
};

class HttpServer {
 public:
  // `answer` may be called by several threads. `port`: 0 takes any. Throws an Error if the port is taken.
  HttpServer(int port, std::function<HttpReply(const HttpRequest&)> answer);
  ~HttpServer();  // stops

  // "http://127.0.0.1:PORT/TOKEN/". The token has 128 bits of the system's random numbers.
  std::string Address() const;
  // Answers requests until Stop. On 127.0.0.1 only. A request for a path without the token is answered with 404; one
  // with the header Host of another place, or with the Origin of another page, with 403.
  void Serve();
  // May be called by any thread. Without effect before Serve.
  void Stop();

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace lampyr
