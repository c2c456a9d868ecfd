// The team of a build without threads: the one that calls, alone.
#include "error.hpp"
#include "team.hpp"

namespace gimpslope {

struct Team::Shared {
  int next = 0;
};

bool has_threads() { return false; }

Team::Team(int size) : size_(size), shared_(std::make_unique<Shared>()) {
  require(size == 1, "threads", size, "1, for this build has no threads");
}

Team::~Team() = default;

void Team::run(void (*job)(void*, int), void* context) {
  job(context, 0);
  barrier();
}

int Team::claim(int) { return shared_->next++; }

void Team::finish(int) {}

void Team::await(int) {}

void Team::resize(int) {}

void Team::barrier() { shared_->next = 0; }

}  // namespace gimpslope
