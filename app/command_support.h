// Signal handling, and the end of an interrupted process, for the commands that render.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace lampyr {

// Ignores SIGPIPE and SIGXFSZ: a closed pipe does not end a render, and a file size limit is an error of writing.
void OutliveSurroundings();
// Installs handlers: the first SIGINT, SIGTERM (sent by batch systems) or SIGHUP (connection lost) sets the returned
// flag, a second SIGINT or SIGTERM ends the process. Signals ignored at start (nohup) stay ignored.
const std::atomic<bool>& FinishOnInterrupt();
// Runs `finish`, the work after rendering, and returns its exit code. If passes were abandoned (base/stop.h), ends the
// process with that code, because threads still use objects that the caller would destroy.
int FinishRendering(const std::function<int()>& finish);
// Exit code of an interrupted command: 128 plus the signal's number.
int InterruptExitCode();

// Writes outputs of which each is written even if another one fails.
class Outputs {
 public:
  void Write(const std::function<void()>& write);
  bool HasFailed() const { return first_ != nullptr; }
  // Throws the first failure; the others have been reported on stderr.
  void ThrowFailure() const;

 private:
  std::exception_ptr first_;
};

std::string Joined(const std::vector<std::string>& names, const char* separator);

}  // namespace lampyr
