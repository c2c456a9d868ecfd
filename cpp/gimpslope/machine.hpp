// What this machine can do at most, which the kernel's speed is held against: fused multiply-adds
// on registers, and reading of memory.
#pragma once

#include <cstdint>
#include <vector>

#include "buffer.hpp"
#include "instruction_set.hpp"
#include "machine_loops.hpp"
#include "team.hpp"

namespace gimpslope {

class Machine {
 public:
  /// Each thread gets a buffer of `bytes`, in whole cache lines.
  Machine(int threads, std::int64_t bytes, InstructionSet instruction_set);

  /// Floating-point operations of all threads in `rounds` of multiply-adds.
  std::int64_t multiply_add(std::int64_t rounds);

  /// Bytes that all threads read in `passes` over their buffers.
  std::int64_t read(std::int64_t passes);

 private:
  struct alignas(kCacheLine) Share {
    Buffer<double> buffer;
    std::int64_t done = 0;
    double sum = 0.0;
  };

  template <class Work>
  std::int64_t together(Work work);

  MachineLoops loops_;
  Team team_;
  std::vector<Share> shares_;  // of each thread
};

}  // namespace gimpslope
