// A process of a program, to be killed.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

namespace legible {

// The program, its output thrown away.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments) : id_(fork()) {
    if (id_ != 0) return;
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }

  // Whether it was killed; false: it had ended by itself, with `exit_code`.
  bool KillAfter(double time_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
    return Kill();
  }
  bool Kill() {
    if (!has_ended_) kill(id_, SIGKILL);
    Wait();
    return exit_code_ < 0;
  }
  int Wait() {
    if (!has_ended_) End(0);
    return exit_code_;
  }
  bool IsRunning() {
    if (!has_ended_) End(WNOHANG);
    return !has_ended_;
  }
  int exit_code() const { return exit_code_; }

 private:
  void End(int wait_options) {
    int status = 0;
    if (waitpid(id_, &status, wait_options) != id_) return;
    has_ended_ = true;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  pid_t id_;
  bool has_ended_ = false;
  int exit_code_ = 0;
};

}  // namespace legible
