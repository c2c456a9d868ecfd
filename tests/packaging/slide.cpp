// `slide THREADS STEPS [SET]`: a block of soil slides over a rough floor. Shows the instruction set
// that was used, and a line for each field of the points.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "gimpslope/solver.hpp"

using namespace gimpslope;

namespace {

Solver sliding_block(int threads, InstructionSet set) {
  constexpr int columns = 40, rows = 20, n = columns * rows;
  constexpr double spacing = 0.25, volume = spacing * spacing;
  Material soil{.density = 2000.0, .young = 1e6, .poisson = 0.3};
  soil.law = LawKind::drucker_prager;
  soil.friction = 22.0;
  soil.cohesion = 1e3;
  std::vector<double> position;
  for (int k = 0; k < n; ++k) {
    position.push_back(spacing * (k % columns + 0.5));
    position.push_back(spacing * (k / columns + 0.5));
  }
  const std::vector<double> at_rest(2 * n, 0.0), half_lengths(2 * n, 0.5 * spacing);
  const std::vector<double> masses(n, soil.density * volume), volumes(n, volume);
  const std::vector<std::int32_t> materials(n, 0);
  Method method;
  method.blend.value = 0.01;
  method.threads = threads;
  Solver solver({position, at_rest, half_lengths, masses, volumes, materials, {}}, {soil},
                2 * spacing, {0.0, 0.0}, {Wall{WallKind::roller}, {}, {WallKind::coulomb, 0.2}, {}},
                method, set);
  solver.set_gravity({4.0, -9.81, 0.0});
  return solver;
}

}  // namespace

int main(int count, char** word) try {
  const auto set = count > 3 ? parse_instruction_set(word[3]) : available_instruction_sets().back();
  Solver solver = sliding_block(std::atoi(word[1]), set);
  solver.advance(std::atoi(word[2]));
  std::puts(name(solver.instruction_set()));
  for (const char* field : {"position", "velocity", "stress", "volume", "plastic_strain"}) {
    std::printf("%s", field);
    std::vector<double> values(static_cast<std::size_t>(solver.size()) *
                               solver.field(field).components);
    solver.copy_values<double>(field, values);
    for (const double value : values) std::printf(" %.17g", value);
    std::puts("");
  }
} catch (const std::exception& refused) {
  std::puts(refused.what());
  return 1;
}
