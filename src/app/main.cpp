#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/command_line.h"
#include "base/parallel.h"

int main(int argc, char** argv) {
  lampyr::FlushDenormalsToZero();  // before the first worker thread exists
  const int exitCode = lampyr::RunCommandLine(argc, argv);
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return exitCode;
  std::fprintf(stderr, "error: cannot write the output: %s\n", std::strerror(errno));
  return lampyr::kExitFailed;
}
