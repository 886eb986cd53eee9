// The command line: lampyr render | merge | compare | mix | desk | denoise | diff | png | plan | lights | check-lights.
#pragma once

namespace lampyr {

// Exit codes: 0 done; 1 failed while running; 2 wrong usage or a bad scene; 130 or 143 interrupted (SIGINT, SIGTERM).
inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitSignalled = 128;  // and the signal's number

int RunCommandLine(int argc, char** argv);

// Reports a lack of memory, and the remedies. Allocates nothing itself.
void ReportMemoryFailure();

}  // namespace lampyr
