// The binary as a user runs it, to its end or in the background.
#pragma once

#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace lampyr::test {

struct Outcome {
  int exitCode = -1;   // 128 and the signal's number where one has ended it
  std::string output;  // standard output and error together
};

// Runs lampyr in the folder. `before`: shell commands, such as limits, that it is to be run under.
inline Outcome RunLampyr(const std::filesystem::path& folder, const std::string& arguments,
                         const std::string& before = "") {
  Outcome outcome;
  const std::string command =
      "cd '" + folder.string() + "' && " + before + " '" LAMPYR_BINARY "' " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.output.append(buffer, n);
  const int status = pclose(pipe);
  outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

// One that runs meanwhile, quietly. Ended with its owner.
class LampyrProcess {
 public:
  // `arguments` are separated by spaces.
  LampyrProcess(const std::filesystem::path& folder, const std::string& arguments) {
    std::vector<std::string> words = {LAMPYR_BINARY};
    std::istringstream stream(arguments);
    for (std::string word; stream >> word;) words.push_back(word);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    process_ = fork();
    if (process_ == 0) {
      // The process that runs the tests may have been started with these signals ignored.
      for (const int ignored : {SIGINT, SIGHUP, SIGTERM}) signal(ignored, SIG_DFL);
      if (chdir(folder.c_str()) == 0) execv(LAMPYR_BINARY, pointers.data());
      _exit(99);
    }
  }
  ~LampyrProcess() {
    if (!hasEnded_) Kill(SIGKILL);
  }
  LampyrProcess(const LampyrProcess&) = delete;
  LampyrProcess& operator=(const LampyrProcess&) = delete;

  pid_t Id() const { return process_; }
  bool HasEnded() {
    if (!hasEnded_) hasEnded_ = waitpid(process_, &status_, WNOHANG) == process_;
    return hasEnded_;
  }
  // Sends the signal and waits for the end. The exit code, as of Outcome.
  int Kill(int signal) {
    if (!hasEnded_) kill(process_, signal);
    return Wait();
  }
  int Wait() {
    if (!hasEnded_) waitpid(process_, &status_, 0);
    hasEnded_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  pid_t process_ = -1;
  int status_ = 0;
  bool hasEnded_ = false;
};

}  // namespace lampyr::test
