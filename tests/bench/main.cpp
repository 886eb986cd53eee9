#include <benchmark/benchmark.h>

#include "base/parallel.h"

int main(int argc, char** argv) {
  lampyr::FlushDenormalsToZero();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
