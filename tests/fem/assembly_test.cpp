#include "fem/assembly.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <stdexcept>

namespace calot {
namespace {

TEST(Assembly, IsSharedAgainAfterAnElementHasThrown) {
  const std::vector<FaceNodes> elements(2, FaceNodes{{0}, 4});
  BlockMatrix matrix(1, std::vector<std::vector<int>>{{0}});
  Workers workers(2);
  Assembly assembly(workers);
  const auto throws = [](std::size_t, ElementMatrix&) { throw std::runtime_error("no such element"); };
  EXPECT_THROW(assembly.add(elements, matrix, throws), std::runtime_error);

  // Each element waits for the other: one thread alone would compute the second one after the first one's wait.
  std::set<std::thread::id> threads;
  std::mutex mutex;
  std::atomic<int> begun = 0;
  assembly.add(elements, matrix, [&](std::size_t, ElementMatrix& element) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    for (++begun; begun < 2 && std::chrono::steady_clock::now() < end;) std::this_thread::yield();
    element.reset(4);
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads.size(), 2u);
}

}  // namespace
}  // namespace calot
