// Threads that take the loops of a step together.
#pragma once

#include <memory>

namespace gimpslope {

/// Whether this build has threads; without them a team has the size 1.
bool has_threads();

/// A fixed number of threads, this one included, that run a job and meet at barriers in between.
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

  /// For jobs: tells that a piece of the loop is done, once a loop.
  void finish(int piece);

  /// For jobs: waits until a piece of the loop is done.
  void await(int piece);

  /// For jobs: waits for all threads, which ends the loop and begins the next one at index 0.
  void barrier();

  /// Between jobs: loops have so many pieces from now on.
  void resize(int pieces);

 private:
  struct Shared;  // by the threads: team_threads.cpp, or team_alone.cpp in a build without them

  int size_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace gimpslope
