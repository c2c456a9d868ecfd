// The team of a build with threads. They spin for as long as a barrier of a step usually takes and
// then sleep, so that a busy machine is not kept from its work.
#include <atomic>
#include <cstdint>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "buffer.hpp"
#include "error.hpp"
#include "team.hpp"

namespace gimpslope {
namespace {

using Counter = std::atomic<std::uint32_t>;

/// Waits until `counter` has left `old`: at first without leaving the processor, then asleep.
void wait_for_change(const Counter& counter, std::uint32_t old, int spins) {
  for (int k = 0; k < spins; ++k)
    if (counter.load(std::memory_order_acquire) != old) return;
  counter.wait(old, std::memory_order_acquire);
}

/// As long as a barrier of a step usually takes; not at all where threads share processors.
int spins_of(int size) {
  return size <= static_cast<int>(std::thread::hardware_concurrency()) ? 20000 : 0;
}

void advance(Counter& counter) {
  counter.fetch_add(1, std::memory_order_release);
  counter.notify_all();
}

}  // namespace

struct Team::Shared {
  explicit Shared(int size) : size(size), spins(spins_of(size)), queues(size) {}
  ~Shared();
  void work(int thread);
  void meet();

  struct alignas(kCacheLine) Queue {
    std::atomic<int> next{0};
  };
  struct alignas(kCacheLine) Piece {
    Counter done{0};  // number of the last loop in which it was; 0: in none
  };

  const int size, spins;
  std::vector<std::thread> threads;
  void (*job)(void*, int) = nullptr;
  void* context = nullptr;
  bool leaving = false;
  Counter jobs{0};  // started so far
  Counter loop{1};  // number of this loop, which a barrier ends
  std::atomic<int> arrived{0};
  std::vector<Queue> queues;
  std::vector<Piece> pieces;
};

Team::Shared::~Shared() {
  leaving = true;
  advance(jobs);
  for (std::thread& thread : threads) thread.join();
}

void Team::Shared::work(int thread) {
  for (std::uint32_t done = 0;; ++done) {
    wait_for_change(jobs, done, spins);
    if (leaving) return;
    job(context, thread);
    meet();
  }
}

void Team::Shared::meet() {
  const std::uint32_t before = loop.load(std::memory_order_acquire);
  if (arrived.fetch_add(1, std::memory_order_acq_rel) + 1 < size) {
    wait_for_change(loop, before, spins);
    return;
  }
  arrived.store(0, std::memory_order_relaxed);
  for (Queue& queue : queues) queue.next.store(0, std::memory_order_relaxed);
  if (size > 1) advance(loop);
}

bool has_threads() { return true; }

Team::Team(int size) : size_(size), shared_(std::make_unique<Shared>(size)) {
  Shared* shared = shared_.get();
  try {
    for (int k = 1; k < size; ++k) shared->threads.emplace_back([shared, k] { shared->work(k); });
  } catch (const std::system_error&) {
    refuse("threads", size,
           "a number that the system lets start; it gave " +
               std::to_string(shared->threads.size() + 1));
  }
}

Team::~Team() = default;

void Team::run(void (*job)(void*, int), void* context) {
  shared_->job = job;
  shared_->context = context;
  if (size_ > 1) advance(shared_->jobs);
  job(context, 0);
  barrier();
}

int Team::claim(int queue) {
  return shared_->queues[queue].next.fetch_add(1, std::memory_order_relaxed);
}

void Team::finish(int piece) {
  if (size_ == 1) return;
  Counter& done = shared_->pieces[piece].done;
  done.store(shared_->loop.load(std::memory_order_relaxed), std::memory_order_release);
  done.notify_all();
}

void Team::await(int piece) {
  if (size_ == 1) return;
  const Counter& done = shared_->pieces[piece].done;
  const std::uint32_t before = done.load(std::memory_order_acquire);
  if (before != shared_->loop.load(std::memory_order_relaxed))
    wait_for_change(done, before, shared_->spins);
}

void Team::resize(int pieces) { shared_->pieces = std::vector<Shared::Piece>(pieces); }

void Team::barrier() { shared_->meet(); }

}  // namespace gimpslope
