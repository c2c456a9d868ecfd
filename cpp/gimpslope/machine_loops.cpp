#include "machine_loops.hpp"

#include "instruction_set.hpp"

namespace gimpslope {
inline namespace GIMPSLOPE_INSTRUCTION_SET {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif

/// As many results as may be on their way at once: two to four units that take four or five cycles
/// for each, within sixteen or thirty-two registers.
#if defined(__AVX512F__) || defined(__aarch64__)
constexpr int kChains = 24;
#else
constexpr int kChains = 12;
#endif

using Lanes [[gnu::vector_size(kLanes * sizeof(double)), gnu::may_alias]] = double;

template <int kCount>
double sum_of(const Lanes (&lanes)[kCount]) {
  double sum = 0.0;
  for (const Lanes& some : lanes)
    for (int k = 0; k < kLanes; ++k) sum += some[k];
  return sum;
}

std::int64_t multiply_add(std::int64_t rounds, double& sum) {
  const Lanes factor = Lanes{} + 0.5, rest = Lanes{} + 1.0;
  Lanes chain[kChains];
  for (int k = 0; k < kChains; ++k) chain[k] = Lanes{} + (sum + k);
  for (std::int64_t round = 0; round < rounds; ++round) {
#pragma GCC unroll 24
    for (int k = 0; k < kChains; ++k) chain[k] = factor * chain[k] + rest;
  }
  sum = sum_of(chain);
  return 2 * kLanes * kChains * rounds;
}

void read(const double* values, std::int64_t lines, double& sum) {
  constexpr int kTogether = 8;
  constexpr int kStep = kTogether * kLanes / kDoublesOfLine;  // lines
  Lanes sums[kTogether]{};
  std::int64_t line = 0;
  for (; line + kStep <= lines; line += kStep) {
    const auto* vectors = reinterpret_cast<const Lanes*>(values + kDoublesOfLine * line);
#pragma GCC unroll 8
    for (int k = 0; k < kTogether; ++k) sums[k] += vectors[k];
  }
  for (; line < lines; ++line) sums[0][0] += values[kDoublesOfLine * line];
  sum = sum_of(sums);
}

}  // namespace

MachineLoops machine_loops() { return {&multiply_add, &read}; }

}  // namespace GIMPSLOPE_INSTRUCTION_SET
}  // namespace gimpslope
