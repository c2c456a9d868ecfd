#include "machine.hpp"

#include "error.hpp"

namespace gimpslope {

inline namespace generic {
MachineLoops machine_loops();
}
#ifdef GIMPSLOPE_X86
namespace x86_64_v3 {
MachineLoops machine_loops();
}
namespace x86_64_v4 {
MachineLoops machine_loops();
}
#endif

namespace {

MachineLoops find_loops(InstructionSet set) {
  switch (set) {
#ifdef GIMPSLOPE_X86
    case InstructionSet::x86_64_v3:
      return x86_64_v3::machine_loops();
    case InstructionSet::x86_64_v4:
      return x86_64_v4::machine_loops();
#endif
    default:
      return generic::machine_loops();
  }
}

int checked(int threads) {
  require(threads >= 1, "threads", threads, "a whole number >= 1");
  return threads;
}

}  // namespace

Machine::Machine(int threads, std::int64_t bytes, InstructionSet instruction_set)
    : loops_(find_loops(instruction_set)), team_(checked(threads)), shares_(threads) {
  const std::int64_t lines = bytes / static_cast<std::int64_t>(kCacheLine);
  require(lines >= 1, "bytes", bytes, "at least a cache line of 64");
  together([&](Share& share) {  // its thread is the first to touch it
    share.buffer.assign(lines * kDoublesOfLine, 1.0);
    return 0;
  });
}

std::int64_t Machine::multiply_add(std::int64_t rounds) {
  require(rounds >= 0, "rounds", rounds, "zero or positive");
  return together([&](Share& share) { return loops_.multiply_add(rounds, share.sum); });
}

std::int64_t Machine::read(std::int64_t passes) {
  require(passes >= 0, "passes", passes, "zero or positive");
  return together([&](Share& share) {
    const auto doubles = static_cast<std::int64_t>(share.buffer.size());
    for (std::int64_t k = 0; k < passes; ++k)
      loops_.read(share.buffer.data(), doubles / kDoublesOfLine, share.sum);
    return passes * doubles * static_cast<std::int64_t>(sizeof(double));
  });
}

/// The sum of work(share) over all threads.
template <class Work>
std::int64_t Machine::together(Work work) {
  auto job = [&](int thread) {
    shares_[thread].done = work(shares_[thread]);
  };
  team_.run([](void* context, int thread) { (*static_cast<decltype(job)*>(context))(thread); },
            &job);
  std::int64_t sum = 0;
  for (const Share& share : shares_) sum += share.done;
  return sum;
}

}  // namespace gimpslope
