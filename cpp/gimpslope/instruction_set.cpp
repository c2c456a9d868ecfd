#include "instruction_set.hpp"

#include "error.hpp"
#include "kernel.hpp"

namespace gimpslope {

inline namespace generic {
template <class Real>
Kernel<Real> kernel(SchemeKind scheme, Basis basis);
}
#ifdef GIMPSLOPE_X86
namespace x86_64_v3 {
template <class Real>
Kernel<Real> kernel(SchemeKind scheme, Basis basis);
}
namespace x86_64_v4 {
template <class Real>
Kernel<Real> kernel(SchemeKind scheme, Basis basis);
}
#endif

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::generic};
#ifdef GIMPSLOPE_X86
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                  __builtin_cpu_supports("f16c") && __builtin_cpu_supports("lzcnt") &&
                  __builtin_cpu_supports("movbe");
  if (v3) sets.push_back(InstructionSet::x86_64_v3);
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (v4) sets.push_back(InstructionSet::x86_64_v4);
#endif
  return sets;
}

const char* name(InstructionSet set) {
  switch (set) {
    case InstructionSet::x86_64_v3:
      return "x86-64-v3";
    case InstructionSet::x86_64_v4:
      return "x86-64-v4";
    case InstructionSet::generic:
      break;
  }
  return "generic";
}

InstructionSet parse_instruction_set(const std::string& text) {
  std::string allowed;
  for (const InstructionSet set : available_instruction_sets()) {
    if (text == name(set)) return set;
    allowed += (allowed.empty() ? "one of " : ", ") + std::string(name(set));
  }
  require(false, "instruction_set", text, (allowed + " on this processor").c_str());
  return InstructionSet::generic;
}

template <class Real>
Kernel<Real> find_kernel(InstructionSet set, SchemeKind scheme, Basis basis) {
  switch (set) {
#ifdef GIMPSLOPE_X86
    case InstructionSet::x86_64_v3:
      return x86_64_v3::kernel<Real>(scheme, basis);
    case InstructionSet::x86_64_v4:
      return x86_64_v4::kernel<Real>(scheme, basis);
#endif
    default:
      return generic::kernel<Real>(scheme, basis);
  }
}

template Kernel<double> find_kernel(InstructionSet set, SchemeKind scheme, Basis basis);
template Kernel<float> find_kernel(InstructionSet set, SchemeKind scheme, Basis basis);

}  // namespace gimpslope
