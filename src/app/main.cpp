#include "app/command_line.h"
#include "base/parallel.h"

int main(int argc, char** argv) {
  lampyr::FlushDenormalsToZero();  // before the first worker thread exists
  return lampyr::RunCommandLine(argc, argv);
}
