#include "support/program.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {

bool HasProgram(const std::string& name) {
  return std::filesystem::exists(ProgramFolder() / name);
}

ProgramResult RunProgram(const std::string& name,
                         const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string command = (ProgramFolder() / name).string() + " " +
                              arguments + " >" + (folder / "out") + " 2>" +
                              (folder / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.Read("out"),
          folder.Read("err")};
}

}  // namespace splitfusion
