#include "process/process_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>

namespace calot {
namespace {

using Answers = std::map<int, std::string>;

/// Answers by task; of one that failed its kind's exit code and message.
Answers answers(int count, int processes, const std::function<std::string(int)>& work) {
  Answers found;
  PoolOptions options;
  options.processes = processes;
  const Result<int> done = work_in_processes(count, options, work, [&](int task, Result<std::string> answer) {
    EXPECT_TRUE(found.emplace(task, answer ? answer.value() : to_text(answer.failure())).second) << task;
  });
  EXPECT_TRUE(done);
  EXPECT_EQ(done.value(), count);
  return found;
}

TEST(ProcessPool, AnswersEveryTaskOnceWhateverTheNumberOfProcesses) {
  // Longer than a socket's buffer at once.
  const auto work = [](int k) {
    return std::to_string(k) + std::string(static_cast<std::size_t>(k) * 100'000, 'x');
  };
  const Answers one = answers(12, 1, work);
  ASSERT_EQ(one.size(), 12u);
  EXPECT_EQ(one.at(7), work(7));
  EXPECT_EQ(answers(12, 3, work), one);
  EXPECT_EQ(answers(0, 2, work), Answers());
}

TEST(ProcessPool, WhatDiesCostsItsOwnTaskAlone) {
  const auto work = [](int k) -> std::string {
    if (k == 1) _exit(7);
    if (k == 3) raise(SIGKILL);
    if (k == 5) throw std::runtime_error("");
    return "fine";
  };
  for (const int processes : {1, 2}) {
    const Answers found = answers(7, processes, work);
    for (const int k : {0, 2, 4, 6}) EXPECT_EQ(found.at(k), "fine") << k;
    EXPECT_EQ(found.at(1),
              "the process at work on it ended with exit code 7 (what it printed above says why)");
    EXPECT_NE(found.at(3).find("ended by signal 9"), std::string::npos) << found.at(3);
    EXPECT_EQ(found.at(5), "the process at work on it ended with exit code 3");
  }
}

TEST(ProcessPool, StoppedItLeavesTheRestUndoneAndNoProcessBehind) {
  std::atomic<bool> stop{false};
  PoolOptions options{2, &stop};
  std::vector<pid_t> children;
  const Result<int> done = work_in_processes(
      100, options, [](int) { return std::to_string(getpid()); },
      [&](int, Result<std::string> answer) {
        children.push_back(std::stoi(answer.value()));
        stop = true;
      });
  ASSERT_TRUE(done);
  EXPECT_LT(done.value(), 3);
  for (const pid_t child : children) EXPECT_NE(kill(child, 0), 0) << child << " still runs";
}

}  // namespace
}  // namespace calot
