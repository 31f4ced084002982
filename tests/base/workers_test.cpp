#include "base/workers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <stdexcept>
#include <string>

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
    workers.for_each(chunks, [&](int k) { ++done[k]; });
    EXPECT_EQ(done, std::vector<int>(done.size(), 1)) << chunks;
  }
}

TEST_P(WorkersOf, DoManyShortLoopsInARow) {
  Workers workers(GetParam());
  constexpr int chunks = 4, loops = 20000;
  std::vector<int> sums(chunks, 0);
  for (int loop = 0; loop < loops; ++loop)
    workers.for_each(chunks, [&sums, loop](int k) { sums[k] += loop % 7 + k; });
  std::vector<int> expected(chunks, 0);
  for (int loop = 0; loop < loops; ++loop)
    for (int k = 0; k < chunks; ++k) expected[k] += loop % 7 + k;
  EXPECT_EQ(sums, expected);
}

TEST_P(WorkersOf, GiveTheSameBits) {
  const auto sum = [](Workers* workers) {
    constexpr int chunks = 16, items = 10007;
    std::vector<double> parts(chunks);
    for_each_chunk(workers, chunks, [&](int k) {
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
    workers.for_each(8,
                     [&](int outer) { workers.for_each(8, [&](int inner) { ++done[8 * outer + inner]; }); });
  EXPECT_EQ(done, std::vector<int>(64, 100));
}

TEST_P(WorkersOf, ServeTwoCallersAtOnce) {
  Workers workers(GetParam());
  std::vector<int> here(8, 0), there(8, 0);
  const auto many = [&workers](std::vector<int>& done) {
    for (int trial = 0; trial < 2000; ++trial) workers.for_each(8, [&](int k) { ++done[k]; });
  };
  std::thread other([&] { many(there); });
  many(here);
  other.join();
  EXPECT_EQ(here, std::vector<int>(8, 2000));
  EXPECT_EQ(there, std::vector<int>(8, 2000));
}

/// What a loop threw, in words.
template <class Loop>
std::string thrown_by(const Loop& loop) {
  try {
    loop();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing";
}

TEST_P(WorkersOf, ThrowOnWhatTheFirstChunkThatThrowsHasThrownOnceAllHaveEnded) {
  Workers workers(GetParam());
  for (Workers* some : {&workers, static_cast<Workers*>(nullptr)})
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<int> done(9, 0);
      const auto loop = [&](std::set<int> throwing) {
        return thrown_by([&] {
          for_each_chunk(some, 9, [&](int k) {
            ++done[k];
            if (throwing.contains(k)) throw std::runtime_error("chunk " + std::to_string(k));
          });
        });
      };
      ASSERT_EQ(loop({2, 5, 8}), "chunk 2");
      ASSERT_EQ(loop({8}), "chunk 8");
      ASSERT_EQ(loop({}), "nothing");
      ASSERT_EQ(done, std::vector<int>(9, 3)) << "no chunk is left out where another one throws";
    }
}

TEST_P(WorkersOf, ThrowOnWhatALoopWithinALoopHasThrown) {
  Workers workers(GetParam());
  std::vector<int> done(16, 0);
  const std::string thrown = thrown_by([&] {
    workers.for_each(4, [&](int outer) {
      workers.for_each(4, [&](int inner) {
        ++done[4 * outer + inner];
        if (outer >= 1 && inner >= 2)
          throw std::runtime_error(std::to_string(outer) + "." + std::to_string(inner));
      });
    });
  });
  EXPECT_EQ(thrown, "1.2");
  EXPECT_EQ(done, std::vector<int>(16, 1));
}

TEST_P(WorkersOf, ThrowOnWhatOneOfThoseDoneAtOnceHasThrown) {
  Workers workers(GetParam());
  bool done = false;
  const auto throws = [](const char* what) { return [what] { throw std::runtime_error(what); }; };
  EXPECT_EQ(thrown_by([&] {
              do_at_once(
                  &workers, [&] { done = true; }, throws("second"), throws("third"));
            }),
            "second");
  EXPECT_TRUE(done);
}

TEST_P(WorkersOf, EndAtOnceAfterASleepOrWithoutWork) {
  { const Workers idle(GetParam()); }
  Workers workers(GetParam());
  std::vector<int> done(8, 0);
  for (int trial = 0; trial < 3; ++trial) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // longer than they stay awake
    workers.for_each(8, [&](int k) { ++done[k]; });
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
  workers.for_each(2, [&](int) {
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
  workers.for_each(2, [&](int outer) {
    if (outer == 0) return;
    workers.for_each(2, [&](int) {
      ++begun;
      while (begun < 2) std::this_thread::yield();
    });
  });
  EXPECT_EQ(begun, 2);
}

TEST(Workers, CarryAnExceptionFromAnotherThreadToTheCaller) {
  Workers workers(2);
  const std::thread::id caller = std::this_thread::get_id();
  // Each of the two chunks waits for the other: so one of them is on the other thread.
  std::atomic<int> begun = 0;
  const std::string thrown = thrown_by([&] {
    workers.for_each(2, [&](int) {
      ++begun;
      while (begun < 2) std::this_thread::yield();
      if (std::this_thread::get_id() != caller) throw std::runtime_error("of the other thread");
    });
  });
  EXPECT_EQ(thrown, "of the other thread");
}

TEST(Workers, OneThreadIsTheCallersAndItsChunksAreInOrder) {
  Workers workers(1);
  std::vector<int> order;
  std::set<std::thread::id> threads;
  workers.for_each(5, [&](int k) {
    order.push_back(k);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

}  // namespace
}  // namespace calot
