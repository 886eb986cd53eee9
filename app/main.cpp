#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "app/command_line.h"
#include "base/parallel.h"

namespace {

// Terminate handler, for exceptions that no caller can catch: thrown in a thread of a library, in a function that must
// not throw, or by a library that cannot clean up after an error. Embree ends this way if it gets no threads.
[[noreturn]] void EndWithMessage() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
    if (std::uncaught_exceptions() > 0) {
      std::fprintf(stderr,
                   "error: a library gave up, most likely for want of memory or of threads (ulimit -v, ulimit -u)\n");
      std::_Exit(lampyr::kExitFailed);
    }
  } catch (const std::bad_alloc&) {
    lampyr::ReportMemoryFailure();
    std::_Exit(lampyr::kExitFailed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  } catch (...) {}
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(EndWithMessage);
  lampyr::FlushDenormalsToZero();  // before the first worker thread exists
  const int exitCode = lampyr::RunCommandLine(argc, argv);
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return exitCode;
  std::fprintf(stderr, "error: cannot write the output: %s\n", std::strerror(errno));
  return lampyr::kExitFailed;
}
