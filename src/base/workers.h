#pragma once
// Threads that share loops. A loop is cut into chunks whose number does not depend on how many threads
// there are; each chunk writes results of its own, which the caller puts together in the chunks' order: the bits are
// the same whatever the number of threads.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace calot {

/// Items begin .. end - 1 of a loop.
struct Chunk {
  int begin = 0, end = 0;
};
/// The k-th of `chunks` parts of `items`, of sizes that differ by one at most.
constexpr Chunk chunk_of(int items, int chunks, int k) {
  const auto at = [&](int part) { return static_cast<int>(std::int64_t{items} * part / chunks); };
  return {at(k), at(k + 1)};
}

/// Keeps the exceptions of a loop's chunks from ending their threads: of all that are thrown the one of the chunk with the
/// lowest number goes on to the loop's caller, whichever was thrown first.
class ThrownByChunks {
 public:
  template <class Work>
  void watch(const Work& work, int chunk) noexcept {
    try {
      work(chunk);
    } catch (...) {
      keep(std::current_exception(), chunk);
    }
  }
  /// When all chunks have ended. Nothing where none has thrown.
  void rethrow() {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }

 private:
  void keep(std::exception_ptr thrown, int chunk) noexcept;

  std::mutex mutex_;
  std::exception_ptr thrown_;
  int by_ = std::numeric_limits<int>::max();
};

class Workers {
 public:
  /// `threads` in all, the caller's among them: of one or less none is started. Where the system refuses some, those
  /// that there are do the work.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls work(chunk) once for each of 0 .. chunks - 1, on any thread and in any order, and returns when all are done;
  /// what they wrote is then seen. A chunk that throws ends no other one: the first one's exception, by their numbers, is
  /// thrown on when all are done. Loops within a chunk, and those of several threads, are shared as well; one that finds
  /// no room beside the others is done by its caller alone.
  template <class Work>
  void for_each(int chunks, const Work& work) {
    ThrownByChunks thrown;
    const auto watched = [&](int chunk) noexcept { thrown.watch(work, chunk); };
    run(
        chunks, [](const void* on, int chunk) noexcept { (*static_cast<decltype(&watched)>(on))(chunk); },
        &watched);
    thrown.rethrow();
  }

 private:
  using Call = void (*)(const void*, int) noexcept;
  /// One loop under way, or room for one.
  struct alignas(64) Loop {
    /// Number of the loop, and in the lower half how many of its chunks nobody has taken yet.
    std::atomic<std::uint64_t> ticket = 0;
    std::atomic<Call> call = nullptr;
    std::atomic<const void*> on = nullptr;
    std::atomic<int> left = 0;  ///< chunks that are not done
    std::atomic<bool> busy = false;

    bool take_chunk();
    bool has_work() const { return static_cast<std::uint32_t>(ticket.load()) > 0; }
  };
  void run(int chunks, Call call, const void* on);
  void share(Loop& loop, int chunks, Call call, const void* on);
  void work_on();
  bool wait_for_work();
  bool has_work() const;

  /// Loops within each other: bodies, what each of them does, and the elements of that.
  std::array<Loop, 4> loops_;
  std::atomic<bool> ends_ = false;
  std::atomic<int> sleepers_ = 0;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::thread> threads_;
};

/// What a run takes unless told: two, of which the second one is worth some tenths of a step, where there are cores for
/// them; more have not been measured.
int usual_threads();
inline constexpr int most_threads = 64;

/// With workers or without: then on the caller's thread, and all chunks alike where one throws.
template <class Work>
void for_each_chunk(Workers* workers, int chunks, const Work& work) {
  if (workers != nullptr) return workers->for_each(chunks, work);
  ThrownByChunks thrown;
  for (int k = 0; k < chunks; ++k) thrown.watch(work, k);
  thrown.rethrow();
}

/// Does all of these, which must share nothing that one of them changes, at once; the last one is begun first. Of those
/// that throw the first one's exception is thrown on when all are done.
template <class... Work>
void do_at_once(Workers* workers, const Work&... work) {
  for_each_chunk(workers, static_cast<int>(sizeof...(work)), [&](int chunk) {
    int k = 0;
    (static_cast<void>(k++ == chunk && (work(), true)), ...);
  });
}

}  // namespace calot
