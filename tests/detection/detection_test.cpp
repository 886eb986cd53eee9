// The short part of the detection score, in the default suites: the faults are there, their patches still apply to the
// source, a few of them are found and their sound light is not. All of them: `tests/run detection`.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "detection/search.h"
#include "suite/suite_inputs.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

const std::filesystem::path kPatches = std::filesystem::path(LAMPYR_SOURCE_DIR) / "tests" / "detection" / "patches";

TEST(Detection, ThereAreSixtyFaultsWithNamesOfTheirOwn) {
  std::set<std::string> names;
  size_t count = 0;
  const auto note = [&](const auto& faults) {
    for (const auto& fault : faults) {
      names.insert(fault.name);
      EXPECT_FALSE(fault.what.empty()) << fault.name;
    }
    count += faults.size();
  };
  note(LightFaults());
  note(FilterFaults());
  note(PatchFaults());
  EXPECT_EQ(names.size(), count);
  EXPECT_GE(count, 60u);
  for (const LightFault& fault : LightFaults()) EXPECT_NO_THROW(FindLightSubject(fault.subject)) << fault.name;
  for (const FilterFault& fault : FilterFaults()) EXPECT_NO_THROW(FindFilterSubject(fault.subject)) << fault.name;
}

TEST(Detection, EveryPatchAppliesToTheSource) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kPatches)) files.insert(entry.path().stem().string());
  for (const PatchFault& fault : PatchFaults()) {
    EXPECT_EQ(files.erase(fault.name), 1u) << fault.name;
    const std::string command = "patch -p1 --dry-run --force --silent -d '" LAMPYR_SOURCE_DIR "' < '" +
                                (kPatches / (fault.name + ".patch")).string() + "' >&2";
    EXPECT_EQ(std::system(command.c_str()), 0) << fault.name << ": make the patch anew";
  }
  EXPECT_TRUE(files.empty()) << *files.begin() << " is in no table";
}

// One light with several faults, of which each is found by another property.
TEST(Detection, FaultsOfAPointAreFoundAndThePointIsNot) {
  const TemporaryFolder scratch;
  suite::WriteSuiteInputs(scratch.Path());
  const LightSubject& subject = FindLightSubject("point");
  EXPECT_EQ(FindBySuite(subject, nullptr, scratch.Path()).property, "");
  int found = 0;
  for (const LightFault& fault : LightFaults()) {
    if (fault.subject != subject.name) continue;
    EXPECT_TRUE(FindBySuite(subject, &fault, scratch.Path()).found) << fault.name;
    ++found;
  }
  EXPECT_GE(found, 3);
}

TEST(Detection, FaultsOfAFilterAreFoundAndTheFilterIsNot) {
  const TemporaryFolder scratch;
  const FilterSubject& subject = FindFilterSubject("intmult");
  EXPECT_EQ(FindBySuite(subject, nullptr, scratch.Path()).property, "");
  for (const FilterFault& fault : FilterFaults()) {
    if (fault.subject == subject.name) {
      EXPECT_TRUE(FindBySuite(subject, &fault, scratch.Path()).found) << fault.name;
    }
  }
}

}  // namespace
}  // namespace lampyr::test
