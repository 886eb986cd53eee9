// Signals, and the exit of a process that has given up work: common to the commands that render.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace lampyr {

// A reader of the messages who has gone away is no reason to end, and a file that may not grow is an error of writing.
void OutliveSurroundings();
// From now on SIGINT, SIGTERM (batch systems ask with it) and SIGHUP (a connection is lost) set the flag that is
// returned, once: a second SIGINT or SIGTERM ends the process. Until then, each of them ends it. A signal that the
// process was started to ignore (nohup) stays ignored.
const std::atomic<bool>& FinishOnInterrupt();
// Runs `finish`, what is left to do after rendering, and returns its exit code. Where work was given up (base/stop.h),
// ends the process with that code: threads still use what the caller is about to destroy.
int FinishRendering(const std::function<int()>& finish);
// Exit code of a command that was interrupted: 128 and the number of the signal.
int InterruptExitCode();

std::string Joined(const std::vector<std::string>& names, const char* separator);

}  // namespace lampyr
