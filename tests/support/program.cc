#include "support/program.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "support/repository.h"

namespace splitfusion {
namespace {

/// The command line; what the program says goes to `out` and `err` in `folder`.
std::string Command(const std::string& name, const std::string& arguments,
                    const TemporaryFolder& folder) {
  return (ProgramFolder() / name).string() + " " + arguments + " >" +
         (folder / "out") + " 2>" + (folder / "err");
}

ProgramResult Result(int status, const TemporaryFolder& folder) {
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.Read("out"),
          folder.Read("err")};
}

}  // namespace

bool HasProgram(const std::string& name) {
  return std::filesystem::exists(ProgramFolder() / name);
}

ProgramResult RunProgram(const std::string& name, const std::string& arguments,
                         const std::string& environment) {
  const TemporaryFolder folder;
  const std::string command =
      environment + " " + Command(name, arguments, folder);
  return Result(std::system(command.c_str()), folder);
}

RunningProgram::RunningProgram(const std::string& name,
                               const std::string& arguments) {
  const std::string command = "exec " + Command(name, arguments, folder_);
  pid_ = fork();
  if (pid_ != 0) return;
  setpgid(0, 0);
  execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

RunningProgram::~RunningProgram() {
  if (!Runs()) return;
  Send(SIGKILL);
  Wait();
}

bool RunningProgram::Runs() {
  if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) != 0;
  return !ended_;
}

void RunningProgram::Send(int signal) const { kill(pid_, signal); }

ProgramResult RunningProgram::Wait() {
  if (!ended_) ended_ = waitpid(pid_, &status_, 0) == pid_;
  return Result(status_, folder_);
}

}  // namespace splitfusion
