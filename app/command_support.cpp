#include "app/command_support.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "app/command_line.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/stop.h"

namespace lampyr {

namespace {

// Global because a signal handler takes no further arguments.
std::atomic<bool> interruptRequested{false};
std::atomic<int> interruptSignal{SIGINT};

constexpr int kInterrupts[] = {SIGINT, SIGTERM, SIGHUP};

// A second signal ends the process, except SIGHUP: the system and the shell both send one when a connection is lost.
void OnInterrupt(int signal) {
  interruptSignal.store(signal);
  interruptRequested.store(true);
  for (const int other : kInterrupts) std::signal(other, other == SIGHUP ? SIG_IGN : SIG_DFL);
}

bool IsIgnored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void ReportMemoryFailure() {
  constexpr double bytesPerMebibyte = 1 << 20;
  std::fprintf(stderr,
               "error: there is not enough memory: all of the %.0f MiB that lampyr may use are taken; give it more "
               "(ulimit -v, the container, the batch job), or render in parts with --crop\n",
               static_cast<double>(AvailableMemory()) / bytesPerMebibyte);
}

void OutliveSurroundings() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& FinishOnInterrupt() {
  if (interruptRequested.load()) return interruptRequested;  // the next signal ends the process
  for (const int signal : kInterrupts) {
    if (!IsIgnored(signal)) std::signal(signal, OnInterrupt);
  }
  return interruptRequested;
}

int FinishRendering(const std::function<int()>& finish) {
  if (!HasGivenUpWork()) return finish();
  int exitCode = kExitFailed;
  try {
    exitCode = finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  std::fflush(stdout);
  std::_Exit(exitCode);
}

int InterruptExitCode() {
  return kExitSignalled + interruptSignal.load();
}

void Outputs::Write(const std::function<void()>& write) {
  const auto keep = [this](const char* message) {
    if (first_) std::fprintf(stderr, "%s\n", message);
    if (!first_) first_ = std::current_exception();
  };
  try {
    write();
  } catch (const Error& error) {
    keep(error.what());
  } catch (const std::exception& error) {  // of a library or the system
    keep((std::string("error: ") + error.what()).c_str());
  }
}

void Outputs::ThrowFailure() const {
  if (first_) std::rethrow_exception(first_);
}

std::string Joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

}  // namespace lampyr
