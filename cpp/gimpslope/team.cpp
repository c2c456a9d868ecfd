#include "team.hpp"

#include <string>
#include <system_error>

#include "error.hpp"

namespace gimpslope {
namespace {

/// Waits until `counter` has left `old`: at first without leaving the processor, then asleep.
void wait_for_change(const std::atomic<std::uint32_t>& counter, std::uint32_t old, int spins) {
  for (int k = 0; k < spins; ++k)
    if (counter.load(std::memory_order_acquire) != old) return;
  counter.wait(old, std::memory_order_acquire);
}

/// As long as a barrier of a step usually takes; not at all where threads share processors.
int spins_of(int size) {
  return size <= static_cast<int>(std::thread::hardware_concurrency()) ? 20000 : 0;
}

void advance(std::atomic<std::uint32_t>& counter) {
  counter.fetch_add(1, std::memory_order_release);
  counter.notify_all();
}

}  // namespace

Team::Team(int size) : size_(size), spins_(spins_of(size)), queues_(size) {
  try {
    for (int k = 1; k < size; ++k) threads_.emplace_back([this, k] { work(k); });
  } catch (const std::system_error&) {
    const std::size_t started = threads_.size() + 1;
    leave();
    refuse("threads", size,
           "a number that the system lets start; it gave " + std::to_string(started));
  }
}

Team::~Team() { leave(); }

void Team::leave() {
  leaving_ = true;
  advance(jobs_);
  for (std::thread& thread : threads_) thread.join();
}

int Team::claim(int queue) { return queues_[queue].next.fetch_add(1, std::memory_order_relaxed); }

void Team::run(void (*job)(void*, int), void* context) {
  job_ = job;
  context_ = context;
  if (size_ > 1) advance(jobs_);
  job(context, 0);
  barrier();
}

void Team::work(int thread) {
  for (std::uint32_t done = 0;; ++done) {
    wait_for_change(jobs_, done, spins_);
    if (leaving_) return;
    job_(context_, thread);
    barrier();
  }
}

void Team::barrier() {
  const std::uint32_t before = meets_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < size_) {
    wait_for_change(meets_, before, spins_);
    return;
  }
  arrived_.store(0, std::memory_order_relaxed);
  for (Queue& queue : queues_) queue.next.store(0, std::memory_order_relaxed);
  if (size_ > 1) advance(meets_);
}

}  // namespace gimpslope
