#include "team.hpp"

namespace gimpslope {
namespace {

/// Waits until `counter` has left `old`: first without leaving the processor, then giving way to
/// others, then asleep.
void wait_for_change(const std::atomic<std::uint32_t>& counter, std::uint32_t old) {
  constexpr int spins = 20000, yields = 20;
  for (int k = 0; k < spins; ++k)
    if (counter.load(std::memory_order_acquire) != old) return;
  for (int k = 0; k < yields; ++k) {
    if (counter.load(std::memory_order_acquire) != old) return;
    std::this_thread::yield();
  }
  counter.wait(old, std::memory_order_acquire);
}

void advance(std::atomic<std::uint32_t>& counter) {
  counter.fetch_add(1, std::memory_order_release);
  counter.notify_all();
}

}  // namespace

Team::Team(int size) : size_(size) {
  for (int k = 1; k < size; ++k) threads_.emplace_back([this] { work(); });
}

Team::~Team() {
  leaving_ = true;
  advance(jobs_);
  for (std::thread& thread : threads_) thread.join();
}

void Team::run(void (*job)(void*), void* context) {
  job_ = job;
  context_ = context;
  if (size_ > 1) advance(jobs_);
  job(context);
  barrier();
}

void Team::work() {
  for (std::uint32_t done = 0;; ++done) {
    wait_for_change(jobs_, done);
    if (leaving_) return;
    job_(context_);
    barrier();
  }
}

void Team::barrier() {
  const std::uint32_t before = meets_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < size_) {
    wait_for_change(meets_, before);
    return;
  }
  arrived_.store(0, std::memory_order_relaxed);
  next_.store(0, std::memory_order_relaxed);
  if (size_ > 1) advance(meets_);
}

}  // namespace gimpslope
