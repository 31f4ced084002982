#include "base/workers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>

namespace calot {
namespace {

TEST(Chunks, CutALoopIntoPartsThatFollowEachOther) {
  for (int items : {0, 1, 7, 16, 1000000000})
    for (int chunks : {1, 3, 16}) {
      int at = 0;
      for (int k = 0; k < chunks; ++k) {
        const Chunk chunk = chunk_of(items, chunks, k);
        EXPECT_EQ(chunk.begin, at);
        EXPECT_GE(chunk.end - chunk.begin, items / chunks);
        EXPECT_LE(chunk.end - chunk.begin, items / chunks + 1);
        at = chunk.end;
      }
      EXPECT_EQ(at, items);
    }
}

class WorkersOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, WorkersOf, ::testing::Values(1, 2, 5));

TEST_P(WorkersOf, DoEachChunkOnceAndWhatTheyWroteIsSeen) {
  Workers workers(GetParam());
  EXPECT_EQ(workers.threads(), GetParam());
  std::vector<int> done;
  for (int chunks : {0, 1, 2, 7, 1000}) {
    done.assign(static_cast<std::size_t>(chunks), 0);
    workers.for_each(chunks, [&](int k) noexcept { ++done[k]; });
    EXPECT_EQ(done, std::vector<int>(done.size(), 1)) << chunks;
  }
}

TEST_P(WorkersOf, DoManyShortLoopsInARow) {
  Workers workers(GetParam());
  constexpr int chunks = 4, loops = 20000;
  std::vector<int> sums(chunks, 0);
  for (int loop = 0; loop < loops; ++loop)
    workers.for_each(chunks, [&sums, loop](int k) noexcept { sums[k] += loop % 7 + k; });
  std::vector<int> expected(chunks, 0);
  for (int loop = 0; loop < loops; ++loop)
    for (int k = 0; k < chunks; ++k) expected[k] += loop % 7 + k;
  EXPECT_EQ(sums, expected);
}

TEST_P(WorkersOf, GiveTheSameBits) {
  const auto sum = [](Workers* workers) {
    constexpr int chunks = 16, items = 10007;
    std::vector<double> parts(chunks);
    for_each_chunk(workers, chunks, [&](int k) noexcept {
      const Chunk chunk = chunk_of(items, chunks, k);
      for (int i = chunk.begin; i < chunk.end; ++i) parts[k] += 1.0 / (1 + i);
    });
    double all = 0;
    for (double part : parts) all += part;
    return all;
  };
  Workers workers(GetParam());
  for (int trial = 0; trial < 50; ++trial) EXPECT_EQ(sum(&workers), sum(nullptr));
}

TEST_P(WorkersOf, DoALoopWithinALoop) {
  Workers workers(GetParam());
  std::vector<int> done(64, 0);
  for (int trial = 0; trial < 100; ++trial)
    workers.for_each(8, [&](int outer) noexcept {
      workers.for_each(8, [&](int inner) noexcept { ++done[8 * outer + inner]; });
    });
  EXPECT_EQ(done, std::vector<int>(64, 100));
}

TEST_P(WorkersOf, ServeTwoCallersAtOnce) {
  Workers workers(GetParam());
  std::vector<int> here(8, 0), there(8, 0);
  const auto many = [&workers](std::vector<int>& done) {
    for (int trial = 0; trial < 2000; ++trial) workers.for_each(8, [&](int k) noexcept { ++done[k]; });
  };
  std::thread other([&] { many(there); });
  many(here);
  other.join();
  EXPECT_EQ(here, std::vector<int>(8, 2000));
  EXPECT_EQ(there, std::vector<int>(8, 2000));
}

TEST_P(WorkersOf, EndAtOnceAfterASleepOrWithoutWork) {
  { const Workers idle(GetParam()); }
  Workers workers(GetParam());
  std::vector<int> done(8, 0);
  for (int trial = 0; trial < 3; ++trial) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // longer than they stay awake
    workers.for_each(8, [&](int k) noexcept { ++done[k]; });
  }
  EXPECT_EQ(done, std::vector<int>(8, 3));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

TEST(Workers, ShareALoopAmongThreads) {
  Workers workers(2);
  std::set<std::thread::id> threads;
  std::mutex mutex;
  // Each of the two chunks waits for the other: one thread alone would stay in the first for good.
  std::atomic<int> begun = 0;
  workers.for_each(2, [&](int) noexcept {
    ++begun;
    while (begun < 2) std::this_thread::yield();
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads.size(), 2U);
}

TEST(Workers, ShareALoopWithinALoopOnceTheOuterOneHasNoMoreToBegin) {
  Workers workers(2);
  // Alone in the inner loop, its caller would stay in the first chunk for good.
  std::atomic<int> begun = 0;
  workers.for_each(2, [&](int outer) noexcept {
    if (outer == 0) return;
    workers.for_each(2, [&](int) noexcept {
      ++begun;
      while (begun < 2) std::this_thread::yield();
    });
  });
  EXPECT_EQ(begun, 2);
}

TEST(Workers, OneThreadIsTheCallersAndItsChunksAreInOrder) {
  Workers workers(1);
  std::vector<int> order;
  std::set<std::thread::id> threads;
  workers.for_each(5, [&](int k) noexcept {
    order.push_back(k);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

}  // namespace
}  // namespace calot
