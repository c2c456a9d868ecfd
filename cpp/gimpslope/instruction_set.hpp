// The kernel's hot code is compiled once for each instruction set and chosen at run time.
#pragma once

// Everything that is compiled more than once lives in an inline namespace of its own, so that the
// linker can never replace the code of one instruction set by that of another.
#ifndef GIMPSLOPE_INSTRUCTION_SET
#define GIMPSLOPE_INSTRUCTION_SET generic
#endif

#include <string>
#include <vector>

namespace gimpslope {

enum class InstructionSet { generic, x86_64_v3, x86_64_v4 };

/// Instruction sets that this build holds and this processor can run, slowest first.
std::vector<InstructionSet> available_instruction_sets();

const char* name(InstructionSet set);
InstructionSet parse_instruction_set(const std::string& text);

}  // namespace gimpslope
