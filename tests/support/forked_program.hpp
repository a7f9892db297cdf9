// forked_program.hpp: runs the program in a fork of the test instead of starting its file: to link the file
// to its 270 shared libraries takes 0.2 s of CPU, more than most command lines of the tests.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

int roomradar_main(int argc, char** argv);  // in the library program_main

namespace roomradar::test {

/// Starts the program with these arguments. Its stdout and stderr go to `output`, a file descriptor.
inline pid_t start_program(std::vector<std::string> arguments, int output) {
  std::fflush(nullptr);  // else both processes would write what is buffered
  const pid_t child = fork();
  if (child != 0) return child;
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  close(output);
  arguments.insert(arguments.begin(), "roomradar");
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const int status = roomradar_main(static_cast<int>(arguments.size()), words.data());
  std::fflush(nullptr);
  _exit(status);  // exit handlers are for the test's process: TBB's abort in a fork
}

/// Waits for the end of a process. Returns its exit status, or 128 + the signal that ended it.
inline int status_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace roomradar::test
