// Threads that take the loops of a step together.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "buffer.hpp"

namespace gimpslope {

/// A fixed number of threads, this one included, that run a job and meet at barriers in between.
/// They spin for as long as a barrier of a step usually takes and then sleep, so that a busy
/// machine is not kept from its work.
class Team {
 public:
  explicit Team(int size);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }

  /// Calls job(context, thread) on every thread; returns when all are done. The job must not throw.
  void run(void (*job)(void*, int), void* context);

  /// For jobs: the next index of a queue of the loop that the team is in, each given once. There is
  /// one queue a thread.
  int claim(int queue);

  /// For jobs: waits for all threads, which ends the loop and begins the next one at index 0.
  void barrier();

 private:
  struct alignas(kCacheLine) Queue {
    std::atomic<int> next{0};
  };

  void work(int thread);
  void leave();

  int size_;
  int spins_;
  std::vector<std::thread> threads_;
  void (*job_)(void*, int) = nullptr;
  void* context_ = nullptr;
  bool leaving_ = false;
  std::atomic<std::uint32_t> jobs_{0};   // started so far
  std::atomic<std::uint32_t> meets_{0};  // barriers passed so far
  std::atomic<int> arrived_{0};
  std::vector<Queue> queues_;
};

}  // namespace gimpslope
