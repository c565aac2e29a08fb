// Runs the program as a user does, each test in a folder of its own.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "shared_data.h"

namespace limber {

namespace fs = std::filesystem;

struct Result {
  int code = -1;  // exit code, or 128 + signal
  std::string out, error;
};

// A running limber with all three streams on pipes or files.
class Running {
 public:
  Running(const std::vector<std::string>& arguments, const fs::path& folder, const fs::path& output = "stdout")
      : folder_(folder) {
    int input[2];
    EXPECT_EQ(pipe2(input, O_CLOEXEC), 0);
    input_ = input[1];
    pid_ = fork();
    if (pid_ == 0) {
      redirect(input[0], 0);
      redirect(open((folder / output).c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), 1);
      redirect(open((folder / "stderr").c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), 2);
      if (chdir(folder.c_str()) != 0) _exit(126);
      std::vector<char*> argv = {const_cast<char*>(LIMBER_PROGRAM)};
      for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
      argv.push_back(nullptr);
      execv(LIMBER_PROGRAM, argv.data());
      _exit(127);
    }
    close(input[0]);
  }
  ~Running() {
    if (input_ >= 0) close(input_);
  }

  void feed(const std::string& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t wrote = write(input_, bytes.data() + done, bytes.size() - done);
      if (wrote <= 0) break;
      done += static_cast<std::size_t>(wrote);
    }
  }
  // Once the program catches it, which takes a while on a busy machine: before, it would end without a word.
  void signal(int number) {
    ASSERT_GT(pid_, 0);  // -1 would be everybody
    for (int look = 0; look < 3000 && number != SIGKILL && !catches(number); ++look) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    kill(pid_, number);
  }

  Result wait() {
    close(input_);
    return waitWithOpenInput();
  }
  Result waitWithOpenInput() {
    int status = 0;
    waitpid(pid_, &status, 0);
    Result result;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = slurp("stdout");
    result.error = slurp("stderr");
    return result;
  }

 private:
  static void redirect(int from, int to) { dup2(from, to); }
  bool catches(int number) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("SigCgt:")) return std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1;
    }
    return true;  // it has ended
  }
  std::string slurp(const char* name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
  pid_t pid_ = -1;
  int input_ = -1;
};

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    ::signal(SIGPIPE, SIG_IGN);
    std::string pattern = (fs::temp_directory_path() / "limber_cli_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  Result run(const std::vector<std::string>& arguments, const std::string& input = {}) {
    Running running(arguments, folder_);
    running.feed(input);
    return running.wait();
  }
  std::string content(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void put(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  // Everything in the folder but the captured streams.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name != "stdout" && name != "stderr") names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  void makeRobot() { ASSERT_EQ(run({"sample", "robot", "-o", "robot.glb", "--quiet"}).code, 0); }
  // For the validator, which looks at every glTF file that a test leaves.
  void keep(const std::string& name) const {
    fs::copy_file(folder_ / name, testing::testOutputFolder() / ("cli_" + name), fs::copy_options::overwrite_existing);
  }

  fs::path folder_;
};

// One line, from limber, and no crash.
inline void expectOneLine(const Result& result, int code) {
  EXPECT_EQ(result.code, code);
  EXPECT_THAT(result.error, ::testing::StartsWith("limber: "));
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_EQ(result.out, "");
}

}  // namespace limber
