// Every input of the fuzz targets' corpus, through the functions that the fuzzer calls. Each has an answer or an Error;
// what was a crash once is among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "fuzz/targets.h"
#include "support/temporary_folder.h"

namespace lampyr {

namespace fuzz {
void PrintTo(const Target& target, std::ostream* out) {
  *out << target.name;
}
}  // namespace fuzz

namespace {

class Corpus : public testing::TestWithParam<fuzz::Target> {};

std::vector<std::filesystem::path> InputsOf(const char* target) {
  std::vector<std::filesystem::path> inputs;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(LAMPYR_FUZZ_CORPUS) / target)) {
    inputs.push_back(entry.path());
  }
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

TEST_P(Corpus, IsReadOrRefused) {
  const fuzz::Target& target = GetParam();
  int answered = 0, refused = 0;
  for (const std::filesystem::path& input : InputsOf(target.name)) {
    SCOPED_TRACE(input.filename().string());
    try {
      (target.run(ReadBytes(input)) ? answered : refused) += 1;
    } catch (const std::exception& e) {
      ADD_FAILURE() << input << ": " << e.what();
    }
  }
  std::printf("[   info   ] %s: %d inputs, %d read, %d refused\n", target.name, answered + refused, answered, refused);
  // A target that refuses all, or nothing, tests little.
  EXPECT_GT(answered, 10);
  EXPECT_GT(refused, 10);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(fuzz::kTargets),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lampyr
